// What the page shows, and the acts that change it.

import type { Waiting } from "./api/patient";
import type { LibrarySummary, PositionView, SpaceView } from "./api/schema";
import { LINEAR } from "./blend";
import { clamp } from "./numbers";
import { fromDocument, type Ingredient, only } from "./recipe";
import { type Route, recipeAt } from "./route";
import { HOME, type Tone, type View } from "./scene";
import { type Kept, recipeOf } from "./shortlist";
import { createStore, type Store } from "./store";

export const PLOTS = ["lobes", "slice", "albedo"] as const;
export type PlotKind = (typeof PLOTS)[number];
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
  readonly plot: PlotKind;
  readonly theme: Theme;
  /** What the theme comes to here and now. */
  readonly scheme: "light" | "dark";
  /** The material under the pointer, anywhere on the page. */
  readonly hovered: string | null;
  /** Materials whose names match what is searched; null when nothing is. */
  readonly matches: readonly string[] | null;
  readonly view: SpaceView | null;
  readonly route: Route | null;
  readonly recipe: readonly Ingredient[];
  /** Where pictures do not mix: the recipe's table that came last, as a material of its own. */
  readonly mixed: readonly Ingredient[];
  readonly otherMixed: readonly Ingredient[];
  /** Those of the two that are not the full table of what is to be seen. */
  readonly mixing: readonly MixedKey[];
  /** A free point of the space, instead of one on the route; null on the route. */
  readonly point: readonly number[] | null;
  /** What the server says of it. */
  readonly atPoint: PositionView | null;
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

export type MixedKey = "mixed" | "otherMixed";

/** Where a person is in the library's spaces, but for t: what undo goes back to. */
export type Whereabouts = Pick<State, "space" | "blend" | "pace" | "stops" | "point">;

/** What a link carries. */
// biome-ignore format: it is one list.
export const LINKED = ["space", "blend", "pace", "stops", "t", "point", "compare", "shape", "light", "turn", "exposure", "tone", "orbit", "split", "map", "plot"] as const;
export type Linked = Pick<State, (typeof LINKED)[number]>;

const MAX_PAST = 100;
/** Moves of a free point that follow each other so soon, in milliseconds, are one act. */
const ONE_ACT = 700;
const STOP = "stop:";
const KEPT = "kept:";
/** Causes of notices: what was chosen, and what a link says. */
const CHOICE = "choice";
export const LINK = "link";

export function createState(library: LibrarySummary, linked: Partial<Linked>, theme: Theme): Store<State> {
  const stops = linked.stops ?? defaultStops(library);
  const space = linked.space ?? library.spaces[0]?.name ?? "";
  return createStore<State>({
    library,
    space,
    blend: usualBlend(library, space),
    pace: library.paces[0] ?? "",
    t: 0.5,
    shape: "sphere",
    mesh: null,
    light: "studio",
    turn: 0,
    tone: "none",
    ownLight: null,
    split: 0.5,
    map: "",
    plot: "lobes",
    exposure: 0,
    orbit: HOME,
    point: null,
    compare: "",
    ...linked,
    stops,
    slot: stops.length - 1,
    inserting: false,
    goal: null,
    playing: false,
    theme,
    scheme: "dark",
    hovered: null,
    matches: null,
    view: null,
    route: null,
    recipe: [],
    mixed: [],
    otherMixed: [],
    mixing: [],
    atPoint: null,
    kept: [],
    held: null,
    otherRoute: null,
    otherRecipe: [],
    arrived: 0,
    pictured: false,
    notices: [],
    waiting: null,
    behind: null,
    past: [],
    future: [],
  });
}

/** How the recipes of a space are mixed unless a person says otherwise. */
export function usualBlend({ spaces }: LibrarySummary, space: string): string {
  return spaces.find(({ name }) => name === space)?.usual_blend ?? LINEAR;
}

/** How what is shown is mixed. */
export function blendOf({ held, atPoint, route }: Pick<State, "held" | "atPoint" | "route">): string {
  return (held ?? atPoint)?.recipe.blend ?? route?.blend ?? LINEAR;
}

/** How what it is compared with is mixed. */
export function otherBlendOf(state: Pick<State, "compare" | "kept" | "otherRoute">): string {
  return comparedKept(state)?.recipe.blend ?? state.otherRoute?.blend ?? LINEAR;
}

/** What pictures are made of: the recipe's materials where their pictures mix, else its own table. */
export function drawnOf(state: State): readonly Ingredient[] {
  return blendOf(state) === LINEAR ? state.recipe : state.mixed;
}

export function otherDrawnOf(state: State): readonly Ingredient[] {
  return otherBlendOf(state) === LINEAR ? state.otherRecipe : state.otherMixed;
}

/** What of the state says what is drawn. */
export const DRAWN = ["recipe", "mixed", "otherRecipe", "otherMixed", "route", "otherRoute"] as const;

/** The material that is compared with; null when it is a space, or nothing. */
export function comparedStop(compare: string): string | null {
  return compare.startsWith(STOP) ? compare.slice(STOP.length) : null;
}

/** The space that is compared with; null when it is a material, or nothing. */
export function comparedSpace(compare: string): string | null {
  return compare === "" || compare.startsWith(STOP) || compare.startsWith(KEPT) ? null : compare;
}

/** The one of the shortlist that is compared with; null when it is anything else. */
export function comparedKept({ compare, kept }: Pick<State, "compare" | "kept">): Kept | null {
  return kept.find(({ id }) => compare === KEPT + id) ?? null;
}

/** What one of the shortlist is called where it is compared with. */
export function asComparedKept({ id }: Kept): string {
  return KEPT + id;
}

/** What a material is called where it is compared with. */
export function asCompared(material: string): string {
  return STOP + material;
}

export class Actions {
  private lastMove = Number.NEGATIVE_INFINITY;

  constructor(private readonly store: Store<State>) {}

  /** Say something beside an act, or with null that its cause is gone. */
  say = (panel: Panel, cause: string, text: string | null): void => {
    const { notices } = this.store.get();
    const others = notices.filter((notice) => notice.panel !== panel || notice.cause !== cause);
    if (text !== null) this.store.set({ notices: [...others, { panel, cause, text }] });
    else if (others.length < notices.length) this.store.set({ notices: others });
  };

  setT = (t: number): void => {
    const { route, otherRoute, point, stops, waiting } = this.store.get();
    if (point !== null) this.remember();
    const clamped = clamp(t, 0, 1);
    this.store.set({
      t: clamped,
      point: null,
      atPoint: null,
      held: null,
      ...(route && { recipe: recipeAt(route, clamped) }),
      ...(!route && waiting?.computed && { recipe: nearest(stops, clamped) }),
      ...(otherRoute && { otherRecipe: recipeAt(otherRoute, clamped) }),
    });
  };

  setRoute = (route: Route): void => {
    const { goal, atPoint, held, recipe } = this.store.get();
    // Where the stops are is known with the route: at perceptual pace they are not even.
    const t = (goal === null ? undefined : route.stops[goal]) ?? this.store.get().t;
    this.store.set({ route, t, goal: null, recipe: atPoint || held ? recipe : recipeAt(route, t) });
  };

  /** What the page waits for. Before any route is known, and that takes long, the nearest stop is shown. */
  setWaiting = (waiting: Waiting | null): void => {
    const { route, recipe, stops, t } = this.store.get();
    const isEmpty = waiting?.computed && route === null && recipe.length === 0;
    this.store.set({ waiting, ...(isEmpty && { recipe: nearest(stops, t) }) });
  };

  /** Leave the route for a point of the space. */
  goTo = (point: readonly number[]): void => {
    const now = performance.now();
    if (now - this.lastMove > ONE_ACT) this.remember();
    this.lastMove = now;
    this.store.set({ point, held: null, playing: false });
  };

  setAtPoint = (atPoint: PositionView): void => {
    if (this.store.get().point !== null) this.store.set({ atPoint, recipe: fromDocument(atPoint.recipe) });
  };

  compareWith = (compare: string): void => {
    const stop = comparedStop(compare);
    const kept = comparedKept({ ...this.store.get(), compare });
    const otherRecipe = stop !== null ? only(stop) : kept ? recipeOf(kept) : [];
    this.store.set({ compare, otherRoute: null, otherRecipe });
  };

  /** Keep a material; the last of the shortlist. */
  keep = (...kept: readonly Kept[]): void => this.store.set({ kept: [...this.store.get().kept, ...kept] });

  /** Another name or note, or with null away with it. */
  changeKept = (id: string, change: Partial<Pick<Kept, "name" | "note">> | null): void => {
    const { kept, held, compare } = this.store.get();
    const next = kept.flatMap((each) => (each.id !== id ? [each] : change ? [{ ...each, ...change }] : []));
    this.store.set({ kept: next, held: next.find((each) => each.id === held?.id) ?? null });
    if (compare === KEPT + id && change === null) this.compareWith("");
    if (held?.id === id && change === null) this.setT(this.store.get().t);
  };

  moveKept = (id: string, by: number): void => {
    const { kept } = this.store.get();
    const from = kept.findIndex((each) => each.id === id);
    const to = clamp(from + by, 0, kept.length - 1);
    this.store.set({ kept: kept.toSpliced(from, 1).toSpliced(to, 0, kept[from]!) });
  };

  /** Show one of the shortlist; the route stays where it is. */
  hold = (held: Kept): void => {
    if (this.store.get().point !== null) this.remember();
    this.store.set({ held, recipe: recipeOf(held), point: null, atPoint: null, playing: false });
  };

  setOtherRoute = (otherRoute: Route): void => {
    this.store.set({ otherRoute, otherRecipe: recipeAt(otherRoute, this.store.get().t) });
  };

  /** Put a material where the chosen slot is, and choose the other end next. */
  choose = (name: string): void => {
    const { stops, slot, inserting } = this.store.get();
    const next = stops.toSpliced(slot, inserting ? 0 : 1, name);
    if (next[slot] === next[slot - 1] || next[slot] === next[slot + 1]) {
      const text = `${name} is the stop beside it already: choose another material, or another stop.`;
      this.say("route", CHOICE, text);
      return;
    }
    if (next[slot] === stops[slot] && !inserting) return;
    this.go({ stops: next });
    this.store.set({ goal: slot, inserting: false });
  };

  /** The next chosen material comes between the stop before `slot` and the one there. */
  insertAt = (slot: number): void => this.store.set({ slot, inserting: true });

  selectSlot = (slot: number): void => {
    const { stops, route } = this.store.get();
    this.store.set({ slot, inserting: false });
    if (slot < stops.length) this.setT(route?.stops[slot] ?? slot / (stops.length - 1));
  };

  removeStop = (i: number): void => {
    const { stops } = this.store.get();
    if (stops.length <= 2) return;
    // Two equal neighbours that meet become one.
    const next = stops.toSpliced(i, 1).filter((name, j, all) => name !== all[j - 1]);
    if (next.length >= 2) this.go({ stops: next });
  };

  moveStop = (from: number, to: number): void => {
    const next = [...this.store.get().stops];
    const [moved] = next.splice(from, 1);
    if (moved === undefined || to < 0 || to > next.length) return;
    next.splice(to, 0, moved);
    if (next.some((name, j) => name === next[j - 1])) {
      this.say("route", CHOICE, "There a stop would follow itself: move it past its neighbour.");
      return;
    }
    this.go({ stops: next });
    this.store.set({ slot: to });
  };

  /** To another space, route or point; what is not said stays, but for a free point. */
  go = (change: Partial<Whereabouts>): void => {
    const { slot } = this.store.get();
    const blend = change.space !== undefined && { blend: usualBlend(this.store.get().library, change.space) };
    const next = { ...this.whereabouts(), point: null, ...blend, ...change };
    for (const cause of [CHOICE, LINK]) this.say("route", cause, null);
    this.remember();
    this.follow(next, Math.min(slot, next.stops.length - 1));
  };

  /** Go where a link leads; what it does not say stays, but for a free point. */
  visit = (linked: Partial<Linked>, unknown: string | null = null): void => {
    const { space, pace, stops, point } = { ...this.store.get(), point: null, ...linked };
    this.go({
      pace,
      stops,
      point,
      ...(linked.space && { space }),
      ...(linked.blend && { blend: linked.blend }),
    });
    this.store.set({ ...linked, slot: stops.length - 1, goal: null, playing: false });
    if (point === null) this.setT(this.store.get().t);
    this.say("route", LINK, unknown);
  };

  undo = (): void => {
    const { past, future } = this.store.get();
    const last = past.at(-1);
    if (last === undefined) return;
    this.store.set({ past: past.slice(0, -1), future: [this.whereabouts(), ...future] });
    this.follow(last, last.stops.length - 1);
  };

  redo = (): void => {
    const [next, ...future] = this.store.get().future;
    if (next === undefined) return;
    this.remember();
    this.store.set({ future });
    this.follow(next, next.stops.length - 1);
  };

  private follow(next: Whereabouts, slot: number): void {
    const { route, t } = this.store.get();
    this.lastMove = Number.NEGATIVE_INFINITY;
    // Back on the same route, its recipe holds; on another one it comes with the answer.
    const recipe = next.point === null && route ? { recipe: recipeAt(route, t) } : {};
    this.store.set({ ...next, slot, inserting: false, atPoint: null, held: null, ...recipe });
  }

  /** The present whereabouts are one undo away; nothing is ahead of them. */
  private remember(): void {
    this.store.set({ past: [...this.store.get().past.slice(1 - MAX_PAST), this.whereabouts()], future: [] });
  }

  private whereabouts(): Whereabouts {
    const { space, blend, pace, stops, point } = this.store.get();
    return { space, blend, pace, stops, point };
  }
}

/** The recipe of the stop that is nearest where the route is not known. */
function nearest(stops: readonly string[], t: number): Ingredient[] {
  return only(stops[Math.round(t * (stops.length - 1))]!);
}

/** Whether what is shown is not on the route. */
export function isAway({ atPoint, held }: Pick<State, "atPoint" | "held">): boolean {
  return atPoint !== null || held !== null;
}

/** A pair that shows something, where the library has it. */
function defaultStops({ materials }: LibrarySummary): string[] {
  const names = materials.map(({ name }) => name);
  const wished = ["specular-maroon-phenolic", "gold-paint"].filter((name) => names.includes(name));
  return wished.length === 2 ? wished : [names[0]!, names.at(-1)!];
}
