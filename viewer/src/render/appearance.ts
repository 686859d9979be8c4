// The materials by what they look like: those that look alike are close, whatever their scores.
//
// A material's small picture, averaged to blocks and coded by the cube root (about as CIELAB codes lightness), is a vector; the
// map is its first three principal components over the library. A mix is placed by its own picture, so a route that makes a
// detour through other colours is seen to make it.

import { Vector3 } from "three";

import type { Ingredient } from "../recipe";
import type { Thumbnails } from "../thumbnails";
import type { Placement } from "./display";

const BLOCKS = 12;
const ITERATIONS = 40;
const RADIUS = 1.42;

export class Appearance implements Placement {
  readonly points: readonly Vector3[];
  private readonly mean: Float64Array;
  private readonly axes: readonly Float64Array[];
  private readonly scale: number;

  constructor(
    names: readonly string[],
    private readonly thumbnails: Thumbnails,
  ) {
    const vectors = names.map((name) => this.code([{ name, weight: [1, 1, 1] }]));
    const size = vectors[0]?.length ?? 0;
    this.mean = new Float64Array(size);
    for (const vector of vectors) for (let i = 0; i < size; i++) this.mean[i]! += vector[i]! / vectors.length;
    for (const vector of vectors) for (let i = 0; i < size; i++) vector[i]! -= this.mean[i]!;
    this.axes = components(vectors, 3);
    const places = vectors.map((vector) => this.project(vector));
    this.scale = RADIUS / Math.max(...places.map((p) => p.length()), 1e-9);
    this.points = places.map((p) => p.multiplyScalar(this.scale));
  }

  place(recipe: readonly Ingredient[]): Vector3 {
    const vector = this.code(recipe);
    for (let i = 0; i < vector.length; i++) vector[i]! -= this.mean[i]!;
    return this.project(vector).multiplyScalar(this.scale);
  }

  private code(recipe: readonly Ingredient[]): Float64Array {
    return this.thumbnails.blocks(recipe, BLOCKS).map((x) => Math.cbrt(Math.max(x, 0)));
  }

  /** Second component to the right, third away, first up. */
  private project(vector: Float64Array): Vector3 {
    const [up, right, away] = this.axes.map((axis) => dot(axis, vector));
    return new Vector3(right, away, up);
  }
}

/** The first principal components of centred vectors, by orthogonal iteration; each of unit length, brighter is positive. */
export function components(vectors: readonly Float64Array[], count: number): Float64Array[] {
  const size = vectors[0]?.length ?? 0;
  // Any start will do that is not orthogonal to the answer; the same each time.
  let axes: Float64Array[] = Array.from({ length: count }, (_, k) =>
    Float64Array.from({ length: size }, (_, i) => Math.sin((k + 1) * (i + 1))),
  );
  for (let iteration = 0; iteration < ITERATIONS; iteration++) {
    axes = orthonormal(
      axes.map((axis) => {
        const next = new Float64Array(size);
        for (const vector of vectors) {
          const along = dot(axis, vector);
          for (let i = 0; i < size; i++) next[i]! += along * vector[i]!;
        }
        return next;
      }),
    );
  }
  return axes.map((axis) => (axis.reduce((a, b) => a + b, 0) < 0 ? axis.map((x) => -x) : axis));
}

function orthonormal(vectors: readonly Float64Array[]): Float64Array[] {
  const done: Float64Array[] = [];
  for (const vector of vectors) {
    const rest = vector.slice();
    for (const axis of done) {
      const along = dot(axis, rest);
      for (let i = 0; i < rest.length; i++) rest[i]! -= along * axis[i]!;
    }
    const length = Math.sqrt(dot(rest, rest));
    done.push(rest.map((x) => (length > 1e-12 ? x / length : 0)));
  }
  return done;
}

function dot(a: Float64Array, b: Float64Array): number {
  let sum = 0;
  for (let i = 0; i < a.length; i++) sum += a[i]! * b[i]!;
  return sum;
}
