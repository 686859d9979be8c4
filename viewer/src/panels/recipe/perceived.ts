// How people would perceive the material that is shown, by published networks, each with how far it can be trusted.

import type { PerceivedView } from "../../api/schema";
import type { Context } from "../../context";
import { el } from "../../dom";
import { toDocument } from "../../recipe";
import { blendOf } from "../../shown";

const WHO = "Perceived, 0 to 1";
const SOURCE =
  "By the networks of Serrano et al. 2016; trust is how well they can be trusted for such a material";
/** Milliseconds without a change after which it is asked for: full tables are mixed. */
const STILL = 300;

/** A list that is asked for while it is open; null where nobody can answer. */
export function perceivedNumbers({ client, store, actions, signal }: Context): HTMLElement | null {
  const { perceived } = client;
  if (!perceived) return null;
  const list = el("ul");
  const element = el("details.perceived", el("summary", { title: SOURCE }, WHO), list);
  let timer: ReturnType<typeof setTimeout> | undefined;
  let running = new AbortController();
  const ask = async (asking: AbortSignal) => {
    const state = store.get();
    const document = toDocument(state.library.name, state.recipe, blendOf(state));
    const answer = await perceived(document, asking);
    if (asking.aborted) return;
    list.replaceChildren(...answer.perceived.map(row));
    element.classList.remove("behind");
    actions.say("recipe", "perceived", null);
  };
  const follow = () => {
    clearTimeout(timer);
    running.abort();
    running = new AbortController();
    const { signal: asking } = running;
    if (!element.open || store.get().recipe.length === 0) return;
    element.classList.add("behind");
    const failed = (error: Error) => asking.aborted || actions.say("recipe", "perceived", error.message);
    timer = setTimeout(() => void ask(asking).catch(failed), STILL);
  };
  element.addEventListener("toggle", follow);
  store.watch(["recipe", "route", "atPoint", "held"], follow);
  signal.addEventListener("abort", () => {
    clearTimeout(timer);
    running.abort();
  });
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
