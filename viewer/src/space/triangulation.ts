// Weights of a place: barycentric in a Delaunay triangulation, as halfway.space.Triangulation, and the nearest place of the
// hull, as halfway.space.hull.

import type { TriangulationView } from "../api/schema";

/** A weight above minus this is 0: rounding, not a place outside. */
const INSIDE = 1e-9;

type Vector = readonly number[];

/** Weights over all materials; null outside the hull. */
export function weightsAt(triangulation: TriangulationView, place: Vector): number[] | null {
  const x = [...flat(triangulation, place), 1];
  let best = -1;
  let weights: number[] = [];
  let simplex: Vector = [];
  for (const vertices of triangulation.simplices) {
    const corners = vertices.map((i) => [...triangulation.points[i]!, 1]);
    const found = solve(corners, x);
    const least = Math.min(...found);
    if (simplex.length === 0 || least > best) [best, weights, simplex] = [least, found, vertices];
  }
  if (best < -INSIDE) return null;
  return scatter(triangulation.points.length, simplex, weights);
}

/** Weights of the place of the hull that is nearest. */
export function nearest(triangulation: TriangulationView, place: Vector): number[] {
  const x = flat(triangulation, place);
  const towards = triangulation.points.map((point) =>
    point.map((y, k) => (y - x[k]!) / triangulation.spread[k]!),
  );
  const scale = Math.max(...towards.flat().map(Math.abs)) || 1;
  const columns = towards.map((column) => [...column.map((y) => y / scale), 1]);
  const weights = nonNegative(columns, [...x.map(() => 0), 1]);
  const sum = weights.reduce((a, b) => a + b, 0);
  return weights.map((w) => w / sum);
}

function flat({ origin, frame }: TriangulationView, place: Vector): number[] {
  return (frame[0] ?? []).map((_, d) =>
    frame.reduce((sum, row, k) => sum + (place[k]! - origin[k]!) * row[d]!, 0),
  );
}

function scatter(n: number, simplex: Vector, weights: Vector): number[] {
  const positive = weights.map((w) => (w > INSIDE ? w : 0));
  const sum = positive.reduce((a, b) => a + b, 0);
  const all = new Array<number>(n).fill(0);
  simplex.forEach((vertex, i) => {
    all[vertex] = positive[i]! / sum;
  });
  return all;
}

/** w with sum_j w_j columns_j = x: elimination with the largest pivot. */
function solve(columns: readonly Vector[], x: Vector): number[] {
  const n = x.length;
  const rows = x.map((value, i) => [...columns.map((column) => column[i]!), value]);
  for (let k = 0; k < n; k++) {
    let pivot = k;
    for (let i = k + 1; i < n; i++) if (Math.abs(rows[i]![k]!) > Math.abs(rows[pivot]![k]!)) pivot = i;
    [rows[k], rows[pivot]] = [rows[pivot]!, rows[k]!];
    const top = rows[k]!;
    for (let i = k + 1; i < n; i++) {
      const row = rows[i]!;
      const factor = row[k]! / top[k]!;
      for (let j = k; j <= n; j++) row[j]! -= factor * top[j]!;
    }
  }
  const w = new Array<number>(n).fill(0);
  for (let k = n - 1; k >= 0; k--) {
    const row = rows[k]!;
    let sum = row[n]!;
    for (let j = k + 1; j < n; j++) sum -= row[j]! * w[j]!;
    w[k] = sum / row[k]!;
  }
  return w;
}

const ROUNDS = 3;
const ZERO = 1e-12;

/**
 * w >= 0 for which sum_j w_j columns_j is nearest to b.
 *
 * Reference: C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", 1974, chapter 23.
 */
function nonNegative(columns: readonly Vector[], b: Vector): number[] {
  const w = columns.map(() => 0);
  let passive: number[] = [];
  for (let round = 0; round < ROUNDS * columns.length; round++) {
    const rest = b.map((value, i) => value - columns.reduce((sum, column, j) => sum + column[i]! * w[j]!, 0));
    const gain = columns.map((column, j) => (passive.includes(j) ? 0 : dot(column, rest)));
    const entering = gain.indexOf(Math.max(...gain));
    if (gain[entering]! <= ZERO) break;
    passive = [...passive, entering];
    for (;;) {
      const s = leastSquares(
        passive.map((j) => columns[j]!),
        b,
      );
      // As far towards the solution as no weight turns negative; what reaches 0 leaves.
      const steps = passive.map((j, i) => (s[i]! > 0 ? 1 : w[j]! / (w[j]! - s[i]!)));
      const step = Math.min(1, ...steps);
      passive.forEach((j, i) => {
        w[j] = w[j]! + step * (s[i]! - w[j]!);
      });
      if (step === 1) break;
      const leaving = passive.filter((_, i) => steps[i] === step);
      for (const j of leaving) w[j] = 0;
      passive = passive.filter((j) => !leaving.includes(j));
    }
  }
  return w;
}

/** By orthogonal columns, each made so twice: rounding of the first time is gone after the second. */
function leastSquares(columns: readonly Vector[], b: Vector): number[] {
  const frame: number[][] = [];
  const upper: number[][] = [];
  for (const column of columns) {
    let rest = [...column];
    const shares = frame.map(() => 0);
    for (let time = 0; time < 2; time++) {
      frame.forEach((q, i) => {
        const share = dot(q, rest);
        shares[i]! += share;
        rest = rest.map((value, k) => value - share * q[k]!);
      });
    }
    const length = Math.sqrt(dot(rest, rest));
    upper.push([...shares, length]);
    frame.push(rest.map((value) => value / length));
  }
  const w = frame.map((q) => dot(q, b));
  for (let k = w.length - 1; k >= 0; k--) {
    w[k]! /= upper[k]![k]!;
    for (let i = 0; i < k; i++) w[i]! -= upper[k]![i]! * w[k]!;
  }
  return w;
}

function dot(a: Vector, b: Vector): number {
  return a.reduce((sum, value, i) => sum + value * b[i]!, 0);
}
