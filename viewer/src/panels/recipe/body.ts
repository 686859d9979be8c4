// The body colour of the present material, to be changed: what was asked for and what there is, side by side.

import type { FoundView } from "../../api/schema";
import { type Asked, BODY, givenUp, HIGHLIGHT } from "../../asked";
import { bodyScale, unmapped } from "../../blend";
import { toHex } from "../../colour";
import type { Context } from "../../context";
import { coordinatesIn, pointOf } from "../../coordinates";
import { el, iconButton } from "../../dom";
import { isMeasured } from "../../measuring";
import { isAway, mixingOf } from "../../shown";
import type { State } from "../../state";

const TITLE = "Body colour";
const KEEP = "Gloss, haze and the highlight's width stay what they are, as far as that body lets them";
/** Differences in CIEDE2000 that are not seen. */
const UNSEEN = 0.5;

export function bodyColour(context: Context): HTMLElement {
  const { store, actions, names, client } = context;
  const input = el("input", {
    type: "color",
    "aria-label": TITLE,
    oninput: () => actions.ask(BODY, input.value),
  });
  const label = el("label.line", input, TITLE);
  label.hidden = client.find === undefined;
  const note = el("span.note", { role: "status" });
  const leave = () => actions.setT(store.get().t);
  const back = el("button.button", { type: "button", onclick: leave }, "Back to route");
  const element = el("div.line.wrap.adjustment", label, back, note, answer(context));
  store.watch(["view", "recipe", "atPoint", "held", "numbers", "aside", "map", "asked"], (state) => {
    const { recipe, atPoint, held } = state;
    element.hidden = label.hidden && !isAway({ atPoint, held });
    input.disabled = recipe.length === 0;
    back.hidden = !isAway({ atPoint, held });
    note.textContent = atPoint === null || atPoint.inside ? "" : "no mix is just there: this is one nearby";
    const body = state.asked?.set[BODY] ?? presentBody(state, names);
    input.classList.toggle("unknown", body === null);
    if (typeof body === "string" && !input.matches(":focus")) input.value = body;
  });
  return element;
}

/** The body colour of what is shown; null where it is not known. */
function presentBody(state: State, names: readonly string[]): string | null {
  const { view, recipe, blend, numbers } = state;
  if (isMeasured(state)) return numbers?.body ?? null;
  const mixing = mixingOf(state);
  const isOfSpace = mixing.blend === blend && bodyScale(mixing) === null;
  if (view === null || recipe.length === 0 || !isOfSpace) return null;
  const body = coordinatesIn(view, pointOf(view, names, recipe), TITLE);
  // A matte surface of reflectance x has x / pi in 1/sr.
  return body.length ? toHex(body.map((x) => unmapped(blend, x) * Math.PI)) : null;
}

/** Asked and got, how far apart they are, and at what price. */
function answer({ store, actions }: Context): HTMLElement {
  const [asked, got] = [swatch("asked"), swatch("got")];
  const difference = el("span.quiet", { title: "Of the two, in CIEDE2000: below 1 hardly anybody sees it" });
  const keep = el("input", { type: "checkbox", name: "keep", onchange: () => actions.loosen(!keep.checked) });
  const outcome = el("p.note", { role: "status" });
  const letGo = iconButton("close", "Let the body colour go", () => actions.ask(BODY, null));
  const element = el(
    "div.answer",
    el("div.line", asked.element, got.element, difference, letGo),
    el("label.line", { title: KEEP }, keep, "keep the highlight"),
    outcome,
  );
  store.watch(["asked", "numbers", "counting"], (state) => {
    const wanted = state.asked?.set[BODY];
    element.hidden = typeof wanted !== "string";
    if (typeof wanted !== "string") return;
    asked.show(wanted);
    element.classList.toggle("behind", state.counting);
    keep.checked = !state.asked!.loose;
    const { numbers } = state;
    // Until it has come, the one before is shown.
    if (numbers === null || numbers.difference === null) return;
    got.show(numbers.body);
    difference.textContent = `ΔE ${numbers.difference.toFixed(1)}`;
    outcome.textContent = state.counting ? "Finding it …" : inWords(state.asked!, numbers);
  });
  return element;
}

function swatch(name: string) {
  const [colour, value] = [el("i"), el("span")];
  const show = (hex: string) => {
    colour.style.background = hex;
    value.textContent = hex;
  };
  return { element: el("span.line.swatch", colour, `${name} `, value), show };
}

/** Which material it is, and what of the highlight went with the colour. */
function inWords({ set, loose }: Asked, numbers: FoundView): string {
  const isHeld = !loose && !HIGHLIGHT.some((name) => name in set);
  const lost = givenUp(numbers);
  const went = lost && (loose ? `The highlight was let go: ${lost}.` : `Given up: ${lost}.`);
  if (numbers.difference! > UNSEEN) return `No mix has it: this is the nearest. ${went}`;
  if (bodyScale(numbers.recipe))
    return `No mix has it and keeps the highlight: the body alone is scaled. ${went}`;
  return went || (isHeld ? "A mix has it, and keeps the highlight." : "A mix has it.");
}
