// How often to try half vectors of each angle: the table's mean over small theta_d and all phi_d, without its matte floor.
//
//     D_ij = max(0, mean_ij - floor) cos(theta_h)        floor: the smallest mean over phi_h between 40 and 70 degrees
//
// for cell i of theta_h and j of phi_h. The floor would leak into the tails, where the samples of the light do better.

import { type DrawableGrid, toAngle } from "./grid";
import { HALF } from "./half";
import type { Table } from "./table";

export interface Lobe {
  /** Chance of each cell of theta_h and phi_h, those of phi_h one after another; they sum to 1. */
  readonly mass: Float64Array;
  /** Chance of each cell of theta_h; and that per solid angle of the half vector, 1/sr. */
  readonly ofThetaH: Float64Array;
  readonly density: Float64Array;
}

const STEPS_D = 6;
const STEPS_P = 12;
/** What every cell counts at least, as a share of its own mean. */
const FLOOR = 1e-4;

export function lobe(table: Table): Lobe {
  const [axis, { size: n }] = table.grid;
  const means = cellMeans(table);
  const middle = rowMeans(means, n).filter((_, i) => {
    const angle = toAngle(axis, i + 0.5);
    return angle > 0.7 && angle < 1.2;
  });
  const floor = middle.length ? Math.min(...middle) : 0;
  const solid = Array.from({ length: axis.size }, (_, i) =>
    solidAngle(toAngle(axis, i), toAngle(axis, i + 1)),
  );
  const weights = means.map((value, cell) => {
    const i = Math.floor(cell / n);
    const shape = Math.max(0, value - floor) + FLOOR * (value + 1e-6);
    return (shape * Math.cos(toAngle(axis, i + 0.5)) * solid[i]!) / n;
  });
  const total = weights.reduce((a, b) => a + b, 0);
  const mass = weights.map((m) => m / total);
  const ofThetaH = rowMeans(mass, n).map((m) => m * n);
  return { mass, ofThetaH, density: ofThetaH.map((m, i) => m / solid[i]!) };
}

/** Of the directions whose polar angles are between `from` and `to`: exact near the pole, where a difference of cosines is not. */
export function solidAngle(from: number, to: number): number {
  return 4 * Math.PI * (Math.sin(to / 2) ** 2 - Math.sin(from / 2) ** 2);
}

/** Of rows of `n` values one after another. */
function rowMeans(values: Float64Array, n: number): Float64Array {
  const sums = new Float64Array(values.length / n);
  values.forEach((value, cell) => {
    sums[Math.floor(cell / n)]! += value / n;
  });
  return sums;
}

/** The mean of each cell of theta_h and phi_h over the measured ones of some of its samples, 1/sr. */
function cellMeans({ grid, halfs, scale }: Table): Float64Array {
  const samples = samplesOfCell(grid);
  const size = grid[2].size * grid[3].size;
  return Float64Array.from({ length: grid[0].size * grid[1].size }, (_, cell) => {
    let total = 0;
    let count = 0;
    for (const sample of samples) {
      const at = 4 * (cell * size + sample);
      if (HALF[halfs[at + 3]!]! === 0) continue;
      for (let c = 0; c < 3; c++) total += (scale[c]! * HALF[halfs[at + c]!]!) / 3;
      count++;
    }
    return count ? total / count : 0;
  });
}

/** Small theta_d and all phi_d, as indices into the samples of one cell. */
function samplesOfCell([, , { size: nD }, { size: nP }]: DrawableGrid): number[] {
  return Array.from({ length: STEPS_D * STEPS_P }, (_, i) => {
    const d = Math.floor((nD * Math.floor(i / STEPS_P)) / (2 * STEPS_D));
    return d * nP + Math.floor((nP * (i % STEPS_P)) / STEPS_P);
  });
}
