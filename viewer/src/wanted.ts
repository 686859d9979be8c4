// Which materials' tables are needed, and which come next, those nearest to t first.

import { LINEAR } from "./blend";
import { CHANNELS, namesIn } from "./recipe";
import { mixedName } from "./render/tables";
import type { Route } from "./route";
import { drawnOf, otherDrawnOf } from "./shown";
import type { State } from "./state";

/** What is shown; before the route has come, the stops beside t: a good guess. */
export function shownNames(state: State): string[] {
  const { blend, stops, t } = state;
  const drawn = drawnOf(state);
  if (drawn.length > 0) return namesIn(drawn, otherDrawnOf(state));
  if (blend !== LINEAR) return [mixedName()];
  const leg = Math.min(Math.floor(t * (stops.length - 1)), stops.length - 2);
  return stops.slice(leg, leg + 2);
}

/** What the slider meets next, on both routes by turns. */
export function comingUp({ route, otherRoute, t }: State): string[] {
  const own = route?.blend === LINEAR ? nearestFirst(route, t) : [];
  const other = otherRoute?.blend === LINEAR ? nearestFirst(otherRoute, t) : [];
  return [...new Set(own.flatMap((name, i) => [name, other[i] ?? name]).concat(other))];
}

/** All materials of the route, by the distance from t to where they carry weight. */
export function nearestFirst(route: Route, t: number): string[] {
  return route.names
    .map((name, i) => ({ name, distance: distance(route, i, t) }))
    .sort((a, b) => a.distance - b.distance)
    .map(({ name }) => name);
}

function distance({ knots, weights }: Route, i: number, t: number): number {
  // A weight that is positive at a knot is so on both pieces around it.
  const carried = (k: number) => CHANNELS.some((channel) => (weights[channel][k]?.[i] ?? 0) > 0);
  return Math.min(
    ...knots.slice(1).map((to, k) => {
      if (!carried(k) && !carried(k + 1)) return Number.POSITIVE_INFINITY;
      return Math.max(knots[k]! - t, t - to, 0);
    }),
  );
}
