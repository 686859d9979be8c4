// From the coordinates of a space to where they are drawn: each axis stretched so that the materials spread evenly.
//
// Scores are ruled by the highlight and span five decades; a plain plot is one heap and a few points far away. An axis is
// drawn on the scale of its quantiles, smooth between them: the order along each axis is kept, distances are not.

import { Vector3 } from "three";

import type { Embedding } from "../api/schema";

const MAX_QUANTILES = 13;

export class Display {
  readonly points: readonly Vector3[];
  private readonly scales: readonly ((x: number) => number)[];

  constructor(readonly embedding: Embedding) {
    this.scales = embedding.axes.map((_, axis) =>
      quantileScale(embedding.points.map((point) => point[axis]!)),
    );
    this.points = embedding.points.map((point) => this.place(point));
  }

  /** Where a point of the space is drawn, within [-1, 1]. */
  place(point: readonly number[]): Vector3 {
    const [x = 0, y = 0, z = 0] = point.map((value, axis) => this.scales[axis]!(value));
    return new Vector3(x, y, z);
  }

  /** The point of a mix is the mix of the points. */
  mix(weights: readonly (readonly [number, number])[]): Vector3 {
    const sum = this.embedding.axes.map((_, axis) =>
      weights.reduce((total, [i, weight]) => total + weight * this.embedding.points[i]![axis]!, 0),
    );
    return this.place(sum);
  }
}

/** A monotone map that takes the quantiles of the values to even steps from -1 to 1. */
export function quantileScale(values: readonly number[]): (x: number) => number {
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  if (sorted.length < 2) return () => 0;
  const n = Math.min(MAX_QUANTILES, sorted.length);
  const xs = Array.from({ length: n }, (_, i) => sorted[Math.round((i * (sorted.length - 1)) / (n - 1))]!);
  return monotone(
    xs,
    xs.map((_, i) => (2 * i) / (n - 1) - 1),
  );
}

/** Monotone cubic interpolation: F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5(2), 1984, equation 5. */
function monotone(xs: readonly number[], ys: readonly number[]): (x: number) => number {
  const slopes = xs.slice(1).map((x, i) => (ys[i + 1]! - ys[i]!) / (x - xs[i]!));
  const tangents = xs.map((_, i) => {
    const [a, b] = [slopes[i - 1] ?? slopes[i]!, slopes[i] ?? slopes[i - 1]!];
    return a * b > 0 ? (2 * a * b) / (a + b) : 0;
  });
  return (x) => {
    let i = 0;
    while (i < xs.length - 2 && x >= xs[i + 1]!) i++;
    const width = xs[i + 1]! - xs[i]!;
    const s = Math.min(Math.max((x - xs[i]!) / width, 0), 1);
    const [s2, s3] = [s * s, s * s * s];
    return (
      (2 * s3 - 3 * s2 + 1) * ys[i]! +
      (s3 - 2 * s2 + s) * width * tangents[i]! +
      (3 * s2 - 2 * s3) * ys[i + 1]! +
      (s3 - s2) * width * tangents[i + 1]!
    );
  };
}
