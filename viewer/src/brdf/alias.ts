// Drawing from n unequal chances with one look-up: the alias method.
//
// Cell i is kept with probability `keep`, otherwise its alias is taken. M. D. Vose, "A Linear Algorithm for Generating
// Random Numbers with a Given Distribution", IEEE Transactions on Software Engineering 17(9), 1991.

export interface Alias {
  readonly keep: Float32Array;
  readonly other: Uint32Array;
}

/** The table for chances in proportion to `mass`, none negative. */
export function alias(mass: ArrayLike<number>): Alias {
  const n = mass.length;
  const total = Array.from(mass).reduce((a, b) => a + b, 0);
  const scaled = Float64Array.from(mass, (m) => (m * n) / total);
  const keep = new Float32Array(n).fill(1);
  const other = Uint32Array.from({ length: n }, (_, i) => i);
  const small: number[] = [];
  const large: number[] = [];
  scaled.forEach((s, i) => {
    (s < 1 ? small : large).push(i);
  });
  while (small.length && large.length) {
    const poor = small.pop()!;
    const rich = large.at(-1)!;
    keep[poor] = scaled[poor]!;
    other[poor] = rich;
    scaled[rich]! -= 1 - scaled[poor]!;
    if (scaled[rich]! < 1) {
      large.pop();
      small.push(rich);
    }
  }
  return { keep, other };
}
