// Which tables a route needs, those nearest to t first.

import type { RouteView } from "./api/schema";
import { CHANNELS } from "./recipe";

/** All materials of the route, by the distance from t to where they carry weight. */
export function nearestFirst(route: RouteView, t: number): string[] {
  return route.names
    .map((name, i) => ({ name, distance: distance(route, i, t) }))
    .sort((a, b) => a.distance - b.distance)
    .map(({ name }) => name);
}

function distance({ knots, weights }: RouteView, i: number, t: number): number {
  // A weight that is positive at a knot is so on both pieces around it.
  const carried = (k: number) => CHANNELS.some((channel) => (weights[channel][k]?.[i] ?? 0) > 0);
  return Math.min(
    ...knots.slice(1).map((to, k) => {
      if (!carried(k) && !carried(k + 1)) return Number.POSITIVE_INFINITY;
      return Math.max(knots[k]! - t, t - to, 0);
    }),
  );
}
