import { expect, test } from "vitest";

import { frameAt, frameCount } from "../src/film";
import { meanWeight } from "../src/recipe";
import { HOME } from "../src/scene";
import type { State } from "../src/state";

const STATE = {
  orbit: HOME,
  recipe: [{ name: "c", weight: [1, 1, 1] }],
  held: null,
  atPoint: null,
  route: {
    blend: "root",
    names: ["a", "b"],
    knots: [0, 1],
    weights: Object.fromEntries(
      ["r", "g", "b"].map((channel) => [
        channel,
        [
          [1, 0],
          [0, 1],
        ],
      ]),
    ),
    stops: [0, 1],
    crossings: [],
  },
} as unknown as State;

/** How much of b each frame has. */
function shares(motion: Parameters<typeof frameAt>[1], n: number): number[] {
  const frames = Array.from({ length: n }, (_, i) => frameAt(STATE, motion, i, n));
  return frames.map(({ recipe }) => recipe.filter(({ name }) => name === "b").map(meanWeight)[0] ?? 0);
}

test("a route is filmed from its first to its last stop, in its blend", () => {
  expect(shares("route", 5)).toEqual([0, 0.25, 0.5, 0.75, 1]);
  expect(frameAt(STATE, "route", 0, 5).mixing.blend).toBe("root");
});

test("there and back goes on with the first frame after the last", () => {
  expect(shares("there and back", 4)).toEqual([0, 0.5, 1, 0.5]);
});

test("an object turns by equal steps, and is as it is shown", () => {
  const angles = [0, 1, 2, 3].map((i) => frameAt(STATE, "turntable", i, 4).view.orbit.azimuth);
  angles.forEach((angle, i) => {
    expect(angle).toBeCloseTo((i * Math.PI) / 2);
  });
  expect(frameAt(STATE, "turntable", 1, 4).recipe).toBe(STATE.recipe);
});

test("a film has 25 frames a second, and two at least", () => {
  const film = { motion: "route", size: 16, enough: undefined } as const;
  expect(frameCount({ ...film, seconds: 4 })).toBe(100);
  expect(frameCount({ ...film, seconds: 0.01 })).toBe(2);
});
