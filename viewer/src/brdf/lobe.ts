// How often to try half vectors of each angle: the table's mean over small theta_d and all phi_d, without its matte floor.
//
//     D_i = max(0, mean_i - floor) cos(theta_h)        floor: the smallest mean between 40 and 70 degrees
//
// The floor would leak into the tails, where the cosine-weighted samples do better.

import { toAngle } from "./grid";
import { sample, type Table } from "./table";

export interface Lobe {
  /** P(theta_h in the first i cells), n + 1 numbers from 0 to 1. */
  readonly cdf: Float32Array;
  /** Per solid angle of the half vector, n numbers, 1/sr. */
  readonly pdf: Float32Array;
}

const STEPS_D = 6;
const STEPS_P = 12;

export function lobe(table: Table): Lobe {
  const axis = table.grid[0];
  const n = axis.size;
  const means = Array.from({ length: n }, (_, i) => mean(table, i));
  const angles = Array.from({ length: n + 1 }, (_, i) => toAngle(axis, i));
  const middle = means.filter((_, i) => (angles[i] as number) > 0.7 && (angles[i] as number) < 1.2);
  const floor = middle.length ? Math.min(...middle) : 0;
  const density = means.map((value, i) => {
    const centre = toAngle(axis, i + 0.5);
    return (Math.max(0, value - floor) + 1e-4 * (value + 1e-6)) * Math.cos(centre);
  });
  const mass = density.map((value, i) => value * solidAngle(angles[i] as number, angles[i + 1] as number));
  const total = mass.reduce((a, b) => a + b, 0);
  const cdf = new Float32Array(n + 1);
  const pdf = new Float32Array(n);
  let sum = 0;
  for (let i = 0; i < n; i++) {
    sum += (mass[i] as number) / total;
    cdf[i + 1] = i === n - 1 ? 1 : sum;
    pdf[i] = (density[i] as number) / total;
  }
  return { cdf, pdf };
}

function solidAngle(from: number, to: number): number {
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
