// What instruments would read off the material, as sliders: a number that is moved, or written, is asked for until it is let go.

import type { AttributeView, FoundView } from "../../api/schema";
import {
  type Asked,
  BODY,
  called,
  givenUp,
  inDigits,
  LABELS,
  numberIn,
  sliderOf,
  written,
} from "../../asked";
import type { Context } from "../../context";
import { el } from "../../dom";
import { SLIDERS } from "../../measuring";
import { dial } from "./dial";
import { perceivedNumbers } from "./perceived";

export function numberSliders(context: Context): HTMLElement {
  const { store } = context;
  const list = el("ul.dials", { "aria-label": "Numbers" });
  const note = el("p.note.missing", { role: "status" });
  const element = el("div.numbers", list, perceivedNumbers(context), note);
  store.watch(["attributes"], ({ attributes }) => {
    const dials = SLIDERS.flatMap((name) => attributes?.find((each) => each.name === name) ?? []);
    list.replaceChildren(...dials.map((attribute) => numberDial(context, attribute)));
    if (attributes === null) list.append(el("li.note", "Reading the materials …"));
  });
  store.watch(["asked", "numbers", "counting"], ({ asked, numbers, counting }) => {
    element.classList.toggle("behind", counting);
    const names = asked && numbers ? numbers.missed.filter((name) => name in asked.set) : [];
    note.classList.toggle("problem", !counting && names.length > 0);
    if (counting) note.textContent = asked ? "Finding it …" : "";
    else if (names.length > 0)
      note.textContent = `No mix has all of these: ${inWords(names, asked!, numbers!)}.`;
    else note.textContent = asked && numbers ? priceOf(asked, numbers) : "";
    note.title = note.textContent ?? "";
  });
  return element;
}

/** What else had to change; beside a body colour that is said there. */
function priceOf({ set }: Asked, numbers: FoundView): string {
  const lost = givenUp(numbers);
  return lost && !(BODY in set) ? `Given up: ${lost}.` : "";
}

function inWords(names: readonly string[], { set }: Asked, { attributes }: FoundView): string {
  const one = (name: string) => {
    const has = attributes[name];
    return `${called(name)} ${typeof has === "number" ? inDigits(has) : "none"}, not ${written(set[name]!)}`;
  };
  return names.map(one).join(", ");
}

/** One number: where it is, how far it goes with the others held, and whether it is asked for. */
function numberDial(context: Context, { name, label, unit, values }: AttributeView): HTMLElement {
  const title = `${label}${unit ? `, ${unit}` : ""}`;
  const { element, show, reach } = dial(context, {
    name,
    label: LABELS[name] ?? label,
    title,
    slider: sliderOf(values),
  });
  context.store.watch(["asked", "numbers", "counting"], ({ asked, numbers, counting }) => {
    show(numbers !== null, numbers?.attributes[name] ?? null, numberIn(asked, name));
    // While it moves, the ends are those of before; where no mix has the others, it goes nowhere.
    const ends = numbers?.ranges[name];
    if (ends || !counting) reach(ends ?? null);
  });
  return element;
}
