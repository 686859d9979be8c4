import { expect, test, vi } from "vitest";
import { Actions } from "../src/actions";
import type { LegView, LibrarySummary } from "../src/api/schema";
import { toByte, toSrgb } from "../src/colour";
import { fromHash, toHash } from "../src/permalink";
import { only } from "../src/recipe";
import { join, recipeAt } from "../src/route";
import { keptOf } from "../src/shortlist";
import { drawnOf, shownDocument } from "../src/shown";
import { createState } from "../src/state";
import { createStore } from "../src/store";
import { golden } from "./golden";

const LIBRARY: LibrarySummary = {
  format: 1,
  version: "0",
  name: "small",
  address: "lib/small.brdflib",
  description: "",
  source: "",
  licence: "",
  checksum: "",
  grid: [],
  small_grid: [],
  materials: ["a", "b", "c", "d"].map((name) => ({ name })),
  spaces: [
    { name: "paper", text: "", usual_blend: "lobes" },
    { name: "linear", text: "", usual_blend: "linear" },
  ],
  blends: ["linear", "root", "log", "lobes"],
  paces: ["uniform"],
  lights: [],
  exports: ["merl"],
  recolours: true,
  notice: "",
};

const { names, legs } = golden<{ names: string[]; legs: Record<string, LegView> }>("route");
const route = join(Object.values(legs).slice(0, 1), "uniform", names);

function page(stops = ["a", "b"]) {
  const store = createState(LIBRARY, { stops }, "dark");
  return { store, actions: new Actions(store) };
}

test("the sRGB curve is Python's", () => {
  const { linear, bytes } = golden<{ linear: number[]; bytes: number[] }>("colour");
  expect(linear.map((x) => Math.round(255 * toSrgb(x)))).toEqual(bytes);
  // From its table of 4,096 steps the darkest tones may be one level off.
  linear.forEach((x, i) => {
    expect(Math.abs(toByte(x) - bytes[i]!)).toBeLessThanOrEqual(1);
  });
});

test("a link comes back to the same view", () => {
  const linked = {
    space: "linear",
    blend: "root",
    pace: "uniform",
    stops: ["a", "c", "b"],
    t: 0.25,
    point: [0.5, -1.25e-7, 300],
    compare: "paper",
    shape: "teapot",
    light: "points",
    turn: -30,
    grain: 37,
    exposure: -1.5,
    tone: "agx",
    orbit: { azimuth: 0.5, elevation: -0.25, zoom: 2 },
    split: 0.25,
    map: "Scores",
    axes: ["albedo", "L", "haze"],
    tint: "gloss60",
    plot: "albedo",
    aside: "numbers",
    asked: { like: null, set: { gloss60: 12.5, body: "#7a2a3a", b: -3 }, loose: true },
  } as const;
  expect(fromHash(toHash(linked), LIBRARY)).toEqual(linked);
});

test("a link is visited, and undo leads back", () => {
  const { store, actions } = page();
  actions.setRoute(route);
  actions.goTo([0.1]);
  actions.visit({ stops: ["c", "d", "a"], t: 0.25, light: "points" });
  expect(store.get()).toMatchObject({
    stops: ["c", "d", "a"],
    slot: 2,
    t: 0.25,
    point: null,
    light: "points",
  });
  actions.undo();
  expect(store.get()).toMatchObject({ stops: ["a", "b"], point: [0.1] });
  // On the same route no answer comes that would say the recipe.
  actions.undo();
  actions.visit({ t: 0.75 });
  expect(store.get().recipe).toEqual(recipeAt(route, 0.75));
});

test("what a link says that makes no sense is left out", () => {
  const hash = "#space=cubic&stops=a,zz&t=abc&shape=cube&exposure=99&orbit=1,2&light=points";
  expect(fromHash(hash, LIBRARY)).toEqual({ light: "points", exposure: 4 });
});

test("a chosen material takes the selected slot, and t goes where the route has it", () => {
  const { store, actions } = page(["a", "b", "d"]);
  actions.selectSlot(1);
  expect(store.get().t).toBe(0.5);
  actions.choose("c");
  expect(store.get().stops).toEqual(["a", "c", "d"]);
  actions.setRoute({ ...route, stops: [0, 0.3, 1] });
  expect(store.get().t).toBe(0.3);
  actions.setRoute(route);
  expect(store.get().t).toBe(0.3);
});

test("a stop never follows itself", () => {
  const { store, actions } = page(["a", "b", "a"]);
  actions.selectSlot(1);
  actions.choose("a");
  expect(store.get().stops).toEqual(["a", "b", "a"]);
  actions.removeStop(1);
  expect(store.get().stops).toEqual(["a", "b", "a"]);
});

test("a space has its usual blend until a person says otherwise, and undo brings back what it was", () => {
  const { store, actions } = page();
  expect(store.get().blend).toBe("lobes");
  actions.go({ blend: "root" });
  actions.go({ space: "linear" });
  expect(store.get().blend).toBe("linear");
  actions.undo();
  expect(store.get()).toMatchObject({ space: "paper", blend: "root" });
  actions.visit({ space: "paper", blend: "log" });
  expect(store.get().blend).toBe("log");
});

test("pictures are made of a recipe's materials where they mix, and else of its own table", () => {
  const { store, actions } = page();
  actions.setRoute(route);
  expect(drawnOf(store.get())).toBe(store.get().recipe);
  actions.setRoute({ ...route, blend: "lobes" });
  expect(drawnOf(store.get())).toEqual([]);
  store.set({ mixed: only("the mix") });
  expect(drawnOf(store.get())).toEqual(only("the mix"));
  // What is held instead of the route has a blend of its own.
  actions.hold(keptOf("kept", { library: "small", blend: "linear", weights: { a: 1 } }, ""));
  expect(drawnOf(store.get())).toEqual(only("a"));
});

test("undo and redo go back and forth", () => {
  const { store, actions } = page();
  actions.selectSlot(2);
  actions.choose("c");
  actions.go({ space: "linear" });
  actions.undo();
  expect(store.get().space).toBe("paper");
  actions.undo();
  expect(store.get().stops).toEqual(["a", "b"]);
  actions.redo();
  expect(store.get().stops).toEqual(["a", "b", "c"]);
  actions.choose("d");
  expect(store.get().future).toEqual([]);
});

test("stops change their order", () => {
  const { store, actions } = page(["a", "b", "c"]);
  actions.moveStop(2, 0);
  expect(store.get().stops).toEqual(["c", "a", "b"]);
  expect(store.get().slot).toBe(0);
  actions.moveStop(0, -1);
  expect(store.get().stops).toEqual(["c", "a", "b"]);
});

test("a free point is one act, which undo takes back and redo brings again", () => {
  const { store, actions } = page();
  actions.setRoute(route);
  const onRoute = store.get().recipe;
  for (const x of [0.1, 0.2, 0.3]) actions.goTo([x]);
  actions.setAtPoint({
    recipe: { library: "small", blend: "lobes", weights: { d: 1 } },
    point: [0.3],
    inside: true,
  });
  expect(store.get().recipe).toEqual([{ name: "d", weight: [1, 1, 1] }]);
  actions.undo();
  expect(store.get().point).toBeNull();
  expect(store.get().recipe).toEqual(onRoute);
  actions.redo();
  expect(store.get().point).toEqual([0.3]);
  actions.setT(0.5);
  actions.undo();
  expect(store.get().point).toEqual([0.3]);
});

test("what is asked for is one act, which undo takes back and redo brings again", () => {
  const { store, actions } = page();
  actions.setRoute(route);
  for (const body of ["#102030", "#203050"]) actions.ask("body", body);
  actions.loosen(true);
  const asked = { like: null, set: { body: "#203050" }, loose: true };
  expect(store.get().asked).toEqual(asked);
  actions.undo();
  expect(store.get().asked).toBeNull();
  actions.redo();
  expect(store.get().asked).toEqual(asked);
  actions.setT(0.5);
  actions.undo();
  expect(store.get().asked).toEqual(asked);
});

test("a material whose body is scaled is drawn from a table of its own", () => {
  const { store, actions } = page();
  const recipe = { library: "small", blend: "linear", weights: { a: 1 }, body_scale: [1, 0.5, 2] } as const;
  actions.hold(keptOf("kept", recipe, ""));
  expect(drawnOf(store.get())).toEqual([]);
  expect(shownDocument(store.get())).toEqual(recipe);
});

test("a stop is compared with as it is, whatever t", () => {
  const { store, actions } = page();
  actions.compareWith("stop:c");
  actions.setT(0.7);
  expect(store.get().otherRecipe).toEqual([{ name: "c", weight: [1, 1, 1] }]);
  actions.compareWith("");
  expect(store.get().otherRecipe).toEqual([]);
  expect(fromHash("#compare=stop:c", LIBRARY)).toEqual({ compare: "stop:c" });
  expect(fromHash("#compare=stop:zz", LIBRARY)).toEqual({});
});

test("a listener hears of the fields that it named, and of no others", () => {
  const store = createStore({ a: 1, b: 1, c: 1 });
  const heard = vi.fn();
  store.watch(["a", "b"], heard);
  store.set({ c: 0, b: 1 });
  expect(heard).toHaveBeenCalledTimes(1);
  store.set({ a: 2, b: 3 });
  expect(heard).toHaveBeenCalledTimes(2);
  expect(heard).toHaveBeenLastCalledWith({ a: 2, b: 3, c: 0 });
});

test("a listener that sets a field hears once of each change", () => {
  const store = createStore({ a: 1, b: 1 });
  const heard: unknown[] = [];
  store.watch(["a"], ({ a }) => store.set({ b: 10 * a }));
  store.watch(["a", "b"], (state) => heard.push(state));
  store.set({ a: 2 });
  expect(heard).toEqual([
    { a: 1, b: 10 },
    { a: 2, b: 20 },
  ]);
});
