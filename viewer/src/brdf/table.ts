// One material's table as the server sends it: RGBA half floats in the order of a MERL file, times a scale per channel.
// Alpha is 1 where the sample is measured and 0 elsewhere, where RGB is 0 too.

import { type DrawableGrid, type Neighbours, neighbours, toPosition } from "./grid";
import { HALF } from "./half";
import { type Direction, toHalfDiff } from "./halfdiff";

export type Rgb = readonly [number, number, number];

export interface Table {
  readonly name: string;
  readonly grid: DrawableGrid;
  readonly halfs: Uint16Array;
  readonly scale: Rgb;
}

/** f_r in 1/sr, 0 below the horizon: multilinear, renormalised over the measured corners (`TabularBrdf.eval`). */
export function evaluate(table: Table, wi: Direction, wo: Direction): Rgb {
  if (wi[2] <= 0 || wo[2] <= 0) return [0, 0, 0];
  const { thetaH, phiH, thetaD, phiD } = toHalfDiff(wi, wo);
  const [axisH, axisT, axisD, axisP] = table.grid;
  return interpolate(
    table,
    neighbours(axisH, toPosition(axisH, thetaH)),
    neighbours(axisT, toPosition(axisT, phiH)),
    neighbours(axisD, toPosition(axisD, thetaD)),
    neighbours(axisP, toPosition(axisP, phiD)),
  );
}

/** Between the neighbours on each axis. */
export function interpolate(table: Table, h: Neighbours, t: Neighbours, d: Neighbours, p: Neighbours): Rgb {
  const { halfs } = table;
  const [, { size: nT }, { size: nD }, { size: nP }] = table.grid;
  let red = 0;
  let green = 0;
  let blue = 0;
  let measured = 0;
  for (let corner = 0; corner < 8; corner++) {
    const i = corner >> 2;
    const j = (corner >> 1) & 1;
    const k = corner & 1;
    const ofRow = share(h, i) * share(t, j) * share(d, k);
    // Of one cell of phi_h both neighbours are the same.
    if (ofRow === 0) continue;
    const row = ((h[i]! * nT + t[j]!) * nD + d[k]!) * nP;
    for (let l = 0; l < 2; l++) {
      const weight = ofRow * share(p, l);
      const at = 4 * (row + p[l]!);
      red += weight * HALF[halfs[at]!]!;
      green += weight * HALF[halfs[at + 1]!]!;
      blue += weight * HALF[halfs[at + 2]!]!;
      measured += weight * HALF[halfs[at + 3]!]!;
    }
  }
  if (measured === 0) return [0, 0, 0];
  const [r, g, b] = table.scale;
  return [(r * red) / measured, (g * green) / measured, (b * blue) / measured];
}

function share([, , fraction]: Neighbours, side: number): number {
  return side === 0 ? 1 - fraction : fraction;
}

/** The sample of one cell, in 1/sr; null where it is unmeasured. */
export function sample(table: Table, h: number, t: number, d: number, p: number): Rgb | null {
  const [, { size: nT }, { size: nD }, { size: nP }] = table.grid;
  const at = 4 * (((h * nT + t) * nD + d) * nP + p);
  if (half(table, at + 3) === 0) return null;
  const [r, g, b] = table.scale;
  return [r * half(table, at), g * half(table, at + 1), b * half(table, at + 2)];
}

function half(table: Table, i: number): number {
  return HALF[table.halfs[i] as number] as number;
}
