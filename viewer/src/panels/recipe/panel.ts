// The recipe: what the material is made of, and taking it home.

import { bodyScale } from "../../blend";
import type { Context } from "../../context";
import { el, segments } from "../../dom";
import { CHANNELS, type Ingredient, meanWeight } from "../../recipe";
import { mixingOf } from "../../shown";
import { ASIDES } from "../../state";
import { notices } from "../notices";
import { bodyColour } from "./body";
import { exports } from "./exports";
import { numberSliders } from "./numbers";

const COLOURS = ["red", "green", "blue"];

export function recipePanel(context: Context): HTMLElement {
  const list = el("ol", { tabindex: 0, "aria-label": "Materials" });
  const note = el("p.cut.note");
  const rows = new Map<string, HTMLLIElement>();
  const body = el("p.note.scaled");
  context.store.watch(["recipe"], (state) => {
    const { recipe } = state;
    const scale = bodyScale(mixingOf(state));
    body.hidden = scale === null;
    body.textContent = scale && `Its body alone: ${inWords(scale)}`;
    const ordered = [...recipe].sort((a, b) => meanWeight(b) - meanWeight(a));
    const items = ordered.map((ingredient) => {
      const row = rows.get(ingredient.name) ?? newRow(context, ingredient.name);
      rows.set(ingredient.name, row);
      fill(row, ingredient);
      return row;
    });
    if (items.some((item, i) => list.children[i] !== item) || list.children.length !== items.length)
      list.replaceChildren(...items);
    const many = recipe.length ? `${recipe.length} materials` : "";
    note.textContent = recipe.length === 1 && !scale ? "one material" : many;
  });
  const [numbers, aside] = [numberSliders(context), asideChoice(context)];
  context.store.watch(["aside"], ({ aside }) => {
    list.hidden = aside !== "weights";
    note.hidden = list.hidden;
    numbers.hidden = aside !== "numbers";
  });
  return el(
    "section.panel.recipe",
    { "aria-label": "Recipe" },
    el("div.line.titled", el("h2", "Recipe"), note, aside),
    list,
    numbers,
    body,
    bodyColour(context),
    exports(context),
    notices(context, "recipe"),
  );
}

/** What the body is multiplied by. */
function inWords(scale: readonly number[]): string {
  return scale.map((factor, c) => `${COLOURS[c]} × ${factor.toPrecision(2)}`).join(", ");
}

/** Its weights, or its numbers; those take somebody who finds recipes by them. */
function asideChoice({ client, store }: Context): HTMLElement {
  const { element, mark } = segments(
    "Recipe as",
    ASIDES.map((aside) => [aside] as const),
    (aside) => store.set({ aside }),
  );
  store.watch(["aside"], ({ aside }) => mark(aside));
  element.hidden = client.find === undefined;
  return element;
}

function newRow({ store, thumbnails }: Context, name: string): HTMLLIElement {
  return el(
    "li",
    {
      onpointerenter: () => store.set({ hovered: name }),
      onpointerleave: () => store.set({ hovered: null }),
    },
    thumbnails.canvas(name),
    el("span.cut.name", { title: name }, name),
    el("span.quiet.share"),
    el("span.bars", ...CHANNELS.map((channel) => el(`i.${channel}`))),
  );
}

function fill(row: HTMLLIElement, { weight }: Ingredient): void {
  const same = weight[0] === weight[1] && weight[1] === weight[2];
  const bars = row.querySelector<HTMLElement>(".bars")!;
  bars.className = same ? "bars same" : "bars";
  CHANNELS.forEach((_, c) => {
    const bar = bars.children[c] as HTMLElement;
    bar.hidden = same && c > 0;
    bar.style.transform = `scaleX(${weight[c]})`;
  });
  const percent = (w: number) => (w === 0 ? "0" : w < 0.005 ? "<1" : String(Math.round(100 * w)));
  const shares = same ? percent(weight[0]) : weight.map(percent).join(" · ");
  row.querySelector(".share")!.textContent = `${shares} %`;
}
