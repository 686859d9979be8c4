// What instruments read: of all materials, once, when somebody needs it; and of what is shown, or what comes nearest to what is asked for.

import type { FoundView, RecipeDocument } from "./api/schema";
import type { Numbers } from "./asked";
import type { Context } from "./context";
import { toDocument } from "./recipe";
import { Refined } from "./refined";
import { recipeAt } from "./route";
import { blendOf } from "./shown";
import { GRID, NUMBERS, type State } from "./state";

/** Attributes that have a slider, in their order. */
export const SLIDERS = ["gloss60", "haze", "highlight_width", "albedo", "L", "a", "b"];

interface Question {
  readonly like: RecipeDocument;
  readonly set: Numbers;
}

export function followNumbers(context: Context): void {
  const { client, store, actions } = context;
  fetchAttributes(context);
  const { find } = client;
  if (find === undefined) return;
  const numbers = new Refined<Question, FoundView>({
    ask: (question, draft, signal) => find({ ...question, draft, ranges: draft ? [] : SLIDERS }, signal),
    onAnswer: actions.setNumbers,
    onBehind: (counting) => store.set({ counting }),
    onProblem: (problem) => actions.say("recipe", "numbers", problem),
  });
  store.watch(["aside", "map", "asked", "recipe", "route", "atPoint"], (state) =>
    numbers.want(question(state)),
  );
}

/** Null where nobody wants to know, or what is asked about is not known yet. */
function question(state: State): Question | null {
  const { library, aside, map, asked, recipe, route, t, point, atPoint } = state;
  if (asked === null) {
    const like = toDocument(library.name, recipe, blendOf(state));
    return (aside === "numbers" || map === NUMBERS) && recipe.length > 0 ? { like, set: {} } : null;
  }
  const there = point ? atPoint?.recipe : route && toDocument(library.name, recipeAt(route, t), route.blend);
  const like = asked.like ?? there;
  return like ? { like, set: asked.set } : null;
}

function needsAttributes({ aside, asked, query, map, tint }: State): boolean {
  return (
    [query, tint].some(Boolean) || asked !== null || aside === "numbers" || [GRID, NUMBERS].includes(map)
  );
}

function fetchAttributes({ client, store, actions }: Context): void {
  let asked = false;
  store.watch(["aside", "asked", "query", "map", "tint"], (state) => {
    if (asked || !needsAttributes(state)) return;
    asked = true;
    client.attributes().then(
      ({ attributes }) => store.set({ attributes }),
      (error: Error) => {
        asked = false;
        if (error.name !== "AbortError") actions.say("recipe", "attributes", error.message);
      },
    );
  });
}
