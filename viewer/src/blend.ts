// How the weighted materials of a recipe become one: a blend, and what the body of that is multiplied by (halfway.recipes).
// Pictures mix as materials do where the tables are added up as they are, and nowhere else.

import type { RecipeDocument } from "./api/schema";

/** The blend whose pictures mix. */
export const LINEAR = "linear";

export type Mixing = Pick<RecipeDocument, "blend" | "body_scale">;

export const PLAIN: Mixing = { blend: LINEAR };

/** What the body is multiplied by in red, green and blue; null where it is as it was mixed. */
export function bodyScale({ body_scale }: Mixing): readonly [number, number, number] | null {
  return body_scale?.some((factor) => factor !== 1) ? body_scale : null;
}

/** The inverses of the functions in which sums are taken; the coordinates of a blend's spaces are in those. */
const BACK: Readonly<Record<string, (mapped: number) => number>> = {
  root: (x) => x * x,
  lobes: (x) => x * x,
  log: Math.expm1,
};

export function unmapped(blend: string, mapped: number): number {
  return BACK[blend]?.(mapped) ?? mapped;
}

/** Whether pictures of the mix are those of its materials, mixed: the page makes them of those. */
export function picturesMix(mixing: Mixing): boolean {
  return mixing.blend === LINEAR && bodyScale(mixing) === null;
}
