// The shortlist: what a person kept, as a row of spheres to look at, to compare, to name and to take home.

import { asComparedKept } from "../../compared";
import type { Context } from "../../context";
import { el, iconButton, popover } from "../../dom";
import { toHash } from "../../permalink";
import { type Kept, keptOf, missingIn, recipeOf } from "../../shortlist";
import { shownDocument } from "../../shown";
import { shortName } from "../../title";
import { takeAll } from "./take";

/** What to do first, until something is kept. */
const STEPS = [
  ["1", "Drag along the row of spheres: the material changes, with its exact table."],
  [
    "2",
    "Click a material in the space, or search: it replaces the stop with the ring. Or drop a measurement in.",
  ],
  ["3", "Pin what you like here, compare any two, take them home: Blender, Mitsuba, USD, pbrt."],
] as const;

export function shortlistPanel(context: Context): HTMLElement {
  const { store } = context;
  const list = el("ol.line.kept", { tabindex: 0, "aria-label": "Kept materials" });
  const pin = el(
    "button.button",
    { type: "button", title: "Keep what is shown (P)", onclick: () => keepShown(context) },
    "Pin",
  );
  const take = takeAll(context);
  store.watch(["kept", "held", "compare", "pictured"], (state) => {
    const items = state.kept.map((each) => item(context, each));
    const steps = STEPS.map(([number, text]) => el("li.step", el("b", number), text));
    list.replaceChildren(...(items.length ? items : steps));
    take.hidden = items.length === 0;
  });
  store.watch(["recipe"], ({ recipe }) => {
    pin.disabled = recipe.length === 0;
  });
  return el(
    "section.panel.shortlist",
    { "aria-label": "Shortlist" },
    el("div.line.titled", el("h2", "Shortlist"), pin),
    list,
    take,
  );
}

/** Keep what is shown, where it was. */
export function keepShown({ store, actions }: Context): void {
  const state = store.get();
  if (state.recipe.length === 0) return;
  actions.keep(keptOf(shortName(state), shownDocument(state), toHash(state)));
}

function item(context: Context, kept: Kept): HTMLElement {
  const { store, actions, thumbnails } = context;
  const { held, compare, pictured } = store.get();
  const picture = el("canvas.sphere", { width: thumbnails.size, height: thumbnails.size });
  const draw = () =>
    picture.getContext("2d")!.putImageData(thumbnails.picture(recipeOf(kept), kept.recipe, draw), 0, 0);
  if (pictured) draw();
  const missing = missingIn(kept.recipe, context.names);
  const needs = `It needs ${missing.join(", ")}: drop the file here again.`;
  const show = el(
    "button",
    {
      type: "button",
      disabled: missing.length > 0,
      title: missing.length ? needs : kept.note ? `${kept.name}: ${kept.note}` : kept.name,
      "aria-pressed": String(held?.id === kept.id),
      onclick: () => actions.hold(kept),
    },
    picture,
    el("span.cut.name", kept.name),
  );
  const isBeside = compare === asComparedKept(kept);
  const beside = el(
    "button.beside",
    {
      type: "button",
      disabled: missing.length > 0,
      title: `Compare with ${kept.name}`,
      "aria-pressed": String(isBeside),
      onclick: () => actions.compareWith(isBeside ? "" : asComparedKept(kept)),
    },
    "A|B",
  );
  const more = iconButton("more", `Name, note, order of ${kept.name}`, () => change(context, kept));
  return el("li", show, el("div.line", beside, more));
}

/** Its name, its note, its place in the row, and away with it. */
function change({ root, actions }: Context, kept: Kept): void {
  const name = el("input.field", { type: "text", name: "name", value: kept.name });
  const note = el("input.field", { type: "text", name: "note", value: kept.note, placeholder: "what for" });
  const button = (text: string, act: () => void = () => {}) => {
    const onclick = () => {
      form.hidePopover();
      act();
    };
    return el("button.button", { type: "button", onclick }, text);
  };
  const form = popover(
    "Kept material",
    el("label.line.choice", "Name", name),
    el("label.line.choice", "Note", note),
    el(
      "div.line.wrap",
      button("Earlier", () => actions.moveKept(kept.id, -1)),
      button("Later", () => actions.moveKept(kept.id, 1)),
      button("Delete", () => actions.changeKept(kept.id, null)),
      button("Done"),
    ),
  );
  form.addEventListener("beforetoggle", ({ newState }) => {
    if (newState === "open") return;
    actions.changeKept(kept.id, { name: name.value.trim() || kept.name, note: note.value.trim() });
  });
  form.addEventListener("toggle", ({ newState }) => newState === "closed" && form.remove());
  root.append(form);
  form.showPopover();
  name.select();
}
