// What the material that is shown is called: in files, in the window's title.

import { meanWeight } from "./recipe";
import type { State } from "./state";

type Named = Pick<State, "stops" | "t" | "atPoint" | "recipe">;

/** Of a file: its one material, its route and t, or what a free point is mostly made of. */
export function materialName({ stops, t, atPoint, recipe }: Named): string {
  const [only, ...others] = recipe;
  if (only && others.length === 0) return only.name;
  if (atPoint === null) return `${stops[0]}-to-${stops.at(-1)}-${t.toFixed(3)}`;
  const most = [...recipe].sort((a, b) => meanWeight(b) - meanWeight(a)).slice(0, 2);
  return most.map((each) => `${each.name}-${Math.round(100 * meanWeight(each))}`).join("-");
}
