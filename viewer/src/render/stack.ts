// A table as the card takes it: a 3-D texture of blocks, one for each cell of phi_h.
//
//     width    phi_d, which repeats
//     height   theta_d, one block above another
//     depth    theta_h, one block behind another where they would be too high
//
//            +---------+---------+
//            | phi_h 2 | phi_h 5 |        The card interpolates within a block; between two of them the shader does
//            | phi_h 1 | phi_h 4 |        (brdf.glsl). A table that does not depend on phi_h is one block.
//            | phi_h 0 | phi_h 3 |
//            +---------+---------+

import type { Table } from "../brdf/table";

/** Texels along a side: as many as cards have that take more than the 256 of the standard. */
const MOST = 1024;

export interface Stack {
  readonly texels: Uint16Array;
  /** Width, height, depth. */
  readonly size: readonly [number, number, number];
  /** Blocks, and how many of them are above each other. */
  readonly turns: readonly [number, number];
}

export function stack({ grid, halfs }: Pick<Table, "grid" | "halfs">): Stack {
  const [nH, nT, nD, nP] = grid.map(({ size }) => size) as [number, number, number, number];
  const columns = Math.ceil((nT * nD) / MOST);
  const high = Math.ceil(nT / columns);
  const size = [nP, high * nD, columns * nH] as const;
  const turns = [nT, high] as const;
  // The order of the table is that of one column.
  if (columns === 1) return { texels: halfs, size, turns };
  const block = 4 * nD * nP;
  const texels = new Uint16Array(columns * nH * high * block);
  for (let column = 0; column < columns; column++) {
    for (let h = 0; h < nH; h++) {
      const first = h * nT + column * high;
      const count = Math.min(high, nT - column * high);
      texels.set(halfs.subarray(first * block, (first + count) * block), (column * nH + h) * high * block);
    }
  }
  return { texels, size, turns };
}
