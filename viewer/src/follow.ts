// What runs beside the panels: the server is asked for what the state needs, the link follows it, and time goes on.

import type { Context } from "./context";
import { toHash } from "./permalink";
import { comparedStop, type State } from "./state";

/** The route through the stops. */
export function fetchRoutes({ client, store, actions, signal }: Context): void {
  latest(
    store,
    signal,
    ({ space, pace, stops }) => [space, pace, stops] as const,
    ([space, pace, stops], running) => client.route(space, pace, stops, running).then(actions.setRoute),
  );
}

/** The way of the compared space through the same stops. */
export function fetchOtherRoutes({ client, store, actions, signal }: Context): void {
  latest(
    store,
    signal,
    ({ compare, pace, stops }) => [compare, pace, stops] as const,
    async ([compare, pace, stops], running) => {
      if (compare === "" || comparedStop(compare) !== null) actions.compareWith(compare);
      else actions.setOtherRoute(await client.route(compare, pace, stops, running));
    },
  );
}

/** The material at a free place. */
export function fetchPlaces({ client, store, actions, signal }: Context): void {
  latest(
    store,
    signal,
    ({ point }) => point,
    async (point, running) => {
      if (point !== null) actions.setPlace(await client.place(store.get().space, point, running));
    },
  );
}

/** The space to look at. */
export function fetchSpaces({ client, store, signal }: Context): void {
  latest(
    store,
    signal,
    ({ space }) => space,
    async (space, running) => {
      const view = await client.spaceView(space);
      if (!running.aborted) store.set({ view });
    },
  );
}

/** Ask whenever the selected part changes; the question before is taken back, and a failure is said. */
function latest<S>(
  store: Context["store"],
  signal: AbortSignal,
  select: (state: State) => S,
  ask: (selected: S, running: AbortSignal) => Promise<void>,
): void {
  let running = new AbortController();
  signal.addEventListener("abort", () => running.abort());
  store.watch(select, (selected) => {
    running.abort();
    running = new AbortController();
    ask(selected, running.signal).catch((error: Error) => {
      if (error.name !== "AbortError") store.set({ problem: error.message });
    });
  });
}

export function keepLink({ store, options, signal }: Context): void {
  let timer = 0;
  signal.addEventListener("abort", () => clearTimeout(timer));
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
      timer = window.setTimeout(() => options.onFragment?.(toHash(store.get())), 150);
    },
  );
}

const SECONDS_A_ROUTE = 6;

/** There and back, evenly in t. */
export function play({ store, actions, signal }: Context): void {
  store.watch(
    ({ playing }) => playing,
    (playing) => {
      if (!playing) return;
      let last = performance.now();
      let way = store.get().t >= 1 ? -1 : 1;
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
    },
  );
}
