// The page in an element: ask for the library, build the panels, fetch what the state needs.
//
// Several may stand in one document. Data come through the client alone, and what the page wants of its surroundings is an
// option: it looks neither at the address nor at what the browser stores.

import { Actions, LINK } from "./actions";
import type { Block, Client } from "./api/client";
import { patient, type Waiting } from "./api/patient";
import type { LibrarySummary } from "./api/schema";
import { toDrawable } from "./brdf/grid";
import type { Context, Options } from "./context";
import { el } from "./dom";
import { follow } from "./follow";
import { listenToKeys } from "./keys";
import { listenToDrops } from "./opening";
import { brdfPanel } from "./panels/brdf/panel";
import { head } from "./panels/head";
import { materialPanel } from "./panels/material/panel";
import { status } from "./panels/notices";
import { recipePanel } from "./panels/recipe/panel";
import { routePanel } from "./panels/route/panel";
import { shortlistPanel } from "./panels/shortlist/panel";
import { spacePanel } from "./panels/space/panel";
import { fromHash, unknownIn } from "./permalink";
import { Lights } from "./render/lights";
import { Tables } from "./render/tables";
import { fromText } from "./shortlist";
import { createState, type State } from "./state";
import type { Store } from "./store";
import { Thumbnails } from "./thumbnails";
import "./styles/index.css";

/** A page that stands in an element. */
export interface Mounted {
  readonly store: Store<State>;
  readonly actions: Actions;
  /** Take the page away and give its memory back. */
  readonly unmount: () => void;
}

/** Build the page in `element`; a library that cannot be shown is said there, and thrown as a `Problem`. */
export async function mount(element: HTMLElement, client: Client, options: Options = {}): Promise<Mounted> {
  element.classList.add("halfway");
  const text = el("p.waiting", { role: "status" }, "Reading the library …");
  element.replaceChildren(text);
  const gone = new AbortController();
  let listener = (waiting: Waiting | null): void => {
    if (waiting) text.textContent = waiting.text;
  };
  const asked = patient(client, (waiting) => listener(waiting), gone.signal);
  try {
    const answers = await Promise.all([asked.library(), asked.environment()]);
    const mounted = show(element, asked, options, answers, gone);
    listener = mounted.actions.setWaiting;
    return mounted;
  } catch (error) {
    const text = error instanceof Error ? error.message : String(error);
    element.replaceChildren(el("p.waiting.failed", { role: "alert" }, text));
    throw error;
  }
}

function show(
  root: HTMLElement,
  client: Client,
  options: Options,
  [library, environment]: readonly [LibrarySummary, Block],
  gone: AbortController,
): Mounted {
  const linked = { ...fromHash(options.fragment ?? "", library), ...options.linked };
  const store = createState(library, linked, options.theme ?? "auto");
  const names = library.materials.map(({ name }) => name);
  const context: Context = {
    ...{ root, client, options, store, names, signal: gone.signal },
    actions: new Actions(store),
    thumbnails: new Thumbnails(names, library.name, client.thumbnailsOf, gone.signal),
    tables: new Tables(client, toDrawable(library.grid)),
    lights: new Lights(environment),
  };
  applyTheme(context);
  const side = el("div.side", recipePanel(context), brdfPanel(context));
  root.replaceChildren(
    el(
      "div.layout",
      head(context),
      spacePanel(context),
      materialPanel(context),
      routePanel(context),
      shortlistPanel(context),
      side,
      status(context),
    ),
  );
  context.actions.say("material", "library", library.notice || null);
  context.actions.say("route", LINK, unknownIn(options.fragment ?? "", library));
  takeShortlist(context);
  follow(context);
  listenToKeys(context);
  listenToDrops(context);
  root.classList.add("ready");
  const unmount = () => {
    gone.abort();
    root.replaceChildren();
    root.classList.remove("ready");
  };
  return { store, actions: context.actions, unmount };
}

/** What was kept before; of a library that has changed, what it still has. */
function takeShortlist({ options, store, actions }: Context): void {
  const { library } = store.get();
  const text = options.kept?.(library.name);
  if (!text) return;
  try {
    actions.keep(...fromText(text, "The shortlist in this browser", library));
  } catch (error) {
    actions.say("route", "shortlist", (error as Error).message);
  }
}

function applyTheme({ root, store, options, signal }: Context): void {
  const system = matchMedia("(prefers-color-scheme: light)");
  const apply = () => {
    const { theme } = store.get();
    const scheme = theme === "auto" ? (system.matches ? "light" : "dark") : theme;
    // First, so that who watches the scheme reads its colours.
    root.dataset.theme = scheme;
    store.set({ scheme });
  };
  system.addEventListener("change", apply, { signal });
  let last = store.get().theme;
  store.watch(["theme"], ({ theme }) => {
    apply();
    if (theme !== last) options.onTheme?.(theme);
    last = theme;
  });
}
