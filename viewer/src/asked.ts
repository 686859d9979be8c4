// What a person asks for: a material like the one that is shown, whose attributes have these values.

import type { AttributeView, FoundView, RecipeDocument } from "./api/schema";
import type { Kept } from "./shortlist";

/** Numbers by the name of the attribute, and the body's colour as #rrggbb. */
export type Wishes = Readonly<Record<string, number | string>>;

export interface Asked {
  /** What it is like; null: the material at t, or at the free point. */
  readonly like: RecipeDocument | null;
  readonly set: Wishes;
  /** Whether the highlight need not stay beside another body colour. */
  readonly loose: boolean;
}

/** The attribute that is a colour. */
export const BODY = "body";

/** What of the highlight is held beside another body colour, unless one of them is asked for. */
export const HIGHLIGHT = ["gloss20", "gloss60", "gloss85", "haze", "highlight_width"];

/** What they are called where there is little room. */
export const LABELS: Readonly<Record<string, string>> = {
  gloss20: "Gloss, 20°",
  gloss60: "Gloss, 60°",
  gloss85: "Gloss, 85°",
  haze: "Haze",
  highlight_width: "Highlight",
  albedo: "Albedo",
  doi: "Distinctness",
  body: "Body colour",
  L: "Lightness L*",
  a: "a* green, red",
  b: "b* blue, yellow",
};

/** What was found, where one of the shortlist is shown. */
export const FOUND = "found";

/**
 * The numbers asked for when one more is, or with null one less. Those that make sense beside another one alone bring it along
 * as it is now, and go with it.
 */
export function asking(
  set: Wishes,
  name: string,
  value: number | string | null,
  attributes: readonly AttributeView[],
  has: Readonly<Record<string, number | null>>,
): Wishes {
  const needs = (each: string) => attributes.find((other) => other.name === each)?.needs ?? "";
  const next = new Map(Object.entries(set));
  if (value === null) next.delete(name);
  else next.set(name, value);
  const beside = needs(name);
  const present = has[beside];
  if (value !== null && beside && !next.has(beside) && typeof present === "number") next.set(beside, present);
  return Object.fromEntries([...next].filter(([each]) => !needs(each) || next.has(needs(each))));
}

/** The number that is asked for; null where none is. */
export function numberIn(asked: Asked | null, name: string): number | null {
  const wanted = asked?.set[name];
  return typeof wanted === "number" ? wanted : null;
}

/** What an attribute is called where there is little room. */
export function called(name: string): string {
  return LABELS[name] ?? name.replaceAll("_", " ");
}

/** What was found, as one of the shortlist would be. */
export function foundAs(name: string, set: Wishes, recipe: RecipeDocument): Kept {
  const numbers = Object.entries(set).map(([each, value]) => `${each} ${written(value)}`);
  return { id: FOUND, name: [name, ...numbers].join(", "), note: "", recipe, link: "" };
}

/** What should have stayed as it was, from what to what; empty where all did. */
export function givenUp({ given_up }: FoundView): string {
  return given_up.map(({ name, was, now }) => `${called(name)} ${was} to ${now}`).join(", ");
}

/** A value that is asked for, as it is written in names and commands. */
export function written(value: number | string): string {
  return typeof value === "number" ? inDigits(value) : value;
}

/** A number in as many digits as say something. */
export function inDigits(value: number): string {
  return String(Number(value.toPrecision(3)));
}

/** Between a value and where its slider is, in [0, 1]: the values of a library that crowd near 0 are spread by a cube root. */
export function sliderOf(values: readonly (number | null)[]) {
  const known = values.filter((value) => value !== null).sort((a, b) => a - b);
  const [least = 0, most = 1] = [known[0], known.at(-1)];
  const middle = known[Math.floor(known.length / 2)] ?? 0;
  const crowded = least >= 0 && middle < most / CROWDED;
  const [to, back] = crowded ? [Math.cbrt, (x: number) => x ** 3] : [same, same];
  const [from, width] = [to(least), to(most) - to(least) || 1];
  return {
    toShare: (value: number) => Math.min(Math.max((to(value) - from) / width, 0), 1),
    toValue: (share: number) => back(from + share * width),
  };
}

/** The most is so many times what the one in the middle has. */
const CROWDED = 4;
const same = (x: number) => x;
