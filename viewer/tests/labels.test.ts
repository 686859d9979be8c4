import { expect, test } from "vitest";
import { apart, labelPositions } from "../src/panels/space/labels";

const at = (x: number, y: number) => ({ x, y, gap: 10 });

test("a name stands beside its point, towards the middle", () => {
  expect(labelPositions([at(100, 50), at(900, 50)], 1000)).toEqual([
    { x: 110, y: 50, side: "right" },
    { x: 890, y: 50, side: "left" },
  ]);
});

test("a name that is in the way is gone below", () => {
  const [first, second] = labelPositions([at(100, 50), at(120, 55)], 1000);
  expect(first!.y).toBe(50);
  expect(second!.y).toBeGreaterThanOrEqual(73);
});

test("names on two sides of the turn meet in the middle", () => {
  // From 520 to 670, and from 520 to 670 again.
  const [, second] = labelPositions([at(510, 50), at(680, 50)], 1000);
  expect(second!.y).toBeGreaterThanOrEqual(73);
  // The points are near, their names are not.
  const [, apart] = labelPositions([at(615, 50), at(625, 50)], 1000);
  expect(apart!.y).toBe(50);
});

test("texts of axes stand beside each other and beside names, inside the panel", () => {
  const box = { x: 50, y: 50, width: 80, height: 14 };
  const name = { ...box, y: 64, height: 23 };
  const [first, second] = apart([{ ...box, x: 20 }, box], [name], 400, 300);
  expect(first).toMatchObject({ x: 40, y: 43 });
  expect(second!.y).toBeLessThanOrEqual(29);
  // What is in nobody's way stays.
  expect(apart([{ ...box, y: 200 }], [name], 400, 300)).toEqual([{ ...box, y: 200 }]);
});
