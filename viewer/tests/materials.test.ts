import { expect, test } from "vitest";

import { toLab } from "../src/colour";
import { ANYTHING, described, fits, inOrder, likeness, matching } from "../src/materials";

const RED = [0.12, 0.03, 0.02];
const GREY = [0.08, 0.08, 0.08];
const BLUE = [0.01, 0.03, 0.08];
const ALL = [
  described("red-fabric2", RED, { gloss60: 0.3, width: 9 }),
  described("specular-maroon-phenolic", RED, { gloss60: 18.8, width: 0.6 }),
  described("red-phenolic", RED, { gloss60: 9, width: 2.2 }),
  described("blue-metallic-paint", BLUE, { gloss60: 2.7, width: 10 }),
  described("chrome", GREY, { gloss60: 102, width: 0.4 }),
  described("special-walnut-224", [0.012, 0.008, 0.005], { gloss60: 1, width: 11 }),
  described("ss440", GREY, null),
];

test("white has the lightness 100 and no hue, the sRGB primaries have the published CIELAB", () => {
  expect(toLab([1, 1, 1]).map((x) => Math.round(10 * x) / 10 + 0)).toEqual([100, 0, 0]);
  // Red: 53.2, 80.1, 67.2.
  const red = toLab([1, 0, 0]);
  [53.2, 80.1, 67.2].forEach((x, i) => {
    expect(red[i]).toBeCloseTo(x, 0);
  });
});

test("a material is described by its name, its picture and what was read off it", () => {
  expect(ALL.map(({ kind }) => kind)).toEqual([
    "fabric",
    "plastic",
    "plastic",
    "paint",
    "metal",
    "wood",
    "metal",
  ]);
  expect(ALL.map(({ colour }) => colour)).toEqual(["red", "red", "red", "blue", "grey", "black", "grey"]);
  expect(ALL.map(({ gloss }) => gloss)).toEqual([
    "matte",
    "glossy",
    "glossy",
    "matte",
    "mirror",
    "matte",
    null,
  ]);
});

test.each([
  ["red", ["red-fabric2", "red-phenolic", "specular-maroon-phenolic"]],
  ["red glossy", ["red-phenolic", "specular-maroon-phenolic"]],
  ["glossy red plastic", ["red-phenolic", "specular-maroon-phenolic"]],
  ["pheno", ["specular-maroon-phenolic", "red-phenolic"]],
  ["car paint", ["blue-metallic-paint"]],
  ["metallic", ["blue-metallic-paint", "chrome", "ss440"]],
  ["shiny", ["specular-maroon-phenolic", "red-phenolic", "chrome"]],
  ["wood", ["special-walnut-224"]],
  ["red-fab", ["red-fabric2"]],
  ["fabric", ["red-fabric2"]],
  // Within a word only where nothing begins so.
  ["rome", ["chrome"]],
  ["ed", ["red-fabric2", "red-phenolic"]],
  ["purple", []],
])("%s", (query, names) => {
  expect(matching(ALL, query)).toEqual(names);
});

test("what is chosen has to hold together", () => {
  const names = (facets: Partial<typeof ANYTHING>) =>
    ALL.filter((each) => fits(each, { ...ANYTHING, ...facets })).map(({ name }) => name);
  expect(names({})).toHaveLength(7);
  expect(names({ colour: "red", gloss: "glossy" })).toEqual(["specular-maroon-phenolic", "red-phenolic"]);
  expect(names({ kind: "metal", gloss: "mirror" })).toEqual(["chrome"]);
});

test("an order is by what it says, and keeps the library's where nothing tells two apart", () => {
  const order = (by: Parameters<typeof inOrder>[1]) =>
    inOrder(ALL, by, (name) => name.length).map(({ name }) => name);
  expect(order("library")).toEqual(ALL.map(({ name }) => name));
  expect(order("gloss").slice(-3)).toEqual(["red-phenolic", "specular-maroon-phenolic", "chrome"]);
  expect(order("likeness").slice(0, 3)).toEqual(["ss440", "chrome", "red-fabric2"]);
  // Greys have no hue: they come after all that do, the dark ones first.
  expect(order("hue").at(-1)).toBe("ss440");
});

test.each([
  ["like chrome", { words: "", like: "chrome" }],
  ["red paint Like  gold", { words: "red paint", like: "gold" }],
  ["like", null],
  ["alike", null],
  ["glossy", null],
])("a search by likeness says what materials are like, and what they have to be: %s", (query, expected) => {
  expect(likeness(query)).toEqual(expected);
});
