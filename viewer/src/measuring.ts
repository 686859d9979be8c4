// What instruments read: of all materials, once, when somebody needs it; and of what is shown, or what comes nearest to what is asked for.

import type { FoundView, RecipeDocument } from "./api/schema";
import { HIGHLIGHT, type Wishes } from "./asked";
import type { Context } from "./context";
import { Refined } from "./refined";
import { likeOf, shownDocument } from "./shown";
import { GRID, NUMBERS, type State } from "./state";

/** Attributes that have a slider, in their order. */
export const SLIDERS = ["gloss60", "haze", "highlight_width", "albedo", "L", "a", "b"];

const TAKES_A_SERVER =
  "The link asks for a material by its numbers or its body colour, which files do not find: open the library with `halfway view`.";

interface Question {
  readonly like: RecipeDocument;
  readonly set: Wishes;
  readonly release: readonly string[];
}

export function followNumbers(context: Context): void {
  const { client, store, actions } = context;
  fetchAttributes(context);
  const { find } = client;
  if (find === undefined) {
    if (store.get().asked) actions.say("recipe", "numbers", TAKES_A_SERVER);
    return;
  }
  const numbers = new Refined<Question, FoundView>({
    ask: (question, draft, signal) => find({ ...question, draft, ranges: draft ? [] : SLIDERS }, signal),
    onAnswer: actions.setNumbers,
    onBehind: (counting) => store.set({ counting }),
    onProblem: (problem) => {
      actions.say("recipe", "numbers", problem);
      if (problem !== null) store.set({ counting: false });
    },
  });
  store.watch(["aside", "map", "asked", "recipe", "route", "atPoint"], (state) =>
    numbers.want(question(state)),
  );
}

/** Whether the numbers of what is shown are those that came last, or are asked for. */
export function isMeasured({ aside, map, asked }: Pick<State, "aside" | "map" | "asked">): boolean {
  return asked !== null || aside === "numbers" || map === NUMBERS;
}

/** Null where nobody wants to know, or what is asked about is not known yet. */
function question(state: State): Question | null {
  const { asked, recipe } = state;
  if (asked === null)
    return isMeasured(state) && recipe.length > 0
      ? { like: shownDocument(state), set: {}, release: [] }
      : null;
  const like = likeOf(state);
  return like ? { like, set: asked.set, release: asked.loose ? HIGHLIGHT : [] } : null;
}

function needsAttributes(state: State): boolean {
  return [state.query, state.tint].some(Boolean) || state.map === GRID || isMeasured(state);
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
