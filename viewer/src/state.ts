// What the page shows.

import type { Waiting } from "./api/patient";
import type { AttributeView, FoundView, LibrarySummary, PositionView, SpaceView } from "./api/schema";
import type { Asked } from "./asked";
import { LINEAR, type Mixing } from "./blend";
import { ANYTHING, type Described, type Facets, type Order } from "./materials";
import type { Ingredient } from "./recipe";
import type { Route } from "./route";
import { HOME, type Tone, type View } from "./scene";
import type { Kept } from "./shortlist";
import { createStore, type Store } from "./store";

export const PLOTS = ["lobes", "slice", "albedo"] as const;
export type PlotKind = (typeof PLOTS)[number];
export const ASIDES = ["weights", "numbers"] as const;
export type Aside = (typeof ASIDES)[number];
export type Theme = "auto" | "light" | "dark";

/** Where a notice stands: beside the act that it is about. */
export type Panel = "space" | "material" | "route" | "recipe";

/** Something to be said, until its cause is gone or a person closes it. */
export interface Notice {
  readonly panel: Panel;
  readonly cause: string;
  readonly text: string;
}

export interface State extends View {
  readonly library: LibrarySummary;
  readonly space: string;
  /** How the recipes of the space are mixed. */
  readonly blend: string;
  readonly pace: string;
  readonly stops: readonly string[];
  /** The stop that the next chosen material replaces; `stops.length` adds one. */
  readonly slot: number;
  /** Whether it comes before that stop instead. */
  readonly inserting: boolean;
  readonly t: number;
  /** The stop that t goes to when the route has come; null for none. */
  readonly goal: number | null;
  readonly playing: boolean;
  readonly exposure: number;
  readonly tone: Tone;
  /** The file of a person's own light. */
  readonly ownLight: string | null;
  /** The map of the space that is shown, and the plot of the BRDF. */
  readonly map: string;
  /** The attributes that are the axes of the map of numbers; and the one that colours stand for, "" for none. */
  readonly axes: readonly [string, string, string];
  readonly tint: string;
  readonly plot: PlotKind;
  readonly theme: Theme;
  /** What the theme comes to here and now. */
  readonly scheme: "light" | "dark";
  /** The material under the pointer, anywhere on the page. */
  readonly hovered: string | null;
  /** What is pointed at to be looked at before it is chosen; and once the pointer rests, what is drawn instead of the recipe. */
  readonly pointed: Pointed | null;
  readonly ghost: Ghost | null;
  /** The materials in words, in the library's order; what is searched, what was chosen of them, and their order in the grid. */
  readonly described: readonly Described[];
  readonly query: string;
  readonly facets: Facets;
  readonly order: Order;
  /** What is searched by likeness to a material. */
  readonly alike: Alike | null;
  /** Materials that fit what is searched or chosen; null when nothing is. */
  readonly matches: readonly string[] | null;
  readonly view: SpaceView | null;
  readonly route: Route | null;
  readonly recipe: readonly Ingredient[];
  /** Where pictures do not mix: the recipe's table that came last, as a material of its own. */
  readonly mixed: readonly Ingredient[];
  readonly otherMixed: readonly Ingredient[];
  readonly ghostMixed: readonly Ingredient[];
  /** Those of the three that are not the full table of what is to be seen. */
  readonly mixing: readonly MixedKey[];
  /** A free point of the space, instead of one on the route; null on the route. */
  readonly point: readonly number[] | null;
  /** What the server says of it. */
  readonly atPoint: PositionView | null;
  /** Whether the recipe panel shows weights, or numbers that instruments would read. */
  readonly aside: Aside;
  /** What instruments read off all materials; null until somebody needs it and it has come. */
  readonly attributes: readonly AttributeView[] | null;
  /** What a person asks for in numbers, and what came of it last. */
  readonly asked: Asked | null;
  readonly numbers: FoundView | null;
  /** Whether they are not those of what is shown, or asked for. */
  readonly counting: boolean;
  /** What a person kept, in their order; and the one of it that is shown instead of the route. */
  readonly kept: readonly Kept[];
  readonly held: Kept | null;
  /**
   * What is shown beside: "" nothing, `stop:NAME` a material, `kept:ID` one of the shortlist, else a space, whose way through
   * the same stops it is.
   */
  readonly compare: string;
  readonly otherRoute: Route | null;
  readonly otherRecipe: readonly Ingredient[];
  /** Where the present material ends and the other begins, from left to right in [0, 1]. */
  readonly split: number;
  /** How many tables have come: who draws from them watches it. */
  readonly arrived: number;
  /** Whether a picture or a film is being drawn to be saved: the live picture gets no better meanwhile. */
  readonly shooting: boolean;
  /** Whether the pictures of all materials have come. */
  readonly pictured: boolean;
  readonly notices: readonly Notice[];
  /** What the page waits for: it is being computed, or nobody answers. */
  readonly waiting: Waiting | null;
  /** The route that is shown, in words, while another is asked for. */
  readonly behind: string | null;
  readonly past: readonly Whereabouts[];
  readonly future: readonly Whereabouts[];
}

/** How different people find each material from one, in the library's order; null until it has come. */
export interface Alike {
  readonly to: string;
  readonly distances: readonly number[] | null;
}

export type MixedKey = "mixed" | "otherMixed" | "ghostMixed";

/** A material that is looked at before it is chosen, and what it is called. */
export interface Ghost extends Mixing {
  readonly name: string;
  readonly recipe: readonly Ingredient[];
}

/** One, or a point of the space that is shown. */
export type Pointed = Ghost | { readonly point: readonly number[] };

/** The map on which the materials stand side by side. */
export const GRID = "Grid";

/** The map whose axes are attributes. */
export const NUMBERS = "Numbers";

/** Where a person is in the library's spaces, but for t, and what is asked for there: what undo goes back to. */
export type Whereabouts = Pick<State, "space" | "blend" | "pace" | "stops" | "point" | "asked">;

/** What a link carries. */
// biome-ignore format: it is one list.
export const LINKED = ["space", "blend", "pace", "stops", "t", "point", "compare", "shape", "light", "turn", "grain", "exposure", "tone", "orbit", "split", "map", "axes", "tint", "plot", "aside", "asked"] as const;
export type Linked = Pick<State, (typeof LINKED)[number]>;

/** Where a link does not say. */
const USUAL = {
  t: 0.5,
  shape: "sphere",
  light: "studio",
  turn: 0,
  grain: 0,
  tone: "none",
  split: 0.5,
  map: "",
  axes: ["gloss60", "L", "b"],
  tint: "",
  plot: "lobes",
  exposure: 0,
  orbit: HOME,
  point: null,
  compare: "",
  aside: "weights",
  asked: null,
} as const satisfies Partial<Linked>;

/** Before anything has come, or was done. */
const NOTHING = {
  inserting: false,
  goal: null,
  playing: false,
  mesh: null,
  ownLight: null,
  hovered: null,
  pointed: null,
  ghost: null,
  described: [],
  query: "",
  facets: ANYTHING,
  order: "library",
  alike: null,
  matches: null,
  view: null,
  route: null,
  recipe: [],
  mixed: [],
  otherMixed: [],
  ghostMixed: [],
  mixing: [],
  atPoint: null,
  attributes: null,
  numbers: null,
  counting: false,
  kept: [],
  held: null,
  otherRoute: null,
  otherRecipe: [],
  arrived: 0,
  shooting: false,
  pictured: false,
  notices: [],
  waiting: null,
  behind: null,
  past: [],
  future: [],
} as const satisfies Partial<State>;

export function createState(library: LibrarySummary, linked: Partial<Linked>, theme: Theme): Store<State> {
  const stops = linked.stops ?? defaultStops(library);
  const space = linked.space ?? library.spaces[0]?.name ?? "";
  return createStore<State>({
    ...NOTHING,
    ...USUAL,
    library,
    space,
    blend: usualBlend(library, space),
    pace: library.paces[0] ?? "",
    ...linked,
    stops,
    slot: stops.length - 1,
    theme,
    scheme: "dark",
  });
}

/** How the recipes of a space are mixed unless a person says otherwise. */
export function usualBlend({ spaces }: LibrarySummary, space: string): string {
  return spaces.find(({ name }) => name === space)?.usual_blend ?? LINEAR;
}

/** A pair that shows something, where the library has it. */
function defaultStops({ materials }: LibrarySummary): string[] {
  const names = materials.map(({ name }) => name);
  const wished = ["specular-maroon-phenolic", "gold-paint"].filter((name) => names.includes(name));
  return wished.length === 2 ? wished : [names[0]!, names.at(-1)!];
}
