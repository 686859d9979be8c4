// How often to try half vectors of each angle: the table's mean over small theta_d and all phi_d, without its matte floor.
//
//     D_i = max(0, mean_i - floor) cos(theta_h)        floor: the smallest mean between 40 and 70 degrees
//
// The floor would leak into the tails, where the samples of the light do better.

import { toAngle } from "./grid";
import { sample, type Table } from "./table";

export interface Lobe {
  /** Chance of each cell of theta_h; they sum to 1. */
  readonly mass: Float64Array;
  /** Per solid angle of the half vector, 1/sr. */
  readonly density: Float64Array;
}

const STEPS_D = 6;
const STEPS_P = 12;
/** What every cell counts at least, as a share of its own mean. */
const FLOOR = 1e-4;

export function lobe(table: Table): Lobe {
  const axis = table.grid[0];
  const means = Array.from({ length: axis.size }, (_, i) => mean(table, i));
  const middle = means.filter((_, i) => {
    const angle = toAngle(axis, i + 0.5);
    return angle > 0.7 && angle < 1.2;
  });
  const floor = middle.length ? Math.min(...middle) : 0;
  const shape = means.map(
    (value, i) => (Math.max(0, value - floor) + FLOOR * (value + 1e-6)) * Math.cos(toAngle(axis, i + 0.5)),
  );
  const mass = Float64Array.from(
    shape,
    (value, i) => value * solidAngle(toAngle(axis, i), toAngle(axis, i + 1)),
  );
  const total = mass.reduce((a, b) => a + b, 0);
  return { mass: mass.map((m) => m / total), density: Float64Array.from(shape, (value) => value / total) };
}

/** Of the directions whose polar angles are between `from` and `to`: exact near the pole, where a difference of cosines is not. */
export function solidAngle(from: number, to: number): number {
  return 4 * Math.PI * (Math.sin(to / 2) ** 2 - Math.sin(from / 2) ** 2);
}

function mean(table: Table, h: number): number {
  const [, axisD, axisP] = table.grid;
  let total = 0;
  let count = 0;
  for (let j = 0; j < STEPS_D; j++) {
    for (let k = 0; k < STEPS_P; k++) {
      const d = Math.floor((axisD.size * j) / (2 * STEPS_D));
      const value = sample(table, h, d, Math.floor((axisP.size * k) / STEPS_P));
      if (value === null) continue;
      total += (value[0] + value[1] + value[2]) / 3;
      count++;
    }
  }
  return count ? total / count : 0;
}
