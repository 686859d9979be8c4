import { expect, test } from "vitest";
import type { Client } from "../src/api/client";
import { toDrawable } from "../src/brdf/grid";
import { mixedName, Tables } from "../src/render/tables";

const axis = (angle: string, stop: number) => ({ angle, size: 2, stop, power: 1, periodic: false });
const GRID = toDrawable([axis("theta_h", Math.PI / 2), axis("theta_d", Math.PI / 2), axis("phi_d", Math.PI)]);

test("of mixes only those that are shown are kept, however many were", () => {
  const tables = new Tables({} as Client, GRID);
  const put = (name: string) =>
    tables.put({ name, grid: GRID, halfs: new Uint16Array(4 * 8).fill(0x3c00), scale: [1, 1, 1] });
  put("a");
  const names = Array.from({ length: 9 }, (_, i) => mixedName(`mixed ${i}`, false));
  for (const name of names) {
    put(name);
    tables.want([name]);
  }
  // The last, the one before it, which was shown when that came, and the material of the library.
  const there = names.filter((name) => tables.share([name]) === 1);
  expect(there).toEqual(names.slice(-2));
  expect(tables.share(["a"])).toBe(1);
});
