// The environment on the card: its picture, and the table it is sampled by (environment.glsl).

import {
  DataTexture,
  FloatType,
  HalfFloatType,
  LinearFilter,
  NearestFilter,
  RedFormat,
  RepeatWrapping,
  RGBAFormat,
} from "three";

import type { Block } from "../api/client";
import { HALF } from "../brdf/half";

export interface Environment {
  readonly picture: DataTexture;
  readonly cdf: DataTexture;
}

/** Pixels of the picture along each side of a cell of the table. */
const COARSE = 4;
/** Share of the mean radiance that every cell counts at least. */
const FLOOR = 0.02;

export function toEnvironment(block: Block): Environment {
  const [height = 0, width = 0] = block.shape;
  const picture = new DataTexture(block.halfs, width, height, RGBAFormat, HalfFloatType);
  picture.minFilter = picture.magFilter = LinearFilter;
  picture.wrapS = RepeatWrapping;
  picture.needsUpdate = true;
  const cells = coarse(block.halfs, width, height);
  const columns = width / COARSE;
  const cdf = new DataTexture(cumulative(cells, columns), columns + 1, height / COARSE, RedFormat, FloatType);
  cdf.minFilter = cdf.magFilter = NearestFilter;
  cdf.needsUpdate = true;
  return { picture, cdf };
}

/** Mean radiance of each cell, times the sine of its polar angle: proportional to its light. */
export function coarse(halfs: Uint16Array, width: number, height: number): Float32Array {
  const columns = width / COARSE;
  const cells = new Float32Array((height / COARSE) * columns);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const at = 4 * (y * width + x);
      const sum = HALF[halfs[at]!]! + HALF[halfs[at + 1]!]! + HALF[halfs[at + 2]!]!;
      cells[Math.floor(y / COARSE) * columns + Math.floor(x / COARSE)]! += sum;
    }
  }
  const floor = (FLOOR * cells.reduce((a, b) => a + b, 0)) / cells.length;
  const rows = height / COARSE;
  return cells.map((value, i) => (value + floor) * Math.sin((Math.PI * (Math.floor(i / columns) + 0.5)) / rows));
}

/** Each row's cumulative distribution, and in one more column that over the rows. */
export function cumulative(cells: Float32Array, columns: number): Float32Array {
  const rows = cells.length / columns;
  const table = new Float32Array(rows * (columns + 1));
  const total = cells.reduce((a, b) => a + b, 0);
  let over = 0;
  for (let row = 0; row < rows; row++) {
    const line = cells.subarray(row * columns, (row + 1) * columns);
    const sum = line.reduce((a, b) => a + b, 0);
    let along = 0;
    line.forEach((value, i) => {
      along += value;
      table[row * (columns + 1) + i] = i === columns - 1 ? 1 : along / sum;
    });
    over += sum;
    table[row * (columns + 1) + columns] = row === rows - 1 ? 1 : over / total;
  }
  return table;
}
