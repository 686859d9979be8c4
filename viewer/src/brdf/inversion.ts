// Drawing from n unequal chances by inverting their running sum, with a table of where to begin to look.
//
// The order is kept: numbers that are spread evenly give cells that are, so low-discrepancy points stay so. (The alias method
// takes one look-up, and loses that.) H.-C. Chen, Y. Asau, "On Generating Random Variates from an Empirical Distribution",
// AIIE Transactions 6(2), 1974.

export interface Inversion {
  /** The chance of each cell. */
  readonly chance: Float32Array;
  /** Of a cell and all before it; the last is 1. */
  readonly upTo: Float32Array;
  /** Of a number u in [i / n, (i + 1) / n): the cell of i / n, from which to go on while upTo <= u. */
  readonly first: Uint32Array;
}

/** The table for chances in proportion to `mass`, none negative, not all 0. */
export function inversion(mass: ArrayLike<number>): Inversion {
  const n = mass.length;
  const total = Array.from(mass).reduce((a, b) => a + b, 0);
  const chance = Float32Array.from(mass, (m) => m / total);
  const upTo = new Float32Array(n);
  let sum = 0;
  for (let i = 0; i < n; i++) {
    sum += mass[i]! / total;
    upTo[i] = sum;
  }
  upTo[n - 1] = 1;
  const first = new Uint32Array(n);
  for (let i = 0, cell = 0; i < n; i++) {
    while (cell < n - 1 && upTo[cell]! <= i / n) cell++;
    first[i] = cell;
  }
  return { chance, upTo, first };
}
