// What instruments would read off the material, as sliders: a number that is moved, or written, is asked for until it is let go.

import type { AttributeView, FoundView } from "../../api/schema";
import { type Asked, BODY, givenUp, inDigits, LABELS, missed, sliderOf, written } from "../../asked";
import type { Context } from "../../context";
import { el, iconButton } from "../../dom";
import { SLIDERS } from "../../measuring";
import { perceivedNumbers } from "./perceived";

export function numberSliders(context: Context): HTMLElement {
  const { store } = context;
  const list = el("ul.dials", { "aria-label": "Numbers" });
  const note = el("p.note.missing", { role: "status" });
  const element = el("div.numbers", list, perceivedNumbers(context), note);
  store.watch(["attributes"], ({ attributes }) => {
    const dials = SLIDERS.flatMap((name) => attributes?.find((each) => each.name === name) ?? []);
    list.replaceChildren(...dials.map((attribute) => dial(context, attribute)));
    if (attributes === null) list.append(el("li.note", "Reading the materials …"));
  });
  store.watch(["asked", "numbers", "counting"], ({ asked, numbers, counting, attributes }) => {
    element.classList.toggle("behind", counting);
    const names = asked && numbers ? missed(asked.set, numbers.attributes, attributes ?? []) : [];
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
    return `${LABELS[name] ?? name} ${typeof has === "number" ? inDigits(has) : "none"}, not ${written(set[name]!)}`;
  };
  return names.map(one).join(", ");
}

/** One number: where it is, how far it goes with the others held, and whether it is asked for. */
function dial({ store, actions }: Context, { name, label, unit, values }: AttributeView): HTMLElement {
  const { toShare, toValue } = sliderOf(values);
  const title = `${label}${unit ? `, ${unit}` : ""}`;
  const ask = (value: number) => actions.ask(name, Number(value.toPrecision(4)));
  const free = () => actions.ask(name, null);
  const slider = el("input", {
    type: "range",
    min: 0,
    max: 1,
    step: 0.001,
    "aria-label": title,
    title: "Double click: let it go",
    oninput: () => ask(toValue(Number(slider.value))),
    ondblclick: free,
  });
  const value = el("input.field", {
    type: "number",
    name,
    step: "any",
    "aria-label": `${title}, as a number`,
    onchange: () => (Number.isFinite(value.valueAsNumber) ? ask(value.valueAsNumber) : free()),
  });
  const reach = el("i.reach");
  const release = iconButton("close", `Let ${title} go`, free);
  const row = el(
    "li",
    { title },
    el("span.cut", LABELS[name] ?? label),
    el("span.track", reach, slider),
    value,
    release,
  );
  store.watch(["asked", "numbers", "counting"], ({ asked, numbers, counting }) => {
    const wanted = asked?.set[name];
    const has = numbers?.attributes[name];
    row.dataset.asked = String(wanted !== undefined);
    release.disabled = wanted === undefined;
    slider.disabled = value.disabled = numbers === null;
    const shown = wanted ?? has;
    const isKnown = typeof shown === "number";
    slider.value = String(isKnown ? toShare(shown) : 0);
    if (!value.matches(":focus") || wanted !== undefined) value.value = isKnown ? inDigits(shown) : "";
    const ends = numbers?.ranges[name];
    // While it moves, the ends are those of before; where no mix has the others, it goes nowhere.
    reach.hidden = !ends && !counting;
    if (ends) {
      reach.style.left = `${100 * toShare(ends[0])}%`;
      reach.style.right = `${100 * (1 - toShare(ends[1]))}%`;
    }
  });
  return row;
}
