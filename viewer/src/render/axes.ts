// The directions in which vectors extend, the longest first.

import { Vector3 } from "three";

import { dot, sum } from "../numbers";

const ITERATIONS = 40;

/** The first principal components of centred vectors, by orthogonal iteration; each of unit length, more is positive. */
export function components(vectors: readonly Float64Array[], count: number): Float64Array[] {
  const size = vectors[0]?.length ?? 0;
  // Any start will do that is not orthogonal to the answer; the same each time.
  let axes: Float64Array[] = Array.from({ length: count }, (_, k) =>
    Float64Array.from({ length: size }, (_, i) => Math.sin((k + 1) * (i + 1))),
  );
  for (let iteration = 0; iteration < ITERATIONS; iteration++) {
    axes = orthonormal(axes.map((axis) => timesCovariance(vectors, axis)));
  }
  return axes.map((axis) => (sum(axis) < 0 ? axis.map((x) => -x) : axis));
}

/** How far points are taken to extend in any case: those on a line have three axes too. */
const LEAST = 1e-4;

/** Of centred points; right-handed. */
export function principalAxes(points: readonly Vector3[]): [Vector3, Vector3, Vector3] {
  const least = [new Vector3(LEAST, 0, 0), new Vector3(0, LEAST, 0), new Vector3(0, 0, LEAST)];
  const vectors = [...points, ...least].map((point) => Float64Array.from(point.toArray()));
  const [first, second] = components(vectors, 2).map((axis) => new Vector3(...axis));
  return [first!, second!, new Vector3().crossVectors(first!, second!)];
}

function timesCovariance(vectors: readonly Float64Array[], axis: Float64Array): Float64Array {
  const product = new Float64Array(axis.length);
  for (const vector of vectors) addScaled(product, vector, dot(axis, vector));
  return product;
}

function orthonormal(vectors: readonly Float64Array[]): Float64Array[] {
  const done: Float64Array[] = [];
  for (const vector of vectors) {
    const rest = vector.slice();
    for (const axis of done) addScaled(rest, axis, -dot(axis, rest));
    const length = Math.sqrt(dot(rest, rest));
    done.push(rest.map((x) => (length > 1e-12 ? x / length : 0)));
  }
  return done;
}

/** To `to`, in place. */
function addScaled(to: Float64Array, vector: Float64Array, factor: number): void {
  for (let i = 0; i < to.length; i++) to[i]! += factor * vector[i]!;
}
