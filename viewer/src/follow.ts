// What runs beside the panels: the client is asked for what the state needs, the link follows it, and time goes on.

import type { Block } from "./api/client";
import type { RecipeDocument } from "./api/schema";
import { type Mixing, picturesMix } from "./blend";
import { toDrawable } from "./brdf/grid";
import { followChoice } from "./choosing";
import { comparedSpace } from "./compared";
import type { Context } from "./context";
import { followNumbers } from "./measuring";
import { toHash } from "./permalink";
import { followPointer } from "./pointing";
import { type Ingredient, only, toDocument } from "./recipe";
import { Refined } from "./refined";
import { mixedName } from "./render/tables";
import { join, type Route, reversed } from "./route";
import { toText } from "./shortlist";
import { DRAWN, mixingOf, otherMixingOf } from "./shown";
import { LINKED, type MixedKey, type Panel, type State, usualBlend } from "./state";
import { shortName } from "./title";
import { comingUp, shownNames } from "./wanted";

export function follow(context: Context): void {
  fetchPictures(context);
  fetchRoutes(context);
  fetchOtherRoutes(context);
  fetchAtPoint(context);
  fetchSpaces(context);
  fetchTables(context);
  fetchMixes(context);
  followNumbers(context);
  followChoice(context);
  followPointer(context);
  keepLink(context);
  keepShortlist(context);
  play(context);
}

/** The small pictures of all materials, which stand in many places. */
function fetchPictures({ client, store, actions, thumbnails }: Context): void {
  thumbnails.onProblem = (problem) => actions.say("route", "pictures", problem);
  client.thumbnails().then(
    (pictures) => {
      thumbnails.fill(pictures);
      store.set({ pictured: true });
    },
    (error: Error) => {
      if (error.name !== "AbortError") actions.say("space", "pictures", error.message);
    },
  );
}

/** The route through the stops. */
function fetchRoutes(context: Context): void {
  const { store, actions } = context;
  let shown: string | null = null;
  latest(context, "route", "route", ["space", "blend", "pace", "stops"], async (state, running) => {
    store.set({ behind: shown });
    const route = await fetchRoute(context, state.space, state.blend, state, running);
    if (running.aborted) return;
    const blend = state.blend === usualBlend(state.library, state.space) ? "" : `, ${state.blend}`;
    shown = `${state.stops.join(" to ")}, ${state.space}${blend}`;
    store.set({ behind: null });
    actions.setRoute(route);
  });
}

/** Its legs, each asked for in the library's order. */
async function fetchRoute(
  { client, names }: Context,
  space: string,
  blend: string,
  { pace, stops }: State,
  running: AbortSignal,
): Promise<Route> {
  const leg = async (stop: string, i: number) => {
    const start = stops[i]!;
    if (names.indexOf(start) < names.indexOf(stop))
      return client.leg(space, blend, start, stop, pace, running);
    return reversed(await client.leg(space, blend, stop, start, pace, running));
  };
  // A browser asks few questions at once: one, while the space that they all need is being computed.
  const [first, ...others] = stops.slice(1);
  const legs = [await leg(first!, 0)];
  const all = legs.concat(await Promise.all(others.map((stop, i) => leg(stop, i + 1))));
  return join(all, pace, names, blend);
}

/** The way of the compared space through the same stops, in the blend that is usual there. */
function fetchOtherRoutes(context: Context): void {
  const { actions } = context;
  latest(context, "route", "compared route", ["compare", "pace", "stops"], async (state, running) => {
    const space = comparedSpace(state.compare);
    if (space === null) {
      actions.compareWith(state.compare);
      return;
    }
    const blend = usualBlend(state.library, space);
    const route = await fetchRoute(context, space, blend, state, running);
    if (!running.aborted) actions.setOtherRoute(route);
  });
}

/** The material at a free point. */
function fetchAtPoint(context: Context): void {
  const { client, actions } = context;
  latest(context, "space", "point", ["point"], async ({ space, blend, point }, running) => {
    if (point !== null) actions.setAtPoint(await client.at(space, blend, point, running));
  });
}

/** The space to look at. */
function fetchSpaces(context: Context): void {
  const { client, store } = context;
  latest(context, "space", "space", ["space", "blend"], async ({ space, blend }, running) => {
    const view = await client.spaceView(space, blend);
    if (!running.aborted) store.set({ view });
  });
}

/** Tables of what is shown and of what comes next; who draws from them hears when one has come. */
function fetchTables({ tables, store, actions }: Context): void {
  tables.onChange = (name, problem) => {
    store.set({ arrived: store.get().arrived + 1 });
    actions.say("material", `table ${name}`, problem);
  };
  store.watch(DRAWN, (state) => tables.want(shownNames(state), state.recipe.length ? comingUp(state) : []));
}

/** Tables of what is shown where pictures do not mix; each is a material of its own. */
function fetchMixes(context: Context): void {
  const { store } = context;
  const own = mixedTable(context, "mixed");
  const other = mixedTable(context, "otherMixed");
  const ghosts = mixedTable(context, "ghostMixed");
  const moving = ["recipe", "route", "otherRecipe", "otherRoute", "ghost", "asked", "counting"] as const;
  store.watch(moving, (state) => {
    const document = (recipe: readonly Ingredient[], mixing: Mixing) =>
      recipe.length === 0 || picturesMix(mixing) ? null : toDocument(state.library.name, recipe, mixing);
    // While numbers are found, the recipe is about to change again.
    own.want(document(state.recipe, mixingOf(state)), state.asked !== null && state.counting);
    other.want(document(state.otherRecipe, otherMixingOf(state)));
    ghosts.want(state.ghost && document(state.ghost.recipe, state.ghost));
  });
}

function mixedTable(context: Context, key: MixedKey): Refined<RecipeDocument, Block> {
  const { client, store, actions, tables } = context;
  let number = 0;
  return new Refined({
    ask: client.mixed,
    onAnswer: ({ halfs, scale }, small) => {
      // The full table is the same mix as the small one before it.
      if (small) number++;
      const name = mixedName(`${key} ${number}`, small);
      const grid = small ? toDrawable(store.get().library.small_grid) : tables.grid;
      tables.put({ name, grid, halfs, scale });
      store.set({ [key]: only(name), arrived: store.get().arrived + 1 });
    },
    onBehind: (behind) => {
      const others = store.get().mixing.filter((each) => each !== key);
      store.set({ mixing: behind ? [...others, key] : others });
    },
    onProblem: (problem) => actions.say("material", key, problem),
  });
}

/** Ask whenever one of the fields changes; the question before is taken back, and a failure is said. */
function latest(
  { store, actions, signal }: Context,
  panel: Panel,
  cause: string,
  fields: readonly (keyof State)[],
  ask: (state: State, running: AbortSignal) => Promise<void>,
): void {
  let running = new AbortController();
  signal.addEventListener("abort", () => running.abort());
  store.watch(fields, (state) => {
    running.abort();
    running = new AbortController();
    ask(state, running.signal).then(
      () => actions.say(panel, cause, null),
      (error: Error) => {
        if (error.name !== "AbortError") actions.say(panel, cause, error.message);
      },
    );
  });
}

/** Milliseconds after which the link follows. */
const UNHURRIED = 150;

function keepLink({ store, options, signal }: Context): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  signal.addEventListener("abort", () => clearTimeout(timer));
  store.watch([...LINKED, "held", "recipe"], () => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      options.onFragment?.(toHash(store.get()));
      options.onTitle?.(shortName(store.get()));
    }, UNHURRIED);
  });
}

/** The shortlist stays where the page stands, for each library. */
function keepShortlist({ store, options }: Context): void {
  let before = store.get().kept;
  store.watch(["kept"], ({ kept, library }) => {
    if (kept !== before) options.onKept?.(library.name, toText(library.name, kept));
    before = kept;
  });
}

const SECONDS_A_ROUTE = 6;

/** There and back, evenly in t. */
function play({ store, actions, signal }: Context): void {
  store.watch(["playing"], ({ playing, t }) => {
    if (!playing) return;
    let last = performance.now();
    let way = t >= 1 ? -1 : 1;
    const step = (now: number) => {
      const { playing, t, stops } = store.get();
      if (!playing || signal.aborted) return;
      // After a hidden tab or a long frame the material goes on from where it was.
      const next = t + (way * Math.min(now - last, 100)) / (1000 * SECONDS_A_ROUTE * (stops.length - 1));
      last = now;
      if (next >= 1) way = -1;
      if (next <= 0) way = 1;
      actions.setT(next);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
}
