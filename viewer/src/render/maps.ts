// From the coordinates of a space to where they are drawn.
//
// Scores are ruled by the highlight and span five decades; a plain plot is one heap and a few points far away. So each axis is
// drawn on the scale of its quantiles, smooth between them: the order along it is kept, distances are not. The cloud is then
// turned so that its longest way is upright and its next longest from left to right.

import { Matrix3, Vector3 } from "three";

import type { EmbeddingView } from "../api/schema";
import type { Mixing } from "../blend";
import { mixedPoint } from "../coordinates";
import { clamp } from "../numbers";
import type { Ingredient } from "../recipe";
import { principalAxes } from "./axes";

/** Where materials and recipes are drawn. */
export interface SpaceMap {
  /** Of the materials, in the library's order, around the origin. */
  readonly points: readonly Vector3[];
  /** Of a mix; where that takes a picture that is not there yet, roughly, and `then` runs when it is. */
  readonly pointOf: (recipe: readonly Ingredient[], mixing: Mixing, then: () => void) => Vector3;
}

/** A value on an axis, and where it is. */
export interface Tick {
  readonly value: number;
  readonly at: Vector3;
}

const N_AXES = 3;
const MAX_QUANTILES = 13;
/** Of the longest way of the cloud from its middle. */
const RADIUS = 1.35;

/** By the coordinates of an embedding. */
export class CoordinateMap implements SpaceMap {
  readonly points: readonly Vector3[];
  private readonly extents: readonly (readonly [number, number])[];
  private readonly scales: readonly ((x: number) => number)[];
  private readonly centre = new Vector3();
  private readonly turn = new Matrix3();

  private readonly embedding: EmbeddingView;

  constructor(
    { axes, ...whole }: EmbeddingView,
    private readonly names: readonly string[],
  ) {
    // More cannot be seen together.
    const embedding = { ...whole, axes: axes.slice(0, N_AXES) };
    this.embedding = embedding;
    const columns = embedding.axes.map((_, axis) => embedding.points.map((point) => point[axis]!));
    this.scales = columns.map(quantileScale);
    this.extents = columns.map((values) => [Math.min(...values), Math.max(...values)]);
    const stretched = embedding.points.map((point) => this.stretch(point));
    for (const point of stretched) this.centre.addScaledVector(point, 1 / stretched.length);
    const centred = stretched.map((point) => point.clone().sub(this.centre));
    const principal = principalAxes(centred);
    const spread = principal.map((axis) =>
      Math.max(...centred.map((point) => Math.abs(point.dot(axis))), 1e-6),
    );
    const [upright, across, away] = principal.map((axis, i) =>
      // Half way to a ball: a cloud like a needle would leave the panel empty.
      axis.clone().multiplyScalar(RADIUS / Math.sqrt(spread[0]! * spread[i]!)),
    );
    this.turn.set(...across!.toArray(), ...away!.toArray(), ...upright!.toArray());
    this.points = stretched.map((point) => this.toView(point));
  }

  pointOf(recipe: readonly Ingredient[]): Vector3 {
    return this.pointAt(mixedPoint(this.embedding, this.names, recipe));
  }

  /** Where coordinates are drawn; beyond the materials' extent, at its end. */
  pointAt(coordinates: readonly number[]): Vector3 {
    return this.toView(this.stretch(coordinates));
  }

  /** Each axis as values from its end to its end and where they are drawn, the others in their middle. */
  axes(count: number): { readonly name: string; readonly ticks: readonly Tick[] }[] {
    const middles = this.extents.map((extent, axis) => invert(this.scales[axis]!, 0, extent));
    return this.embedding.axes.map((name, axis) => {
      const even = Array.from({ length: count }, (_, i) => (2 * i) / (count - 1) - 1);
      const values = even.map((share) => invert(this.scales[axis]!, share, this.extents[axis]!));
      return { name, ticks: values.map((value) => ({ value, at: this.pointAt(middles.with(axis, value)) })) };
    });
  }

  /** The coordinates of what is drawn at a point: the inverse of `pointAt`. */
  coordinatesAt(view: Vector3): number[] {
    const stretched = view.clone().applyMatrix3(this.turn.clone().invert()).add(this.centre);
    return this.scales.map((scale, axis) => invert(scale, stretched.getComponent(axis), this.extents[axis]!));
  }

  private stretch(point: readonly number[]): Vector3 {
    const [x = 0, y = 0, z = 0] = this.scales.map((scale, axis) => scale(point[axis]!));
    return new Vector3(x, y, z);
  }

  private toView(point: Vector3): Vector3 {
    return point.clone().sub(this.centre).applyMatrix3(this.turn);
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

/** Where a monotone map takes a value, within the extent: by halving. */
function invert(map: (x: number) => number, value: number, [low, high]: readonly [number, number]): number {
  let [from, to] = [low, high];
  for (let step = 0; step < 60; step++) {
    const middle = (from + to) / 2;
    if (map(middle) < value) from = middle;
    else to = middle;
  }
  return (from + to) / 2;
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
    const s = clamp((x - xs[i]!) / width, 0, 1);
    const [s2, s3] = [s * s, s * s * s];
    return (
      (2 * s3 - 3 * s2 + 1) * ys[i]! +
      (s3 - 2 * s2 + s) * width * tangents[i]! +
      (3 * s2 - 2 * s3) * ys[i + 1]! +
      (s3 - s2) * width * tangents[i + 1]!
    );
  };
}
