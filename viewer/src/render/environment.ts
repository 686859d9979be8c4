// The environment on the card: its picture, and the table it is sampled by (environment.glsl).

import { DataTexture, HalfFloatType, LinearFilter, RepeatWrapping, RGBAFormat } from "three";

import type { Block } from "../api/client";
import { HALF } from "../brdf/half";
import { chances } from "./chances";

export interface Environment {
  readonly picture: DataTexture;
  /** Of the rows of a coarse table, and of the cells of each. */
  readonly rows: DataTexture;
  readonly chances: DataTexture;
}

/** Pixels of the picture along each side of a cell of the table. */
const COARSE = 4;
/** Share of the mean light that every cell counts at least. */
const FLOOR = 0.1;

export function toEnvironment({ halfs, shape }: Block): Environment {
  const [height = 0, width = 0] = shape;
  const picture = new DataTexture(halfs, width, height, RGBAFormat, HalfFloatType);
  picture.minFilter = picture.magFilter = LinearFilter;
  picture.wrapS = RepeatWrapping;
  picture.needsUpdate = true;
  const [columns, rows] = [width / COARSE, height / COARSE];
  const mass = light(halfs, width, height);
  // Per solid angle, times the sine of the polar angle: a cell spans 2 pi^2 / n in the two angles.
  const density = mass.map((m) => (m * rows * columns) / (2 * Math.PI ** 2));
  const whole = Float64Array.from({ length: rows }, (_, row) =>
    mass.subarray(row * columns, (row + 1) * columns).reduce((a, b) => a + b, 0),
  );
  return { picture, rows: chances(whole, whole, rows), chances: chances(mass, density, columns) };
}

/** The share of all light that comes from each cell. */
export function light(halfs: Uint16Array, width: number, height: number): Float64Array {
  const [columns, rows] = [width / COARSE, height / COARSE];
  const sums = new Float64Array(rows * columns);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const at = 4 * (y * width + x);
      const sum = HALF[halfs[at]!]! + HALF[halfs[at + 1]!]! + HALF[halfs[at + 2]!]!;
      sums[Math.floor(y / COARSE) * columns + Math.floor(x / COARSE)]! += sum;
    }
  }
  const floor = (FLOOR * sums.reduce((a, b) => a + b, 0)) / sums.length;
  const mass = sums.map(
    (sum, i) => (sum + floor) * Math.sin((Math.PI * (Math.floor(i / columns) + 0.5)) / rows),
  );
  const total = mass.reduce((a, b) => a + b, 0);
  return mass.map((m) => m / total);
}
