// The axes along which points in three dimensions extend, the longest first.

import { Vector3 } from "three";

const SWEEPS = 12;

/** Eigenvectors of the points' covariance, by Jacobi rotations; right-handed. */
export function principalAxes(points: readonly Vector3[]): [Vector3, Vector3, Vector3] {
  const a = [0, 1, 2].map((i) =>
    [0, 1, 2].map((j) => points.reduce((sum, p) => sum + p.getComponent(i) * p.getComponent(j), 0)),
  );
  const v = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  for (let sweep = 0; sweep < SWEEPS; sweep++) {
    for (const [p, q] of [
      [0, 1],
      [0, 2],
      [1, 2],
    ] as const) {
      const angle = 0.5 * Math.atan2(2 * a[p]![q]!, a[q]![q]! - a[p]![p]!);
      rotate(a, v, p, q, Math.cos(angle), Math.sin(angle));
    }
  }
  const order = [0, 1, 2].sort((i, j) => a[j]![j]! - a[i]![i]!);
  const [first, second] = order.map((i) => new Vector3(v[0]![i], v[1]![i], v[2]![i]));
  return [first!, second!, new Vector3().crossVectors(first!, second!)];
}

/** One rotation in the plane of p and q, of the matrix from both sides and of the vectors from the right. */
function rotate(a: number[][], v: number[][], p: number, q: number, c: number, s: number): void {
  for (let k = 0; k < 3; k++) {
    const [kp, kq] = [a[k]![p]!, a[k]![q]!];
    a[k]![p] = c * kp - s * kq;
    a[k]![q] = s * kp + c * kq;
  }
  for (let k = 0; k < 3; k++) {
    const [pk, qk] = [a[p]![k]!, a[q]![k]!];
    a[p]![k] = c * pk - s * qk;
    a[q]![k] = s * pk + c * qk;
  }
  for (let k = 0; k < 3; k++) {
    const [kp, kq] = [v[k]![p]!, v[k]![q]!];
    v[k]![p] = c * kp - s * kq;
    v[k]![q] = s * kp + c * kq;
  }
}
