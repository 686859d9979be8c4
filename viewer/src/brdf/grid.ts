// Positions on a grid: the same as `halfway.halfdiff.Axis`. Cell i spans positions [i, i + 1], its sample stands at i + 1/2.
//
// Hardware filtering is centred at (i + 1/2) / n too, so position / n is the texture coordinate as it is.

import { Problem } from "../api/client";
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

const ALONE: Neighbours = [0, 0, 0];

/** The cells around a position; periodic axes wrap, on the others the outer half cells clamp. */
export function neighbours(axis: Axis, position: number): Neighbours {
  if (axis.size === 1) return ALONE;
  const lower = Math.floor(position - 0.5);
  const fraction = position - 0.5 - lower;
  const last = axis.size - 1;
  if (axis.periodic) return [(lower + axis.size) % axis.size, (lower + 1) % axis.size, fraction];
  return [Math.max(lower, 0), Math.min(lower + 1, last), fraction];
}

/** theta_h, phi_h, theta_d, phi_d, in the order of a table; phi_h has one cell where tables do not depend on it. */
export type DrawableGrid = readonly [Axis, Axis, Axis, Axis];

const ANGLES = ["theta_h", "phi_h", "theta_d", "phi_d"];
const WHOLE_TURN: Axis = { angle: "phi_h", size: 1, stop: 2 * Math.PI, power: 1, periodic: true };

/** The grid as the page draws it; a problem where it does not know how. */
export function toDrawable(axes: readonly Axis[]): DrawableGrid {
  const [first, ...rest] = axes;
  const all = first && axes.length === 3 ? [first, WHOLE_TURN, ...rest] : axes;
  if (all.length === 4 && ANGLES.every((angle, i) => all[i]?.angle === angle))
    return all as unknown as DrawableGrid;
  const angles = axes.map(({ angle }) => angle).join(", ");
  throw new Problem(
    `The library's grid is over ${angles}: the explorer draws ${ANGLES.join(", ")}, or those without phi_h. Use \`halfway render\`.`,
  );
}

export function isIsotropic([, phiH]: DrawableGrid): boolean {
  return phiH.size === 1;
}
