// What the page shows, and the acts that change it.

import type { LibrarySummary, PositionView, SpaceView } from "./api/schema";
import { clamp } from "./numbers";
import { fromDocument, type Ingredient, only } from "./recipe";
import { type Route, recipeAt } from "./route";
import { HOME, type View } from "./scene";
import { createStore, type Store } from "./store";

export type Theme = "auto" | "light" | "dark";

export interface State extends View {
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
  readonly exposure: number;
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
  /** A free point of the space, instead of one on the route; null on the route. */
  readonly point: readonly number[] | null;
  /** What the server says of it. */
  readonly atPoint: PositionView | null;
  /** What is shown beside: "" nothing, `stop:NAME` a material, else a space, whose way through the same stops it is. */
  readonly compare: string;
  readonly otherRoute: Route | null;
  readonly otherRecipe: readonly Ingredient[];
  /** Where the present material ends and the other begins, from left to right in [0, 1]. */
  readonly split: number;
  /** How many tables have come: who draws from them watches it. */
  readonly arrived: number;
  readonly problem: string | null;
  readonly past: readonly Whereabouts[];
  readonly future: readonly Whereabouts[];
}

/** Where a person is in the library's spaces, but for t: what undo goes back to. */
export type Whereabouts = Pick<State, "space" | "pace" | "stops" | "point">;

/** What a link carries. */
// biome-ignore format: it is one list.
export const LINKED = ["space", "pace", "stops", "t", "point", "compare", "shape", "light", "exposure", "orbit"] as const;
export type Linked = Pick<State, (typeof LINKED)[number]>;

const MAX_PAST = 100;
/** Moves of a free point that follow each other so soon, in milliseconds, are one act. */
const ONE_ACT = 700;
const STOP = "stop:";

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
    matches: null,
    view: null,
    route: null,
    recipe: [],
    atPoint: null,
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

/** The space that is compared with; null when it is a material, or nothing. */
export function comparedSpace(compare: string): string | null {
  return compare === "" || compare.startsWith(STOP) ? null : compare;
}

/** What a material is called where it is compared with. */
export function asCompared(material: string): string {
  return STOP + material;
}

export class Actions {
  private lastMove = Number.NEGATIVE_INFINITY;

  constructor(private readonly store: Store<State>) {}

  setT = (t: number): void => {
    const { route, otherRoute, point } = this.store.get();
    if (point !== null) this.remember();
    const clamped = clamp(t, 0, 1);
    this.store.set({
      t: clamped,
      point: null,
      atPoint: null,
      ...(route && { recipe: recipeAt(route, clamped) }),
      ...(otherRoute && { otherRecipe: recipeAt(otherRoute, clamped) }),
    });
  };

  setRoute = (route: Route): void => {
    const { goal, atPoint, recipe } = this.store.get();
    // Where the stops are is known with the route: at perceptual pace they are not even.
    const t = (goal === null ? undefined : route.stops[goal]) ?? this.store.get().t;
    this.store.set({ route, t, goal: null, recipe: atPoint ? recipe : recipeAt(route, t), problem: null });
  };

  /** Leave the route for a point of the space. */
  goTo = (point: readonly number[]): void => {
    const now = performance.now();
    if (now - this.lastMove > ONE_ACT) this.remember();
    this.lastMove = now;
    this.store.set({ point, playing: false });
  };

  setAtPoint = (atPoint: PositionView): void => {
    if (this.store.get().point !== null)
      this.store.set({ atPoint, recipe: fromDocument(atPoint.recipe), problem: null });
  };

  compareWith = (compare: string): void => {
    const stop = comparedStop(compare);
    this.store.set({ compare, otherRoute: null, otherRecipe: stop === null ? [] : only(stop) });
  };

  setOtherRoute = (otherRoute: Route): void => {
    this.store.set({ otherRoute, otherRecipe: recipeAt(otherRoute, this.store.get().t) });
  };

  /** Put a material where the chosen slot is, and choose the other end next. */
  choose = (name: string): void => {
    const { stops, slot } = this.store.get();
    if ([slot - 1, slot, slot + 1].some((i) => stops[i] === name)) return;
    this.go({ stops: stops.toSpliced(slot, 1, name) });
    this.store.set({ goal: slot });
  };

  selectSlot = (slot: number): void => {
    const { stops, route } = this.store.get();
    this.store.set({ slot });
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
    if (next.some((name, j) => name === next[j - 1])) return;
    this.go({ stops: next });
    this.store.set({ slot: to });
  };

  /** To another space, route or point; what is not said stays, but for a free point. */
  go = (change: Partial<Whereabouts>): void => {
    const { slot } = this.store.get();
    const next = { ...this.whereabouts(), point: null, ...change };
    this.remember();
    this.follow(next, Math.min(slot, next.stops.length - 1));
  };

  /** Go where a link leads; what it does not say stays, but for a free point. */
  visit = (linked: Partial<Linked>): void => {
    const { space, pace, stops, point } = { ...this.store.get(), point: null, ...linked };
    this.go({ space, pace, stops, point });
    this.store.set({ ...linked, slot: stops.length - 1, goal: null, playing: false });
    if (point === null) this.setT(this.store.get().t);
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
    this.store.set({ ...next, slot, atPoint: null, ...recipe });
  }

  /** The present whereabouts are one undo away; nothing is ahead of them. */
  private remember(): void {
    this.store.set({ past: [...this.store.get().past.slice(1 - MAX_PAST), this.whereabouts()], future: [] });
  }

  private whereabouts(): Whereabouts {
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
