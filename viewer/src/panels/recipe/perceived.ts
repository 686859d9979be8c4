// How people would perceive the material that is shown, by published networks, each with how far it can be trusted.

import type { PerceivedView, PerceptionView, RecipeDocument } from "../../api/schema";
import type { Context } from "../../context";
import { el } from "../../dom";
import { Refined } from "../../refined";
import { shownDocument } from "../../shown";

const WHO = "Perceived, 0 to 1";
const SOURCE =
  "By the networks of Serrano et al. 2016; trust is how well they can be trusted for such a material";

/** A list that is asked for while it is open, once nothing moves: full tables are mixed. Null where nobody can answer. */
export function perceivedNumbers({ client, store, actions, signal }: Context): HTMLElement | null {
  const { perceived } = client;
  if (!perceived) return null;
  const list = el("ul");
  const element = el("details.perceived", el("summary", { title: SOURCE }, WHO), list);
  const asked = new Refined<RecipeDocument, PerceptionView | null>({
    ask: async (recipe, draft, moved) => (draft ? null : perceived(recipe, moved)),
    onAnswer: (answer) => {
      if (answer === null) return;
      const isFirst = list.childElementCount === 0;
      list.replaceChildren(...answer.perceived.map(row));
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

function row({ name, value, trust }: PerceivedView): HTMLElement {
  const words = name.replaceAll("_", " ");
  const bar = el("i");
  bar.style.transform = `scaleX(${Math.min(Math.max(value, 0), 1)})`;
  return el(
    "li",
    { "data-trust": trust, title: `${words}: ${value.toFixed(3)}, trust ${trust}` },
    el("span.cut", words),
    el("span.share", bar),
    el("span", value.toFixed(2)),
    el("span.quiet", trust),
  );
}
