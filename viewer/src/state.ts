// What the page shows, and the acts that change it.

import type { BufferGeometry } from "three";

import type { LibrarySummary, PlaceView, RouteView, SpaceView } from "./api/schema";
import { fromDocument } from "./place";
import { type Ingredient, recipeAt } from "./recipe";
import type { Light } from "./render/environments";
import { HOME, type Orbit, type Shape } from "./render/stage";
import { createStore, type Store } from "./store";

export type Theme = "auto" | "light" | "dark";

export interface State {
  readonly library: LibrarySummary;
  readonly space: string;
  readonly pace: string;
  readonly stops: readonly string[];
  /** The stop that the next chosen material replaces; `stops.length` adds one. */
  readonly slot: number;
  readonly t: number;
  /** The stop that t goes to when the route has come; null for none. */
  readonly goal: number | null;
  readonly playing: boolean;
  readonly shape: Shape;
  /** A person's own object, and its file's name. */
  readonly mesh: { readonly name: string; readonly geometry: BufferGeometry } | null;
  readonly light: Light;
  readonly exposure: number;
  readonly orbit: Orbit;
  readonly theme: Theme;
  /** What the theme comes to here and now. */
  readonly scheme: "light" | "dark";
  /** The material under the pointer, anywhere on the page. */
  readonly hovered: string | null;
  /** Materials whose names match what is searched; null when nothing is. */
  readonly found: readonly string[] | null;
  readonly view: SpaceView | null;
  readonly route: RouteView | null;
  readonly recipe: readonly Ingredient[];
  /** A free place of the space, instead of one on the route; null on the route. */
  readonly point: readonly number[] | null;
  /** What the server says of it. */
  readonly place: PlaceView | null;
  /** What is shown beside: "" nothing, `stop:NAME` a material, else a space, whose way through the same stops it is. */
  readonly compare: string;
  readonly otherRoute: RouteView | null;
  readonly otherRecipe: readonly Ingredient[];
  /** Where the present material ends and the other begins, from left to right in [0, 1]. */
  readonly split: number;
  /** How many tables have come: who draws from them watches it. */
  readonly arrived: number;
  readonly problem: string | null;
  readonly past: readonly Way[];
  readonly future: readonly Way[];
}

/** What undo goes back to. */
export type Way = Pick<State, "space" | "pace" | "stops" | "point">;

/** What a link carries. */
export type Linked = Pick<
  State,
  "space" | "pace" | "stops" | "t" | "point" | "compare" | "shape" | "light" | "exposure" | "orbit"
>;

const MAX_PAST = 100;
/** Moves of a free place that follow each other so soon, in milliseconds, are one act. */
const ONE_ACT = 700;
const STOP = "stop:";
export const EXPOSURES = [-4, 4] as const;

export function createState(library: LibrarySummary, linked: Partial<Linked>, theme: Theme): Store<State> {
  const stops = linked.stops ?? defaultStops(library);
  return createStore<State>({
    library,
    space: library.spaces[0]?.name ?? "",
    pace: library.paces[0] ?? "",
    t: 0.5,
    shape: "sphere",
    mesh: null,
    light: "studio",
    exposure: 0,
    orbit: HOME,
    point: null,
    compare: "",
    ...linked,
    stops,
    slot: stops.length - 1,
    goal: null,
    playing: false,
    theme,
    scheme: "dark",
    hovered: null,
    found: null,
    view: null,
    route: null,
    recipe: [],
    place: null,
    otherRoute: null,
    otherRecipe: [],
    split: 0.5,
    arrived: 0,
    problem: null,
    past: [],
    future: [],
  });
}

/** The material that is compared with; null when it is a space, or nothing. */
export function comparedStop(compare: string): string | null {
  return compare.startsWith(STOP) ? compare.slice(STOP.length) : null;
}

export class Actions {
  private lastMove = Number.NEGATIVE_INFINITY;

  constructor(private readonly store: Store<State>) {}

  setT = (t: number): void => {
    const { route, otherRoute, point } = this.store.get();
    if (point !== null) this.remember();
    const clamped = Math.min(Math.max(t, 0), 1);
    this.store.set({
      t: clamped,
      point: null,
      place: null,
      ...(route && { recipe: recipeAt(route, clamped) }),
      ...(otherRoute && { otherRecipe: recipeAt(otherRoute, clamped) }),
    });
  };

  setRoute = (route: RouteView): void => {
    const { goal, place } = this.store.get();
    // At perceptual pace the server says where the stops are.
    const t = (goal === null ? undefined : route.stop_t[goal]) ?? this.store.get().t;
    const recipe = place === null ? recipeAt(route, t) : this.store.get().recipe;
    this.store.set({ route, t, goal: null, recipe, problem: null });
  };

  /** Leave the route for a place of the space. */
  goTo = (point: readonly number[]): void => {
    const now = performance.now();
    if (now - this.lastMove > ONE_ACT) this.remember();
    this.lastMove = now;
    this.store.set({ point, playing: false });
  };

  compareWith = (compare: string): void => {
    const stop = comparedStop(compare);
    const otherRecipe: Ingredient[] = stop === null ? [] : [{ name: stop, weight: [1, 1, 1] }];
    this.store.set({ compare, otherRoute: null, otherRecipe });
  };

  setPlace = (place: PlaceView): void => {
    if (this.store.get().point !== null)
      this.store.set({ place, recipe: fromDocument(place.recipe), problem: null });
  };

  setOtherRoute = (otherRoute: RouteView): void => {
    this.store.set({ otherRoute, otherRecipe: recipeAt(otherRoute, this.store.get().t) });
  };

  /** Put a material where the chosen slot is, and choose the other end next. */
  choose = (name: string): void => {
    const { stops, slot } = this.store.get();
    if (stops[slot - 1] === name || stops[slot + 1] === name || stops[slot] === name) return;
    const next = [...stops.slice(0, slot), name, ...stops.slice(slot + 1)];
    this.go({ stops: next });
    this.store.set({ goal: slot });
  };

  selectSlot = (slot: number): void => {
    const { stops, route } = this.store.get();
    this.store.set({ slot });
    if (slot < stops.length) this.setT(route?.stop_t[slot] ?? slot / (stops.length - 1));
  };

  removeStop = (i: number): void => {
    const { stops } = this.store.get();
    if (stops.length <= 2) return;
    // Two equal neighbours that meet become one.
    const next = stops.filter((_, j) => j !== i).filter((name, j, all) => name !== all[j - 1]);
    if (next.length >= 2) this.go({ stops: next });
  };

  moveStop = (from: number, to: number): void => {
    const next = [...this.store.get().stops];
    const [moved] = next.splice(from, 1);
    if (moved === undefined || to < 0 || to > next.length) return;
    next.splice(to, 0, moved);
    if (next.some((name, j) => name === next[j - 1])) return;
    this.go({ stops: next });
    this.store.set({ slot: to });
  };

  setSpace = (space: string): void => this.go({ space });

  setPace = (pace: string): void => this.go({ pace });

  /** Another way; what is not said of it stays. */
  go = (change: Partial<Way>): void => {
    const { past, slot } = this.store.get();
    const way = { ...this.way(), point: null, ...change };
    this.follow(way, [...past.slice(1 - MAX_PAST), this.way()], [], Math.min(slot, way.stops.length - 1));
  };

  /** Go where a link leads; what it does not say stays, but for a free place. */
  visit = (linked: Partial<Linked>): void => {
    const { space, pace, stops, point } = { ...this.store.get(), point: null, ...linked };
    this.go({ space, pace, stops, point });
    this.store.set({ ...linked, slot: stops.length - 1, goal: null, playing: false });
    if (point === null) this.setT(this.store.get().t);
  };

  undo = (): void => {
    const { past, future } = this.store.get();
    const way = past.at(-1);
    if (way) this.follow(way, past.slice(0, -1), [this.way(), ...future], way.stops.length - 1);
  };

  redo = (): void => {
    const { past, future } = this.store.get();
    const [way, ...rest] = future;
    if (way) this.follow(way, [...past, this.way()], rest, way.stops.length - 1);
  };

  private follow(way: Way, past: readonly Way[], future: readonly Way[], slot: number): void {
    const { route, t } = this.store.get();
    this.lastMove = Number.NEGATIVE_INFINITY;
    // Back on the same route, its recipe holds; on another one it comes with the answer.
    const recipe = way.point === null && route ? { recipe: recipeAt(route, t) } : {};
    this.store.set({ ...way, past, future, slot, place: null, ...recipe });
  }

  private remember(): void {
    this.store.set({ past: [...this.store.get().past.slice(1 - MAX_PAST), this.way()], future: [] });
  }

  private way(): Way {
    const { space, pace, stops, point } = this.store.get();
    return { space, pace, stops, point };
  }
}

/** A pair that shows something, where the library has it. */
function defaultStops({ materials }: LibrarySummary): string[] {
  const names = materials.map(({ name }) => name);
  const wished = ["gold-metallic-paint", "blue-acrylic"].filter((name) => names.includes(name));
  return wished.length === 2 ? wished : [names[0]!, names.at(-1)!];
}
