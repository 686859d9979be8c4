// What is shown of the state: which recipe, mixed how, drawn from which tables.

import type { RecipeDocument } from "./api/schema";
import { type Mixing, PLAIN, picturesMix } from "./blend";
import { comparedKept } from "./compared";
import { type Ingredient, toDocument } from "./recipe";
import { recipeAt } from "./route";
import type { State } from "./state";

/** How what is shown is mixed. */
export function mixingOf({ held, atPoint, route }: Pick<State, "held" | "atPoint" | "route">): Mixing {
  return (held ?? atPoint)?.recipe ?? route ?? PLAIN;
}

export type Shown = Pick<State, "library" | "recipe" | "held" | "atPoint" | "route">;

/** What is asked about: where nothing else is said, what is at the free point, or at t; null until that is known. */
export function likeOf({ library, asked, point, atPoint, route, t }: State): RecipeDocument | null {
  const there = point ? atPoint?.recipe : route && toDocument(library.name, recipeAt(route, t), route);
  return asked?.like ?? there ?? null;
}

/** What is shown, as a document. */
export function shownDocument(state: Shown): RecipeDocument {
  return toDocument(state.library.name, state.recipe, mixingOf(state));
}

/** How what it is compared with is mixed. */
export function otherMixingOf(state: Pick<State, "compare" | "kept" | "otherRoute">): Mixing {
  return comparedKept(state)?.recipe ?? state.otherRoute ?? PLAIN;
}

/** What pictures are made of: the recipe's materials where their pictures mix, else its own table. A ghost stands before it. */
export function drawnOf(state: State): readonly Ingredient[] {
  const { ghost } = state;
  if (ghost) return picturesMix(ghost) ? ghost.recipe : state.ghostMixed;
  return picturesMix(mixingOf(state)) ? state.recipe : state.mixed;
}

export function otherDrawnOf(state: State): readonly Ingredient[] {
  return picturesMix(otherMixingOf(state)) ? state.otherRecipe : state.otherMixed;
}

/** What of the state says what is drawn. */
export const DRAWN = [
  "recipe",
  "mixed",
  "otherRecipe",
  "otherMixed",
  "route",
  "otherRoute",
  "ghost",
  "ghostMixed",
] as const;

/** Whether what is shown is not on the route. */
export function isAway({ atPoint, held }: Pick<State, "atPoint" | "held">): boolean {
  return atPoint !== null || held !== null;
}
