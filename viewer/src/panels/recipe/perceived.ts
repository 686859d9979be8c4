// How people would perceive the material that is shown, by published networks, each with how far it can be trusted; and asked for by that.

import type { PerceivedView, PerceptionView, RecipeDocument } from "../../api/schema";
import { called, numberIn, sliderOf } from "../../asked";
import type { Context } from "../../context";
import { el } from "../../dom";
import { Refined } from "../../refined";
import { shownDocument } from "../../shown";
import { dial } from "./dial";

const WHO = "Perceived, 0 to 1, and trust in it";
const SOURCE =
  "By the networks of Serrano et al. 2016; trust is how well they can be trusted for such a material";
const SLIDER = sliderOf([0, 1]);

/** Sliders that are there while it is open, of what is known once nothing moves: full tables are mixed. Null where nobody can answer. */
export function perceivedNumbers(context: Context): HTMLElement | null {
  const { client, store, actions, signal } = context;
  const { perceived } = client;
  if (!perceived) return null;
  const list = el("ul.dials");
  const element = el("details.perceived", el("summary", { title: SOURCE }, WHO), list);
  const rows = new Map<string, (view: PerceivedView) => void>();
  const asked = new Refined<RecipeDocument, PerceptionView | null>({
    ask: async (recipe, draft, moved) => (draft ? null : perceived(recipe, moved)),
    onAnswer: (answer) => {
      if (answer === null) return;
      const isFirst = rows.size === 0;
      for (const view of answer.perceived) {
        if (isFirst) rows.set(view.name, addRow(context, list, view.name));
        rows.get(view.name)?.(view);
      }
      if (isFirst) element.scrollIntoView({ block: "nearest" });
    },
    onBehind: (behind) => element.classList.toggle("behind", behind),
    onProblem: (problem) => actions.say("recipe", "perceived", problem),
  });
  const follow = () => {
    const state = store.get();
    const isWanted = element.open && state.recipe.length > 0;
    asked.want(isWanted ? shownDocument(state) : null);
  };
  element.addEventListener("toggle", follow);
  store.watch(["recipe", "route", "atPoint", "held"], follow);
  signal.addEventListener("abort", () => asked.want(null));
  return element;
}

/** Adds a slider; what it gives shows another value. */
function addRow(context: Context, list: HTMLElement, name: string): (view: PerceivedView) => void {
  const trust = el("span.quiet");
  const title = `Perceived: ${called(name)}`;
  const { element, show } = dial(context, {
    name,
    label: called(name),
    title,
    slider: SLIDER,
    beside: trust,
  });
  let has: number | null = null;
  const follow = () => show(true, has, numberIn(context.store.get().asked, name));
  context.store.watch(["asked"], follow);
  list.append(element);
  return (view) => {
    has = view.value;
    element.dataset.trust = trust.textContent = view.trust;
    element.title = `${called(name)}: ${view.value.toFixed(3)}, trust ${view.trust}`;
    follow();
  };
}
