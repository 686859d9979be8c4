// The acts that change what the page shows.

import type { Waiting } from "./api/patient";
import type { FoundView, PositionView } from "./api/schema";
import { asking, foundAs } from "./asked";
import { asComparedKept, comparedKept, comparedStop } from "./compared";
import { clamp } from "./numbers";
import { fromDocument, type Ingredient, only } from "./recipe";
import { type Route, recipeAt } from "./route";
import { type Kept, recipeOf } from "./shortlist";
import { likeOf } from "./shown";
import { type Linked, type Panel, type State, usualBlend, type Whereabouts } from "./state";
import type { Store } from "./store";
import { shortName } from "./title";

const MAX_PAST = 100;
/** Moves of a free point, or of what is asked for, that follow each other so soon, in milliseconds, are one act. */
const ONE_ACT = 700;
/** Causes of notices: what was chosen, and what a link says. */
const CHOICE = "choice";
export const LINK = "link";

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
    const { route, otherRoute, stops, waiting } = this.store.get();
    this.rememberAway();
    const clamped = clamp(t, 0, 1);
    this.store.set({
      t: clamped,
      point: null,
      atPoint: null,
      held: null,
      asked: null,
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
    this.rememberMove();
    this.store.set({ point, held: null, asked: null, playing: false });
  };

  /** Ask for a material like the one that is shown, with this value of an attribute; with null ask for one thing less. */
  ask = (name: string, value: number | string | null): void => {
    const { asked, held, attributes, numbers, point, t } = this.store.get();
    const like = asked ? asked.like : (held?.recipe ?? null);
    const set = asking(asked?.set ?? {}, name, value, attributes ?? [], numbers?.attributes ?? {});
    if (like === null && point === null && Object.keys(set).length === 0) {
      this.setT(t);
      return;
    }
    this.rememberMove();
    this.store.set({ asked: { like, set, loose: asked?.loose ?? false }, playing: false });
  };

  /** Whether the highlight may change with the body colour that is asked for. */
  loosen = (loose: boolean): void => {
    const { asked } = this.store.get();
    if (asked === null) return;
    this.rememberMove();
    this.store.set({ asked: { ...asked, loose } });
  };

  /** What was found for what is asked for; or the numbers of what is shown, where nothing is. */
  setNumbers = (numbers: FoundView): void => {
    const state = this.store.get();
    const { asked, kept } = state;
    if (asked === null) {
      this.store.set({ numbers });
      return;
    }
    const like = likeOf(state);
    const recipe = like ? fromDocument(like) : state.recipe;
    const own = kept.find((each) => each.recipe === asked.like)?.name;
    const held = foundAs(own ?? shortName({ ...state, held: null, recipe }), asked.set, numbers.recipe);
    this.store.set({ numbers, held, recipe: recipeOf(held) });
  };

  setAtPoint = (atPoint: PositionView): void => {
    if (this.store.get().point !== null) this.store.set({ atPoint, recipe: fromDocument(atPoint.recipe) });
  };

  /** Draw what is to be saved: the live picture gets no better meanwhile. */
  shoot = async <T>(draw: () => Promise<T>): Promise<T> => {
    this.store.set({ shooting: true });
    try {
      return await draw();
    } finally {
      this.store.set({ shooting: false });
    }
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
    const own = held?.id === id;
    this.store.set({ kept: next, ...(own && { held: next.find((each) => each.id === id) ?? null }) });
    if (compare === asComparedKept({ id }) && change === null) this.compareWith("");
    if (own && change === null) this.setT(this.store.get().t);
  };

  moveKept = (id: string, by: number): void => {
    const { kept } = this.store.get();
    const from = kept.findIndex((each) => each.id === id);
    const to = clamp(from + by, 0, kept.length - 1);
    this.store.set({ kept: kept.toSpliced(from, 1).toSpliced(to, 0, kept[from]!) });
  };

  /** Show one of the shortlist; the route stays where it is. */
  hold = (held: Kept): void => {
    this.rememberAway();
    this.store.set({ held, recipe: recipeOf(held), point: null, atPoint: null, asked: null, playing: false });
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
    const next = { ...this.whereabouts(), point: null, asked: null, ...blend, ...change };
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
    this.store.set({ asked: linked.asked ?? null });
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

  /** As `remember`, once for moves that follow each other. */
  private rememberMove(): void {
    const now = performance.now();
    if (now - this.lastMove > ONE_ACT) this.remember();
    this.lastMove = now;
  }

  /** Off the route there is somewhere to come back to. */
  private rememberAway(): void {
    const { point, asked } = this.store.get();
    if (point !== null || asked !== null) this.remember();
  }

  private whereabouts(): Whereabouts {
    const { space, blend, pace, stops, point, asked } = this.store.get();
    return { space, blend, pace, stops, point, asked };
  }
}

/** The recipe of the stop that is nearest where the route is not known. */
function nearest(stops: readonly string[], t: number): Ingredient[] {
  return only(stops[Math.round(t * (stops.length - 1))]!);
}
