// The keys, and what the words mean.

import { el, iconButton, popover } from "../dom";

const KEYS: readonly (readonly [keys: string, what: string])[] = [
  ["/", "search; arrows choose, Enter takes, Escape leaves"],
  ["← →", "t by .01; with Shift by .1"],
  ["Home, End", "the first, the last stop"],
  ["Space", "play, and stop"],
  ["P", "pin what is shown to the shortlist"],
  ["Ctrl Z, Ctrl Shift Z", "undo, redo"],
  ["Alt and an arrow", "turn the object or the space; move the stop that has the focus"],
  ["arrows, on the dot in the space", "leave the route"],
  ["?", "this"],
];

const WORDS: readonly (readonly [word: string, meaning: string])[] = [
  [
    "space",
    "where each material is a point. The anchored one keeps colours straight, the paper's follows its scores, the linear one knows the ends alone",
  ],
  ["route, stops", "a way through two or more materials"],
  ["t", "where on the route: 0 at the first stop, 1 at the last"],
  [
    "pace",
    "how t is spaced: equal steps to the eye (perceptual), steps that people would call equal, by a distance that was fitted to their answers (people), or as the paper has it (uniform)",
  ],
  [
    "like",
    "search for like chrome, or red like chrome: the materials that people find most alike come first, by the same distance",
  ],
  ["recipe", "which materials, and how much of each: the weights are never negative and sum to 1"],
  [
    "blend",
    "how weighted materials become one: their tables added up (linear), their square roots or logarithms (root, log), or with one highlight that narrows (lobes)",
  ],
  [
    "score",
    "how far a material goes along a principal component of the library: what differs most comes first",
  ],
];

/** A window with keys and words; `?` opens it, too. */
export function helpButton(): HTMLElement {
  const rows = (list: readonly (readonly [string, string])[]) =>
    el("dl", ...list.flatMap(([term, text]) => [el("dt", term), el("dd", text)]));
  const form = popover("Keys", rows(KEYS), el("h2", "Words"), rows(WORDS));
  form.classList.add("help");
  const open = iconButton("help", "Keys and words (?)", () => form.togglePopover());
  return el("div", open, form);
}
