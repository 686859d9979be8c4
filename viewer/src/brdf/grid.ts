// Positions on a grid: the same as `halfway.halfdiff.Axis`. Cell i spans positions [i, i + 1], its sample stands at i + 1/2.
//
// Hardware filtering is centred at (i + 1/2) / n too, so position / n is the texture coordinate as it is.

import type { Axis } from "../api/schema";
import { clamp } from "../numbers";

export function toPosition(axis: Axis, angle: number): number {
  const share = angle / axis.stop;
  if (axis.periodic) return ((axis.size * (share - Math.floor(share))) % axis.size) + 0;
  const inside = clamp(share, 0, 1);
  return axis.size * (axis.power === 1 ? inside : inside ** (1 / axis.power));
}

export function toAngle(axis: Axis, position: number): number {
  return axis.stop * (position / axis.size) ** axis.power;
}

/** Two cells, and how far a position is from the first sample to the second. */
export type Neighbours = readonly [number, number, number];

/** The cells around a position; periodic axes wrap, on the others the outer half cells clamp. */
export function neighbours(axis: Axis, position: number): Neighbours {
  const lower = Math.floor(position - 0.5);
  const fraction = position - 0.5 - lower;
  const last = axis.size - 1;
  if (axis.periodic) return [(lower + axis.size) % axis.size, (lower + 1) % axis.size, fraction];
  return [Math.max(lower, 0), Math.min(lower + 1, last), fraction];
}

/** theta_h, theta_d, phi_d as in a MERL file. */
export type DrawableGrid = readonly [Axis, Axis, Axis];

/** Does the page know how to draw this grid? */
export function isDrawable(grid: readonly Axis[]): grid is DrawableGrid {
  return grid.length === 3 && ["theta_h", "theta_d", "phi_d"].every((angle, i) => grid[i]?.angle === angle);
}
