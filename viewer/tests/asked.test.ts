import { expect, test } from "vitest";

import type { AttributeView } from "../src/api/schema";
import { asking, foundAs, sliderOf } from "../src/asked";

function attribute(name: string, needs = ""): AttributeView {
  return { name, label: name, unit: "", needs, values: [] };
}

const ATTRIBUTES = [attribute("gloss60"), attribute("L"), attribute("b", "L")];
const HAS = { gloss60: 5, L: 40, b: 10 };

test("a number is asked for beside others, until it is let go", () => {
  const both = asking({ L: 50 }, "gloss60", 12, ATTRIBUTES, HAS);
  expect(both).toEqual({ L: 50, gloss60: 12 });
  expect(asking(both, "gloss60", 20, ATTRIBUTES, HAS)).toEqual({ L: 50, gloss60: 20 });
  expect(asking(both, "L", null, ATTRIBUTES, HAS)).toEqual({ gloss60: 12 });
});

test("a number that says nothing alone brings the other one along as it is, and goes with it", () => {
  const warmer = asking({}, "b", 20, ATTRIBUTES, HAS);
  expect(warmer).toEqual({ L: 40, b: 20 });
  // One that is asked for already stays as it was asked for.
  expect(asking({ L: 50 }, "b", 20, ATTRIBUTES, HAS)).toEqual({ L: 50, b: 20 });
  expect(asking(warmer, "L", null, ATTRIBUTES, HAS)).toEqual({});
  expect(asking(warmer, "b", null, ATTRIBUTES, HAS)).toEqual({ L: 40 });
});

test("what comes of it says what was asked for", () => {
  const recipe = { library: "small", blend: "linear", weights: { a: 1 } };
  expect(foundAs("a", { gloss60: 12.345, L: 40 }, recipe).name).toBe("a, gloss60 12.3, L 40");
});

test("a slider covers what the materials have, and spreads what crowds near 0", () => {
  const even = sliderOf([null, -20, 0, 40]);
  expect(even.toShare(10)).toBeCloseTo(0.5);
  expect(even.toValue(0.25)).toBeCloseTo(-5);
  expect(even.toShare(99)).toBe(1);
  // Cube roots 0, 1, 4: the middle of the slider is at 2.
  const crowded = sliderOf([0, 1, 64]);
  expect(crowded.toValue(0.5)).toBeCloseTo(8);
  for (const value of [0, 0.5, 30, 64]) expect(crowded.toValue(crowded.toShare(value))).toBeCloseTo(value);
  // Of one value alone nothing is divided by 0.
  expect(sliderOf([3]).toShare(3)).toBe(0);
});
