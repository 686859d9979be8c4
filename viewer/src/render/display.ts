// From the coordinates of a space to where they are drawn: each axis stretched so that the materials spread evenly.
//
// Scores are ruled by the highlight and span five decades; a plain plot is one heap and a few points far away. A coordinate
// is drawn at its rank among the materials, linear between two of them: the order along each axis is kept, distances are not.

import { Vector3 } from "three";

import type { Embedding } from "../api/schema";

export class Display {
  readonly points: readonly Vector3[];
  private readonly sorted: readonly (readonly number[])[];

  constructor(readonly embedding: Embedding) {
    this.sorted = embedding.axes.map((_, axis) => {
      const values = new Set(embedding.points.map((point) => point[axis]!));
      return [...values].sort((a, b) => a - b);
    });
    this.points = embedding.points.map((point) => this.place(point));
  }

  /** Where a point of the space is drawn, within [-1, 1]. */
  place(point: readonly number[]): Vector3 {
    const [x = 0, y = 0, z = 0] = point.map((value, axis) => this.rank(value, this.sorted[axis]!));
    return new Vector3(x, y, z);
  }

  /** The point of a mix is the mix of the points. */
  mix(weights: readonly (readonly [number, number])[]): Vector3 {
    const sum = this.embedding.axes.map((_, axis) =>
      weights.reduce((total, [i, weight]) => total + weight * this.embedding.points[i]![axis]!, 0),
    );
    return this.place(sum);
  }

  private rank(value: number, sorted: readonly number[]): number {
    if (sorted.length < 2) return 0;
    let low = 0;
    let high = sorted.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (sorted[middle]! <= value) low = middle;
      else high = middle;
    }
    const share = (value - sorted[low]!) / (sorted[high]! - sorted[low]!);
    return (2 * (low + Math.min(Math.max(share, 0), 1))) / (sorted.length - 1) - 1;
  }
}
