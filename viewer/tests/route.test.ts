import { expect, test } from "vitest";

import { position } from "../src/api/files";
import type { ChartView, LegView, PositionView, RecipeDocument, SpaceView } from "../src/api/schema";
import { locate } from "../src/charts";
import { fromDocument, type Ingredient, only } from "../src/recipe";
import { join, recipeAt, reversed } from "../src/route";
import { nearestFirst } from "../src/wanted";
import { golden } from "./golden";

interface Routes {
  readonly names: readonly string[];
  readonly stops: readonly string[];
  readonly legs: Readonly<Record<string, LegView>>;
  readonly routes: readonly {
    readonly pace: string;
    readonly stop_t: readonly number[];
    readonly recipes: readonly (RecipeDocument & { readonly t: number })[];
  }[];
}

interface Points {
  readonly names: readonly string[];
  readonly spaces: Readonly<Record<string, { view: SpaceView; charts: ChartView[] }>>;
  readonly points: readonly { space: string; point: number[]; answer: PositionView }[];
}

const { names, stops, legs, routes } = golden<Routes>("route");
const { names: few, spaces, points } = golden<Points>("points");
const [inside, outside] = [true, false].map((is) => points.filter(({ answer }) => answer.inside === is));

function routeAt(pace: string) {
  const inTurn = stops.slice(1).map((stop, i) => {
    const leg = legs[`${stops[i]} ${stop}`];
    return leg ?? reversed(legs[`${stop} ${stops[i]}`]!);
  });
  return join(inTurn, pace, names);
}

/** Weights of all materials. */
function dense(recipe: readonly Ingredient[]): readonly (readonly number[])[] {
  return names.map((name) => recipe.find((each) => each.name === name)?.weight ?? [0, 0, 0]);
}

/** Equal, numbers to so much. */
function expectClose(a: unknown, b: unknown, within: number): void {
  if (typeof b === "number") expect(Math.abs((a as number) - b)).toBeLessThan(within);
  else if (typeof b === "object" && b !== null) {
    expect(Object.keys(a as object).sort()).toEqual(Object.keys(b).sort());
    for (const [key, value] of Object.entries(b))
      expectClose((a as Record<string, unknown>)[key], value, within);
  } else expect(a).toEqual(b);
}

test.each(routes)("a route of legs is Python's at $pace pace", ({ pace, stop_t, recipes }) => {
  const route = routeAt(pace);
  expectClose(route.stops, stop_t, 1e-12);
  for (const { t, ...recipe } of recipes)
    expectClose(dense(recipeAt(route, t)), dense(fromDocument(recipe)), 1e-9);
  // At a stop of its own the recipe is that material, to the last digit.
  route.stops.forEach((t, i) => {
    expect(recipeAt(route, t)).toEqual(only(stops[i]!));
  });
});

test.each(routes)("knots ascend from 0 to 1 at $pace pace, crossings and stops among them", ({ pace }) => {
  const { knots, crossings, stops: at, weights } = routeAt(pace);
  expect([knots[0], knots.at(-1)]).toEqual([0, 1]);
  knots.slice(1).forEach((knot, k) => {
    expect(knot).toBeGreaterThan(knots[k]!);
  });
  for (const t of crossings) expect(knots).toContain(t);
  for (const t of at) expect(Math.min(...knots.map((knot) => Math.abs(knot - t)))).toBeLessThan(1e-12);
  expect(crossings.length).toBeGreaterThan(0);
  for (const rows of Object.values(weights)) expect(rows.length).toBe(knots.length);
});

test("a leg reversed goes back the same way", () => {
  const [leg] = Object.values(legs) as [LegView];
  const back = reversed(leg);
  expect(back.weights.r[0]).toEqual(leg.weights.r.at(-1));
  expectClose(reversed(back), leg, 1e-12);
});

test("a leg on which nothing changes takes no time beside one on which much does", () => {
  const still: LegView = {
    names: ["a", "b"],
    knots: [0, 1],
    weights: { r: [[1, 0], [0, 1]], g: [[1, 0], [0, 1]], b: [[1, 0], [0, 1]] },
    paces: { perceptual: { t: [0, 1], length: [0, 1e-9] } },
  }; // biome-ignore format: rows.
  const moving: LegView = { ...still, paces: { perceptual: { t: [0, 0.5, 1], length: [0, 3, 4] } } };
  const { stops: at, knots } = join([still, reversed(moving)], "perceptual", ["a", "b"]);
  expect(at[1]).toBeCloseTo(0, 8);
  // The second half of the way back is the longer one.
  expect(knots).toHaveLength(4);
  expect(knots[2]).toBeCloseTo(0.25, 8);
});

test("tables are wanted in the order in which t meets them", () => {
  const route = routeAt("uniform");
  const wanted = nearestFirst(route, 0);
  expect(new Set(wanted)).toEqual(new Set(route.names));
  expect(recipeAt(route, 0).map(({ name }) => name)).toEqual(["material-0"]);
  expect(wanted.slice(0, 4)).toContain("material-0");
});

test.each(inside!)("a point inside the $space space is the server's", ({ space, point, answer }) => {
  const { view, charts } = spaces[space]!;
  expectClose(position(view, charts, "golden", few, point), answer, 1e-8);
});

test.each(outside!)("outside the $space space there is a mix nearby", ({ space, point, answer }) => {
  const { view, charts } = spaces[space]!;
  const nearby = position(view, charts, "golden", few, point);
  expect(nearby.inside).toBe(false);
  const off = (x: readonly number[]) => Math.hypot(...x.map((value, k) => value - point[k]!));
  // No mix is nearer than the server's, in the coordinates in which it seeks; here it is not ten times as far.
  expect(off(nearby.point)).toBeLessThan(10 * off(answer.point));
});

test("weights at a point are a matrix times it, and those beyond a side are none", () => {
  // A triangle at the origin and along the axes.
  const chart: ChartView = { simplices: [[4, 7, 2]], barycentric: [[[-1, -1, 1], [1, 0, 0], [0, 1, 0]]] }; // biome-ignore format: a matrix.
  expect(locate(chart, [0.25, 0.5])).toEqual({
    vertices: [4, 7, 2],
    weights: [0.25, 0.25, 0.5],
    inside: true,
  });
  expect(locate(chart, [-0.5, 0.5])).toEqual({
    vertices: [4, 7, 2],
    weights: [2 / 3, 0, 1 / 3],
    inside: false,
  });
  expect(locate(chart, [0, 1 + 1e-12]).inside).toBe(true);
});
