// Colours for numbers: from dark to light with the number, told apart by everybody who sees lightness.
//
// The stops are those of viridis (S. van der Walt, N. Smith, 2015; CC0).

import type { AttributeView } from "./api/schema";
import { sliderOf } from "./asked";
import { clamp } from "./numbers";

export const STOPS = [
  [68, 1, 84],
  [59, 82, 139],
  [33, 145, 140],
  [94, 201, 98],
  [253, 231, 37],
] as const;

/** sRGB in [0, 1] of a share in [0, 1]. */
export function tintOf(share: number): [number, number, number] {
  const at = clamp(share, 0, 1) * (STOPS.length - 1);
  const i = Math.min(Math.floor(at), STOPS.length - 2);
  const [from, to] = [STOPS[i]!, STOPS[i + 1]!];
  const mixed = (c: 0 | 1 | 2) => (from[c] + (at - i) * (to[c] - from[c])) / 255;
  return [mixed(0), mixed(1), mixed(2)];
}

/** The colour of each material by an attribute; null for one that has none. */
export function tintsOf({ values }: AttributeView): (readonly [number, number, number] | null)[] {
  const { toShare } = sliderOf(values);
  return values.map((value) => (value === null ? null : tintOf(toShare(value))));
}

/** Least, middle and most of the colours. */
export function legendOf({ values }: AttributeView): readonly number[] {
  const { toValue } = sliderOf(values);
  return [0, 0.5, 1].map(toValue);
}
