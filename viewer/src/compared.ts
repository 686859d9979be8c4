// What is shown beside, by the name that the state and a link have for it.

import type { Kept } from "./shortlist";
import type { State } from "./state";

const STOP = "stop:";
const KEPT = "kept:";

/** The material that is compared with; null when it is a space, or nothing. */
export function comparedStop(compare: string): string | null {
  return compare.startsWith(STOP) ? compare.slice(STOP.length) : null;
}

/** The space that is compared with; null when it is a material, or nothing. */
export function comparedSpace(compare: string): string | null {
  return compare === "" || compare.startsWith(STOP) || compare.startsWith(KEPT) ? null : compare;
}

/** The one of the shortlist that is compared with; null when it is anything else. */
export function comparedKept({ compare, kept }: Pick<State, "compare" | "kept">): Kept | null {
  return kept.find(({ id }) => compare === KEPT + id) ?? null;
}

/** What one of the shortlist is called where it is compared with. */
export function asComparedKept({ id }: Pick<Kept, "id">): string {
  return KEPT + id;
}

/** What a material is called where it is compared with. */
export function asCompared(material: string): string {
  return STOP + material;
}
