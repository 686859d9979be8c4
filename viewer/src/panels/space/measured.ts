// Materials by what instruments read off them: the map whose axes a person chooses, and colours that stand for a number.

import type { AttributeView, EmbeddingView } from "../../api/schema";
import { inDigits, LABELS } from "../../asked";
import type { Context } from "../../context";
import { dropdown, el } from "../../dom";
import { GRID, NUMBERS, type State } from "../../state";
import { legendOf, STOPS } from "../../tint";

const AS_THEY_LOOK = "as they look";

/** The materials as points whose coordinates are attributes; a material that has no such number stands at the most. */
export function byNumbers(attributes: readonly AttributeView[], axes: State["axes"]): EmbeddingView {
  const chosen = axes.flatMap((name) => attributes.find((each) => each.name === name) ?? []);
  const columns = chosen.map(({ values }) => {
    const most = Math.max(...values.map((value) => value ?? Number.NEGATIVE_INFINITY));
    return values.map((value) => value ?? most);
  });
  return {
    name: NUMBERS,
    channel: "all",
    axes: chosen.map(called),
    points: (columns[0] ?? []).map((_, i) => columns.map((column) => column[i]!)),
    edges: [],
  };
}

/** Where a material with these numbers is among them; null where it has not all. */
export function pointBy(
  has: Readonly<Record<string, number | null>>,
  axes: State["axes"],
): readonly number[] | null {
  const point = axes.map((name) => has[name]);
  return point.every((x) => typeof x === "number") ? point : null;
}

function called({ name, label, unit }: AttributeView): string {
  const short = LABELS[name] ?? label;
  return unit ? `${short} (${unit})` : short;
}

/** Which numbers the axes are, and which the colours; with what the colours stand for. */
export function numberChoices({ store }: Context): HTMLElement {
  const element = el("div.line.wrap.measures");
  const legend = el("div.legend", { role: "img" });
  store.watch(["attributes"], ({ attributes }) => {
    if (attributes === null) return;
    const options = attributes.map((each) => [each.name, called(each)] as const);
    const axes = store.get().axes.map((name, i) => {
      const label = `Axis ${i + 1}`;
      const select = dropdown(
        { name: `axis-${i + 1}`, "aria-label": label, title: label },
        options,
        (chosen) => store.set({ axes: store.get().axes.with(i, chosen) as unknown as State["axes"] }),
      );
      select.value = name;
      return select;
    });
    const tint = dropdown(
      { name: "tint", "aria-label": "Colour" },
      [["", AS_THEY_LOOK], ...options],
      (chosen) => store.set({ tint: chosen }),
    );
    tint.value = store.get().tint;
    element.replaceChildren(...axes, el("span.line", el("label.line", "colour", tint), legend));
  });
  store.watch(["map"], ({ map }) => {
    element.hidden = map === GRID;
    element.classList.toggle("axes", map === NUMBERS);
  });
  store.watch(["tint", "attributes"], ({ tint, attributes }) => {
    const shown = attributes?.find(({ name }) => name === tint);
    legend.hidden = shown === undefined;
    if (!shown) return;
    legend.setAttribute("aria-label", `Colours stand for ${called(shown)}`);
    legend.replaceChildren(bar(), ...legendOf(shown).map((value) => el("span", inDigits(value))));
  });
  return element;
}

function bar(): HTMLElement {
  const element = el("i");
  element.style.background = `linear-gradient(to right, ${STOPS.map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;
  return element;
}
