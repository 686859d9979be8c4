// Materials as people ask for them: what they are made of, their colour, how they shine; and which of them fit some words.
//
// The kind is read off the name, the colour off the mean of the small picture (a metal's colour is in its highlight), the shine
// off the specular gloss at 60 degrees and the width of the highlight, where instruments have read them.

import { toLab } from "./colour";
import { sum } from "./numbers";

export const KINDS = ["fabric", "metal", "paint", "plastic", "rubber", "stone", "wood", "other"] as const;
// biome-ignore format: it is one list.
export const COLOURS = ["red", "orange", "yellow", "green", "blue", "purple", "pink", "brown", "white", "grey", "black"] as const;
export const GLOSSES = ["matte", "satin", "glossy", "mirror"] as const;
export const ORDERS = ["library", "name", "gloss", "lightness", "hue", "likeness"] as const;
export type Kind = (typeof KINDS)[number];
export type Colour = (typeof COLOURS)[number];
export type Gloss = (typeof GLOSSES)[number];
export type Order = (typeof ORDERS)[number];

/** What materials have to be; empty: anything. */
export interface Facets {
  readonly kind: Kind | "";
  readonly colour: Colour | "";
  readonly gloss: Gloss | "";
}

export const ANYTHING: Facets = { kind: "", colour: "", gloss: "" };

export interface Described {
  readonly name: string;
  readonly words: readonly string[];
  readonly kind: Kind;
  readonly colour: Colour;
  /** Null where nothing has been read. */
  readonly gloss: Gloss | null;
  readonly gloss60: number;
  readonly lightness: number;
  /** In degrees, of the colour; greys come last. */
  readonly hue: number;
}

/** Words of names, by what such a material is; the first kind that has one is it: gold paint is paint. */
// biome-ignore format: a line each.
const WORDS: Readonly<Record<Exclude<Kind, "other">, readonly string[]>> = {
  fabric: ["fabric", "felt", "cloth", "silk", "velvet", "satin", "cotton", "wool", "leather", "denim"],
  paint: ["paint", "lacquer", "layer"],
  plastic: ["plastic", "acrylic", "phenolic", "delrin", "nylon", "pvc", "polyethylene", "polyurethane", "teflon", "vinyl"],
  rubber: ["rubber", "latex", "neoprene", "bball"],
  wood: ["wood", "walnut", "maple", "pine", "oak", "cherry", "fruitwood", "natural", "beech", "ash"],
  metal: ["metal", "aluminium", "aluminum", "brass", "bronze", "chrome", "copper", "steel", "ss440", "nickel", "tungsten", "iron", "titanium", "gold", "silver"],
  stone: ["stone", "marble", "jasper", "obsidian", "aventurnine", "hematite", "alumina", "nitrade", "ceramic", "granite"],
};

/** What people say, and what of it is meant: words of names, kinds, colours and glosses. */
// biome-ignore format: a line each.
const SYNONYMS: Readonly<Record<string, readonly string[]>> = {
  car: ["metallic", "layer", "pearl", "changing"], automotive: ["metallic", "layer", "pearl", "changing"],
  brushed: ["steel", "aluminium", "nickel", "brass", "bronze"], metallic: ["metal"],
  cloth: ["fabric"], textile: ["fabric"], woven: ["fabric"],
  shiny: ["glossy", "mirror"], glossy: ["mirror"], polished: ["mirror", "glossy"], specular: ["glossy", "mirror"], reflective: ["mirror"],
  matt: ["matte"], dull: ["matte"], diffuse: ["matte"], flat: ["matte"], semigloss: ["satin"], eggshell: ["satin"],
  resin: ["phenolic"], bakelite: ["phenolic"], wooden: ["wood"], timber: ["wood"], mineral: ["stone"], ceramic: ["stone"], rock: ["stone"],
  gray: ["grey"], violet: ["purple"], lilac: ["purple"], maroon: ["red"], crimson: ["red"], scarlet: ["red"], golden: ["gold"],
  beige: ["brown"], tan: ["brown"], cyan: ["blue"], teal: ["blue", "green"], turquoise: ["blue", "green"], rose: ["pink"], dark: ["black"],
};

/** What instruments read off a material: its specular gloss at 60 degrees, and the width of its highlight in degrees. */
export interface Shine {
  readonly gloss60: number;
  readonly width: number;
}

/** A material by its name, the mean colour of its picture (linear RGB), and its shine where that is known. */
export function described(name: string, picture: readonly number[], shine: Shine | null): Described {
  const words = wordsOf(name);
  const [L, a, b] = toLab(picture);
  const hue = ((Math.atan2(b, a) * 180) / Math.PI + 360) % 360;
  const chroma = Math.hypot(a, b);
  const isGrey = chroma < GREY;
  return {
    name,
    words,
    kind: kindOf(words),
    colour: isGrey ? greyOf(L) : colourOf(L, chroma, hue),
    gloss: shine && glossOf(shine),
    gloss60: shine?.gloss60 ?? 0,
    lightness: L,
    hue: isGrey ? 360 + L : hue,
  };
}

/** Chroma of the mean colour; less has no hue. */
const GREY = 6;
/** Of warm colours: less is brown, or beige, which passes for white. */
const DULL = 16;

function kindOf(words: readonly string[]): Kind {
  const kinds = Object.entries(WORDS) as [Kind, readonly string[]][];
  return kinds.find(([, own]) => words.some((word) => own.includes(word)))?.[0] ?? "other";
}

/** Of the mean over a lit sphere, on which white is 52. */
function greyOf(lightness: number): Colour {
  return lightness < 18 ? "black" : lightness < 43 ? "grey" : "white";
}

function colourOf(lightness: number, chroma: number, hue: number): Colour {
  const isDull = chroma < DULL && hue >= 20 && hue < 105;
  if (isDull) return lightness < 40 ? "brown" : "white";
  if (hue >= 310) return hue < 345 ? "purple" : "pink";
  if (hue >= 230) return "blue";
  if (hue >= 105) return "green";
  if (hue >= 70) return "yellow";
  if (hue >= 47) return "orange";
  return lightness >= 33 && hue < 37 ? "pink" : "red";
}

/** In gloss units; tables read less than panels do, so that a narrow highlight makes what is satin glossy. */
function glossOf({ gloss60, width }: Shine): Gloss {
  if (gloss60 >= 50) return "mirror";
  if (gloss60 >= 10 || (gloss60 >= 5 && width < NARROW)) return "glossy";
  return gloss60 >= 3 ? "satin" : "matte";
}

const NARROW = 2.5;

function wordsOf(text: string): string[] {
  return text
    .toLowerCase()
    .split(/[^\p{L}\p{N}]+/u)
    .filter(Boolean)
    .flatMap((word) => [word, ...(/^\D+\d+$/.test(word) ? [word.replace(/\d+$/, "")] : [])]);
}

/**
 * The names that fit all the words of a query, each as the start of a word of the name, of what the material is, or of
 * something that means the same. Those whose names have more of the words come first. Where none does, those that have the words anywhere.
 */
export function matching(all: readonly Described[], query: string): string[] {
  const words = query
    .toLowerCase()
    .split(/[\s-]+/)
    .filter(Boolean);
  const hits = all
    .map((each) => ({ name: each.name, ranks: words.map((word) => rankOf(each, word)) }))
    .filter(({ ranks }) => Math.max(...ranks) < 2)
    .sort((a, b) => sum(a.ranks) - sum(b.ranks));
  if (hits.length) return hits.map(({ name }) => name);
  return all
    .map(({ name }) => name)
    .filter((name) => words.every((word) => name.toLowerCase().includes(word)));
}

/** "red like chrome" is what materials have to be, and the name, or words, of one that they shall look like; null for no such query. */
export function likeness(query: string): { readonly words: string; readonly like: string } | null {
  const [, words = "", like] = /^(.*?)(?:^|\s)like\s+(\S.*)$/i.exec(query.trim()) ?? [];
  return like === undefined ? null : { words: words.trim(), like };
}

/** 0 where the name has the word, 1 where the material is that, else 2. */
function rankOf({ words, kind, colour, gloss }: Described, word: string): number {
  const isIn = (terms: readonly (string | null)[], start: string) =>
    terms.some((term) => term?.startsWith(start));
  if (isIn(words, word)) return 0;
  const terms = [...words, kind, colour, gloss];
  return isIn([kind, colour, gloss], word) || SYNONYMS[word]?.some((other) => isIn(terms, other)) ? 1 : 2;
}

/** Whether a material is what was chosen. */
export function fits({ kind, colour, gloss }: Described, facets: Facets): boolean {
  return (
    (!facets.kind || kind === facets.kind) &&
    (!facets.colour || colour === facets.colour) &&
    (!facets.gloss || gloss === facets.gloss)
  );
}

/** The materials in an order; likeness is the distance to what is shown. */
export function inOrder(
  all: readonly Described[],
  order: Order,
  distance: (name: string) => number,
): readonly Described[] {
  const keys: Record<Order, (each: Described) => number | string> = {
    library: () => 0,
    name: ({ name }) => name.toLowerCase(),
    gloss: ({ gloss60 }) => gloss60,
    lightness: ({ lightness }) => lightness,
    hue: ({ hue }) => hue,
    likeness: ({ name }) => distance(name),
  };
  const keyed = all.map((each) => ({ each, key: keys[order](each) }));
  return keyed.sort((a, b) => (a.key < b.key ? -1 : a.key > b.key ? 1 : 0)).map(({ each }) => each);
}
