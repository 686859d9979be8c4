// What is shown of the state: which recipe, mixed how, drawn from which tables.

import { LINEAR } from "./blend";
import { comparedKept } from "./compared";
import type { Ingredient } from "./recipe";
import type { State } from "./state";

/** How what is shown is mixed. */
export function blendOf({ held, atPoint, route }: Pick<State, "held" | "atPoint" | "route">): string {
  return (held ?? atPoint)?.recipe.blend ?? route?.blend ?? LINEAR;
}

/** How what it is compared with is mixed. */
export function otherBlendOf(state: Pick<State, "compare" | "kept" | "otherRoute">): string {
  return comparedKept(state)?.recipe.blend ?? state.otherRoute?.blend ?? LINEAR;
}

/** What pictures are made of: the recipe's materials where their pictures mix, else its own table. A ghost stands before it. */
export function drawnOf(state: State): readonly Ingredient[] {
  const { ghost } = state;
  if (ghost) return ghost.blend === LINEAR ? ghost.recipe : state.ghostMixed;
  return blendOf(state) === LINEAR ? state.recipe : state.mixed;
}

export function otherDrawnOf(state: State): readonly Ingredient[] {
  return otherBlendOf(state) === LINEAR ? state.otherRecipe : state.otherMixed;
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
