// The material at a free point, of data alone: each simplex between materials has the matrix that gives its vertices' weights.

import type { ChartView } from "./api/schema";
import { dot, sum } from "./numbers";

/** A weight above minus this is 0: rounding, not a point outside. */
const INSIDE = 1e-9;

/** The vertices around a point and their weights; outside of all simplices, those of a mix nearby. */
export interface Located {
  readonly vertices: readonly number[];
  readonly weights: readonly number[];
  readonly inside: boolean;
}

/** Where x is in a chart: in the simplex whose least weight is the largest, without the vertices that it is beyond. */
export function locate({ simplices, barycentric }: ChartView, x: readonly number[]): Located {
  const one = [...x, 1];
  let best = { least: Number.NEGATIVE_INFINITY, simplex: 0, weights: [] as number[] };
  barycentric.forEach((matrix, simplex) => {
    const weights = matrix.map((row) => dot(row, one));
    const least = Math.min(...weights);
    if (least > best.least) best = { least, simplex, weights };
  });
  const positive = best.weights.map((w) => (w > INSIDE ? w : 0));
  const total = sum(positive);
  return {
    vertices: simplices[best.simplex]!,
    weights: positive.map((w) => w / total),
    inside: best.least >= -INSIDE,
  };
}
