import { expect, test } from "vitest";

import type { LibrarySummary } from "../src/api/schema";
import { toCommand } from "../src/command";
import { join } from "../src/route";
import { fromText, keptOf, missingIn, toText } from "../src/shortlist";
import { fileName, materialName } from "../src/title";

const LIBRARY = {
  name: "lab",
  address: "my files/lab.brdflib",
  blends: ["linear", "root"],
  grid: [{ angle: "theta_h" }],
  materials: ["a", "b", "c"].map((name) => ({ name })),
} as unknown as LibrarySummary;
const WEIGHTS = [
  [1, 0],
  [0, 1],
];
const LEG = {
  names: ["a", "b"],
  knots: [0, 1],
  weights: { r: WEIGHTS, g: WEIGHTS, b: WEIGHTS },
  paces: { uniform: { t: [0, 1], length: [0, 1] } },
};
const ON_ROUTE = {
  library: LIBRARY,
  space: "paper",
  blend: "root",
  pace: "uniform",
  stops: ["a", "b"],
  t: 0.25,
  point: null,
  atPoint: null,
  held: null,
  asked: null,
  kept: [],
  route: null,
  recipe: [
    { name: "a", weight: [0.75, 0.75, 0.75] },
    { name: "b", weight: [0.25, 0.25, 0.25] },
  ],
  shape: "sphere",
  mesh: null,
  light: "studio",
  exposure: 0,
  grain: 0,
} as const;

test("a place on a route is made by route and render", () => {
  expect(toCommand(ON_ROUTE)).toBe(
    "halfway route 'my files/lab.brdflib' a b --space paper --blend root --pace uniform --t 0.25 -o a-to-b-0.250" +
      " && halfway render a-to-b-0.250 --scene spheres --env studio -o a-to-b-0.250.png",
  );
});

test("a free point is made by mix, under the name of what it is mostly made of", () => {
  const atPoint = { recipe: { library: "lab", blend: "linear", weights: {} }, point: [1, -2], inside: true };
  const free = { ...ON_ROUTE, point: [1, -2], atPoint, shape: "teapot" } as const;
  expect(toCommand(free)).toBe(
    "halfway mix 'my files/lab.brdflib' --point=1,-2 --space paper --blend root --clamp -o a-75-b-25.binary" +
      " && halfway render a-75-b-25.binary --scene teapot -o a-75-b-25.png",
  );
});

test("a material that is turned is rendered so, and a table that depends on phi_h is kept in a file that holds it", () => {
  const library = { ...LIBRARY, grid: [{ angle: "phi_h" }] } as unknown as LibrarySummary;
  const free = { ...ON_ROUTE, library, point: [1, -2], grain: -37 };
  expect(toCommand(free)).toBe(
    "halfway mix 'my files/lab.brdflib' --point=1,-2 --space paper --blend root --clamp -o a-to-b-0.250.zarr" +
      " && halfway render a-to-b-0.250.zarr --scene spheres --env studio --turn -37 -o a-to-b-0.250.png",
  );
});

test("what was found for numbers is made by find, like a place on a route, a point, a material or a file", () => {
  const recipe = { library: "lab", blend: "lobes", weights: { a: 0.5, b: 0.5 } };
  const held = { id: "found", name: "t, haze 2", note: "", recipe, link: "" };
  const asked = { like: null, set: { haze: 2, L: 41.234 }, loose: false };
  const shown = { ...ON_ROUTE, held, asked } as const;
  const wished = "--set haze=2 --set L=41.2 --blend lobes --clamp -o t-haze-2.binary";
  const [made, , rendered] = toCommand(shown).split(/ && (?=halfway (find|render))/);
  expect(made).toBe(
    "halfway route 'my files/lab.brdflib' a b --space paper --blend root --pace uniform --t 0.25 -o like",
  );
  expect(toCommand(shown)).toContain(
    `&& halfway find 'my files/lab.brdflib' --like like/recipes.json:0 ${wished} && halfway render`,
  );
  const body = { like: null, set: { body: "#7a2a3a" }, loose: true };
  expect(toCommand({ ...shown, asked: body })).toContain(
    "--set 'body=#7a2a3a' --release gloss20 --release gloss60 --release gloss85 --release haze --release highlight_width --blend",
  );
  expect(rendered).toBeDefined();
  expect(toCommand({ ...shown, point: [1] })).toMatch(
    /^halfway mix .* -o like.binary && .* --like like.binary/,
  );
  const route = { ...join([LEG], "uniform", ["a", "b"]), blend: "root" };
  expect(toCommand({ ...shown, t: 0, route })).toMatch(
    /^halfway find 'my files\/lab.brdflib' --like a --set/,
  );
  const kept = [{ ...held, id: "1", name: "lid" }];
  expect(toCommand({ ...shown, kept, asked: { ...asked, like: recipe } })).toContain("--like lid.json");
});

test("one material alone is called by its name", () => {
  expect(materialName({ ...ON_ROUTE, recipe: [{ name: "b", weight: [1, 1, 1] }] })).toBe("b");
});

test("what a person wrote is a file's name, and one word of a shell", () => {
  expect(fileName("yesterday's Grün, b -3.5/L 40")).toBe("yesterday-s-Grün-b--3.5-L-40");
});

test("a shortlist comes back from its file as it was", () => {
  const recipe = { library: "lab", blend: "linear", weights: { a: 0.5, b: 0.5 } };
  const kept = [keptOf("mine", recipe, "#t=0.5", "for the lid")];
  const [again] = fromText(toText("lab", kept), "shortlist.json", LIBRARY);
  expect({ ...again, id: "" }).toEqual({ ...kept[0], id: "" });
});

test("a recipe's file says more than the server takes, which is left out", () => {
  const text =
    '{"format": 3, "library": "lab", "weights": {"a": 1}, "body_scale": [1, 1, 2], "library_checksum": "1"}';
  const [{ recipe }] = fromText(text, "x.json", { ...LIBRARY, recolours: true }) as [
    ReturnType<typeof keptOf>,
  ];
  expect(recipe).toEqual({ library: "lab", blend: "linear", weights: { a: 1 }, body_scale: [1, 1, 2] });
});

test.each([
  ["{", "no JSON"],
  ["3", "has no weights"],
  ['{"library": "other", "weights": {"a": 1}}', "of the library other, and this is lab"],
  ['{"library": "lab", "blend": "lobes", "weights": {"a": 1}}', "blends by lobes"],
  ['{"library": "lab", "weights": {"a": 1}, "body_scale": [1, 1, 2]}', "has its body scaled"],
  ['{"library": "lab", "weights": {"zz": 1}}', "needs zz"],
])("a file that is no recipe of this library is refused: %s", (text, said) => {
  expect(() => fromText(text, "x.json", LIBRARY)).toThrow(said);
});

test("what a shortlist needs and the library has not is kept, and said", () => {
  const recipe = { library: "lab", blend: "linear", weights: { a: 0.5, scan: 0.5 } };
  const text = toText("lab", [keptOf("mine", recipe, "")]);
  const [kept] = fromText(text, "shortlist.json", LIBRARY);
  expect(missingIn(kept!.recipe, ["a", "b", "c"])).toEqual(["scan"]);
});
