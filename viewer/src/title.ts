// What the material that is shown is called: in files, in the window's title.

import { meanWeight } from "./recipe";
import type { State } from "./state";

type Named = Pick<State, "stops" | "t" | "atPoint" | "held" | "recipe">;

/** What one calls it at first sight: t comes first, for names are cut. */
export function shortName(state: Named): string {
  const { stops, t, atPoint, held, recipe } = state;
  if (held) return held.name;
  if (atPoint !== null || recipe.length === 1) return materialName(state);
  return `${t.toFixed(2)} ${stops[0]} to ${stops.at(-1)}`;
}

/** Of a file: the name that a person gave it, its one material, its route and t, or what a free point is mostly made of. */
export function materialName({ stops, t, atPoint, held, recipe }: Named): string {
  if (held) return fileName(held.name);
  const [only, ...others] = recipe;
  if (only && others.length === 0) return only.name;
  if (atPoint === null) return `${stops[0]}-to-${stops.at(-1)}-${t.toFixed(3)}`;
  const most = [...recipe].sort((a, b) => meanWeight(b) - meanWeight(a)).slice(0, 2);
  return most.map((each) => `${each.name}-${Math.round(100 * meanWeight(each))}`).join("-");
}

/** What a person wrote, as one word of a shell and a file of any system. */
export function fileName(name: string): string {
  return name.replaceAll(/[^\p{L}\p{N}_.()-]+/gu, "-").replace(/^-|-$/g, "");
}
