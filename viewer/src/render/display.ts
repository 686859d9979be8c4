// From the coordinates of a space to where they are drawn: compressed along each axis, scaled into a cube.
//
// Scores span five decades: x is drawn at asinh((x - centre) / spread), with centre and spread from the server.

import { Vector3 } from "three";

import type { Embedding } from "../api/schema";

export class Display {
  readonly points: readonly Vector3[];
  private readonly low: readonly number[];
  private readonly high: readonly number[];

  constructor(readonly embedding: Embedding) {
    const compressed = embedding.points.map((point) => point.map((x, i) => this.compress(x, i)));
    this.low = embedding.axes.map((_, i) => Math.min(...compressed.map((p) => p[i]!)));
    this.high = embedding.axes.map((_, i) => Math.max(...compressed.map((p) => p[i]!)));
    this.points = embedding.points.map((point) => this.place(point));
  }

  /** Where a point of the space is drawn, within [-1, 1]. */
  place(point: readonly number[]): Vector3 {
    const [x = 0, y = 0, z = 0] = point.map((value, i) => {
      const [low, high] = [this.low[i]!, this.high[i]!];
      return high > low ? (2 * (this.compress(value, i) - low)) / (high - low) - 1 : 0;
    });
    return new Vector3(x, y, z);
  }

  /** The point of a mix is the mix of the points. */
  mix(weights: readonly (readonly [number, number])[]): Vector3 {
    const sum = this.embedding.axes.map((_, axis) =>
      weights.reduce((total, [i, weight]) => total + weight * this.embedding.points[i]![axis]!, 0),
    );
    return this.place(sum);
  }

  private compress(x: number, axis: number): number {
    const { centre, spread } = this.embedding.axes[axis]!;
    return Math.asinh((x - centre) / spread);
  }
}
