// Drawing from n unequal chances by inverting their running sum, with a table of where to begin to look.
//
// The order is kept: numbers that are spread evenly give cells that are, so low-discrepancy points stay so. (The alias method
// takes one look-up, and loses that.) H.-C. Chen, Y. Asau, "On Generating Random Variates from an Empirical Distribution",
// AIIE Transactions 6(2), 1974.

import { DataTexture, FloatType, RGBAFormat } from "three";

import { sum } from "../numbers";

/** On the card, a table a row (inversion.glsl): red `upTo`, green `first`, blue the density, alpha `chance`. */
export function chances(mass: Float64Array, density: ArrayLike<number>, width: number): DataTexture {
  const height = mass.length / width;
  const texels = new Float32Array(4 * mass.length);
  for (let row = 0; row < height; row++) {
    const { chance, upTo, first } = inversion(mass.subarray(row * width, (row + 1) * width));
    for (let i = 0; i < width; i++) {
      const at = row * width + i;
      texels.set([upTo[i]!, first[i]!, density[at]!, chance[i]!], 4 * at);
    }
  }
  const texture = new DataTexture(texels, width, height, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

export interface Inversion {
  /** The chance of each cell. */
  readonly chance: Float32Array;
  /** Of a cell and all before it; the last is 1. */
  readonly upTo: Float32Array;
  /** Of a number u in [i / n, (i + 1) / n): the cell of i / n, from which to go on while upTo <= u. */
  readonly first: Uint32Array;
}

/** The table for chances in proportion to `mass`, none negative, not all 0. */
export function inversion(mass: Float64Array): Inversion {
  const n = mass.length;
  const total = sum(mass);
  const chance = Float32Array.from(mass, (m) => m / total);
  const upTo = new Float32Array(n);
  let before = 0;
  for (let i = 0; i < n; i++) upTo[i] = before += mass[i]! / total;
  upTo[n - 1] = 1;
  const first = new Uint32Array(n);
  for (let i = 0, cell = 0; i < n; i++) {
    while (cell < n - 1 && upTo[cell]! <= i / n) cell++;
    first[i] = cell;
  }
  return { chance, upTo, first };
}
