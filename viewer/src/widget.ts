// The explorer in a notebook: the module that anywidget loads. Its model's traits are where the person is: see
// halfway.notebook.Explorer.

import { Problem } from "./api/client";
import { kernel, type Messenger } from "./api/kernel";
import type { RecipeDocument } from "./api/schema";
import { type Mounted, mount } from "./mount";
import type { State } from "./state";

/** What the page and Python both hold. */
const TRAITS = ["space", "blend", "pace", "stops", "point", "t"] as const;
type Shared = Pick<State, (typeof TRAITS)[number]>;
/** And what the page alone says: the recipe that it shows instead of the place, or null. */
const HELD = "_held";
const SAID = [...TRAITS, HELD] as const;
type Said = Shared & { readonly [HELD]: RecipeDocument | null };

/** The part of anywidget's model that we use. */
interface Model extends Messenger {
  get<K extends keyof Said>(name: K): Said[K];
  set<K extends keyof Said>(name: K, value: Said[K]): void;
  save_changes(): void;
  on(event: string, listener: (...parts: never[]) => void): void;
  off(event: string, listener: (...parts: never[]) => void): void;
}

/** Milliseconds between two messages to Python while something moves. */
const PATIENCE = 50;

async function render({ model, el }: { model: Model; el: HTMLElement }): Promise<() => void> {
  const root = document.createElement("div");
  // Keys are the page's own where it has the focus, and no commands of the notebook.
  root.dataset.lmSuppressShortcuts = "true";
  root.tabIndex = -1;
  el.append(root);
  const theme = document.body.dataset.jpThemeLight;
  try {
    const mounted = await mount(root, kernel(model), {
      linked: inPython(model),
      theme: theme === undefined ? "auto" : theme === "true" ? "light" : "dark",
    });
    const untie = tie(model, mounted);
    return () => {
      untie();
      mounted.unmount();
    };
  } catch (error) {
    // What a person can act on is on the page already.
    if (!(error instanceof Problem)) throw error;
    return () => root.remove();
  }
}

/** Keep the page and Python at one point of one route. */
function tie(model: Model, { store, actions }: Mounted): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const tell = () => {
    timer = undefined;
    const state = store.get();
    const present: Said = { ...state, [HELD]: state.held?.recipe ?? null };
    const changed = SAID.filter((name) => !same(model.get(name), present[name]));
    for (const name of changed) model.set(name, present[name]);
    if (changed.length) model.save_changes();
  };
  store.watch([...TRAITS, "held"], () => {
    timer ??= setTimeout(tell, PATIENCE);
  });
  const follow = () => {
    const state = store.get();
    const { t, ...whereabouts } = inPython(model);
    if (TRAITS.some((name) => name !== "t" && !same(whereabouts[name], state[name]))) actions.go(whereabouts);
    // Moving t would leave a free point.
    if (whereabouts.point === null && t !== state.t) actions.setT(t);
  };
  for (const name of TRAITS) model.on(`change:${name}`, follow);
  return () => {
    clearTimeout(timer);
    for (const name of TRAITS) model.off(`change:${name}`, follow);
  };
}

function inPython(model: Model): Shared {
  return Object.fromEntries(TRAITS.map((name) => [name, model.get(name)])) as unknown as Shared;
}

function same(a: unknown, b: unknown): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

export default { render };
