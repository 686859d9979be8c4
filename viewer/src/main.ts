// The page: ask for the library, build the panels, fetch what the state needs.

import * as api from "./api/client";
import type { Axis, LibrarySummary } from "./api/schema";
import { isDrawable } from "./brdf/grid";
import { el } from "./dom";
import { listenToKeys } from "./keys";
import { brdfPanel } from "./panels/brdfPanel";
import { head } from "./panels/head";
import { materialView } from "./panels/materialView";
import { recipePanel } from "./panels/recipePanel";
import { routePanel } from "./panels/routePanel";
import { spaceView } from "./panels/spaceView";
import { fromHash, toHash } from "./permalink";
import { Tables } from "./render/tables";
import { Actions, createState, type State, type Theme } from "./state";
import type { Store } from "./store";
import { Thumbnails } from "./thumbnails";

export interface Context {
  readonly store: Store<State>;
  readonly actions: Actions;
  readonly thumbnails: Thumbnails;
  readonly tables: Tables;
  readonly environment: api.Block;
}

const THEME = "halfway-theme";

async function start(): Promise<void> {
  const app = document.querySelector<HTMLElement>("#app")!;
  try {
    const [library, thumbnails, environment] = await Promise.all([
      api.library(),
      api.thumbnails(),
      api.environment(),
    ]);
    show(app, library, thumbnails, environment);
  } catch (error) {
    app.replaceChildren(
      el("p.waiting.failed", { role: "alert" }, {}, error instanceof Error ? error.message : String(error)),
    );
    if (!(error instanceof api.Problem)) throw error;
  }
}

function show(
  app: HTMLElement,
  library: LibrarySummary,
  thumbnails: api.Block,
  environment: api.Block,
): void {
  if (!isDrawable(library.grid)) {
    throw new api.Problem(
      `${library.name} has a grid over ${library.grid.map(({ angle }) => angle).join(", ")}: the explorer draws theta_h, theta_d, phi_d.`,
    );
  }
  const theme = (localStorage.getItem(THEME) ?? "auto") as Theme;
  const store = createState(library, fromHash(location.hash, library), theme);
  const context: Context = {
    store,
    actions: new Actions(store),
    thumbnails: new Thumbnails(
      library.materials.map(({ name }) => name),
      thumbnails,
    ),
    tables: new Tables(library.grid as unknown as readonly [Axis, Axis, Axis]),
    environment,
  };
  applyTheme(store);
  app.className = "ready";
  app.replaceChildren(
    head(context),
    spaceView(context),
    materialView(context),
    el("div.side", {}, {}, recipePanel(context), brdfPanel(context)),
    routePanel(context),
  );
  fetchRoutes(context);
  fetchPlaces(context);
  fetchSpaces(context);
  keepLink(store);
  play(context);
  listenToKeys(context);
}

function fetchRoutes({ store, actions }: Context): void {
  const problem = (error: Error) => error.name !== "AbortError" && store.set({ problem: error.message });
  let running = new AbortController();
  store.watch(
    ({ space, pace, stops }) => [space, pace, stops] as const,
    ([space, pace, stops]) => {
      running.abort();
      running = new AbortController();
      api.route(space, pace, stops, running.signal).then(actions.setRoute, problem);
    },
  );
  let other = new AbortController();
  store.watch(
    ({ compare, pace, stops }) => [compare, pace, stops] as const,
    ([compare, pace, stops]) => {
      other.abort();
      other = new AbortController();
      if (compare === "") actions.setOtherRoute(null);
      else api.route(compare, pace, stops, other.signal).then(actions.setOtherRoute, problem);
    },
  );
}

function fetchPlaces({ store, actions }: Context): void {
  let running = new AbortController();
  store.watch(
    ({ point }) => point,
    (point) => {
      running.abort();
      running = new AbortController();
      if (point === null) return;
      api.place(store.get().space, point, running.signal).then(actions.setPlace, (error: Error) => {
        if (error.name !== "AbortError") store.set({ problem: error.message });
      });
    },
  );
}

function fetchSpaces({ store }: Context): void {
  store.watch(
    ({ space }) => space,
    (space) => {
      api.spaceView(space).then(
        (view) => store.get().space === space && store.set({ view }),
        (error: Error) => store.set({ problem: error.message }),
      );
    },
  );
}

function keepLink(store: Store<State>): void {
  let timer = 0;
  store.watch(
    ({ space, pace, stops, t, point, compare, shape, light, exposure, orbit }) => [
      space,
      pace,
      stops,
      t,
      point,
      compare,
      shape,
      light,
      exposure,
      orbit,
    ],
    () => {
      clearTimeout(timer);
      timer = window.setTimeout(() => history.replaceState(null, "", toHash(store.get())), 150);
    },
  );
}

function applyTheme(store: Store<State>): void {
  const system = matchMedia("(prefers-color-scheme: light)");
  const apply = () => {
    const { theme } = store.get();
    document.documentElement.dataset.theme = theme === "auto" ? (system.matches ? "light" : "dark") : theme;
    document.dispatchEvent(new Event("themechange"));
  };
  system.addEventListener("change", apply);
  store.watch(
    ({ theme }) => theme,
    (theme) => {
      localStorage.setItem(THEME, theme);
      apply();
    },
  );
}

const SECONDS_A_ROUTE = 6;

/** There and back, evenly in t. */
function play({ store, actions }: Context): void {
  store.watch(
    ({ playing }) => playing,
    (playing) => {
      if (!playing) return;
      let last = performance.now();
      let way = store.get().t >= 1 ? -1 : 1;
      const step = (now: number) => {
        const { playing, t, stops } = store.get();
        if (!playing) return;
        // After a hidden tab or a long frame the material goes on from where it was.
        const next = t + (way * Math.min(now - last, 100)) / (1000 * SECONDS_A_ROUTE * (stops.length - 1));
        last = now;
        if (next >= 1) way = -1;
        if (next <= 0) way = 1;
        actions.setT(next);
        requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    },
  );
}

void start();
