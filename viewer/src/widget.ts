// The explorer in a notebook: the module that anywidget loads. Its model's traits are the place: see halfway.notebook.Explorer.

import { Problem } from "./api/client";
import { kernel, type Messenger } from "./api/kernel";
import { type Mounted, mount } from "./mount";
import type { State, Way } from "./state";

/** What the page and Python both hold. */
type Place = Way & Pick<State, "t">;

/** The part of anywidget's model that we use. */
interface Model extends Messenger {
  get<K extends keyof Place>(name: K): Place[K];
  set<K extends keyof Place>(name: K, value: Place[K]): void;
  save_changes(): void;
  on(event: string, listener: (...parts: never[]) => void): void;
  off(event: string, listener: (...parts: never[]) => void): void;
}

const TRAITS = ["space", "pace", "stops", "point", "t"] as const;
/** Milliseconds between two messages to Python while something moves. */
const PATIENCE = 50;

async function render({ model, el }: { model: Model; el: HTMLElement }): Promise<() => void> {
  const root = document.createElement("div");
  // Keys are the page's own where it has the focus, and no commands of the notebook.
  root.dataset.lmSuppressShortcuts = "true";
  root.tabIndex = -1;
  el.append(root);
  const { body } = document;
  const theme = body.dataset.jpThemeLight;
  try {
    const mounted = await mount(root, kernel(model), {
      linked: placeOf(model),
      theme: theme === undefined ? "auto" : theme === "true" ? "light" : "dark",
    });
    const stop = tie(model, mounted);
    return () => {
      stop();
      mounted.unmount();
    };
  } catch (error) {
    // What a person can act on is on the page already.
    if (!(error instanceof Problem)) throw error;
    return () => root.remove();
  }
}

/** Keep the page and Python in the same place. */
function tie(model: Model, { store, actions }: Mounted): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const tell = () => {
    timer = undefined;
    const state = store.get();
    let changed = false;
    for (const name of TRAITS) {
      if (same(model.get(name), state[name])) continue;
      model.set(name, state[name]);
      changed = true;
    }
    if (changed) model.save_changes();
  };
  store.watch(
    ({ space, pace, stops, point, t }) => [space, pace, stops, point, t] as const,
    () => {
      timer ??= setTimeout(tell, PATIENCE);
    },
  );
  const follow = () => {
    const place = placeOf(model);
    const state = store.get();
    const { t, ...way } = place;
    if (TRAITS.some((name) => name !== "t" && !same(way[name], state[name]))) actions.go(way);
    // Moving t would leave a free place.
    if (way.point === null && t !== state.t) actions.setT(t);
  };
  for (const name of TRAITS) model.on(`change:${name}`, follow);
  return () => {
    clearTimeout(timer);
    for (const name of TRAITS) model.off(`change:${name}`, follow);
  };
}

function placeOf(model: Model): Place {
  const get = <K extends keyof Place>(name: K) => model.get(name);
  return { space: get("space"), pace: get("pace"), stops: get("stops"), point: get("point"), t: get("t") };
}

function same(a: unknown, b: unknown): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

export default { render };
