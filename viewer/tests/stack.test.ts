import { expect, test } from "vitest";

import { toDrawable } from "../src/brdf/grid";
import { stack } from "../src/render/stack";

const axis = (angle: string, size: number) => ({ angle, size, stop: Math.PI, power: 1, periodic: true });

/** A table whose alpha is the index of its cell. */
function table(nThetaH: number, nPhiH: number, nThetaD: number, nPhiD: number) {
  const axes = [
    axis("theta_h", nThetaH),
    axis("phi_h", nPhiH),
    axis("theta_d", nThetaD),
    axis("phi_d", nPhiD),
  ];
  const halfs = new Uint16Array(4 * nThetaH * nPhiH * nThetaD * nPhiD);
  for (let cell = 0; cell < halfs.length / 4; cell++) halfs[4 * cell + 3] = cell;
  return { grid: toDrawable(axes), halfs };
}

test.each([
  [2, 5, 300, 2],
  [3, 4, 512, 1],
  [2, 3, 7, 4],
])(
  "a table of %i x %i x %i x %i cells is stacked so that each cell is found in its block",
  (nH, nT, nD, nP) => {
    const { texels, size, turns } = stack(table(nH, nT, nD, nP));
    const [n, high] = turns;
    const [width, height] = size;
    expect(n).toBe(nT);
    expect(size.every((side) => side <= 1024)).toBe(true);
    // As brdf.glsl finds them.
    for (const [h, t, d, p] of [
      [0, 0, 0, 0],
      [nH - 1, nT - 1, nD - 1, nP - 1],
      [1, 1, 2, 0],
      [1, nT - 1, 0, nP - 1],
    ] as const) {
      const x = p;
      const y = (t % high) * nD + d;
      const z = Math.floor(t / high) * nH + h;
      expect(texels[4 * ((z * height + y) * width + x) + 3]).toBe(((h * nT + t) * nD + d) * nP + p);
    }
  },
);

test("one column is the table as it is", () => {
  const { grid, halfs } = table(3, 1, 4, 2);
  expect(stack({ grid, halfs })).toEqual({ texels: halfs, size: [2, 4, 3], turns: [1, 1] });
  expect(stack({ grid, halfs }).texels).toBe(halfs);
});
