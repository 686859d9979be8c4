import { expect, test } from "vitest";

import { placed } from "../src/api/files";
import type { LegFile, PlaceView, RouteView, SpaceFile } from "../src/api/schema";
import { join, reversed } from "../src/space/legs";
import { golden } from "./golden";

interface Static {
  readonly names: readonly string[];
  readonly spaces: Readonly<Record<string, SpaceFile>>;
  readonly places: readonly { space: string; point: number[]; answer: PlaceView }[];
  readonly routes: readonly { legs: LegFile[]; route: RouteView }[];
}

const { names, spaces, places, routes } = golden<Static>("static");

/** Equal, numbers to rounding. */
function expectSame(found: unknown, expected: unknown, where = ""): void {
  if (typeof expected === "number") {
    expect(found as number, where).toBeCloseTo(expected, 8);
  } else if (typeof expected === "object" && expected !== null) {
    expect(Object.keys(found as object).sort(), where).toEqual(Object.keys(expected).sort());
    for (const [key, value] of Object.entries(expected)) {
      expectSame((found as Record<string, unknown>)[key], value, `${where}.${key}`);
    }
  } else expect(found, where).toEqual(expected);
}

test.each(routes)("a route of legs is the server's: $route.pace", ({ legs, route }) => {
  const { library, space, pace, stops } = route;
  expectSame(join({ library, space, pace, stops, names }, legs), route);
});

test("a leg reversed goes back the same way", () => {
  const [leg] = routes[0]!.legs as [LegFile];
  const back = reversed(leg);
  expect(back.weights.r[0]).toEqual(leg.weights.r.at(-1));
  expectSame(reversed(back), leg);
});

test.each(places)("a place of the $space space is the server's", ({ space, point, answer }) => {
  expectSame(placed(spaces[space]!, "golden", names, point), answer);
});

test("a space without places says so", () => {
  const view = { name: "linear", embeddings: [] };
  expect(() => placed({ view, triangulations: [] }, "golden", names, [0])).toThrow(
    "the space 'linear' has no places between its routes: choose another space.",
  );
});
