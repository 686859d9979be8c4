// A number as a slider and a field: a value that is moved, or written, is asked for until it is let go.

import { inDigits, type sliderOf } from "../../asked";
import type { Context } from "../../context";
import { el, iconButton } from "../../dom";

export interface Dialled {
  readonly name: string;
  readonly label: string;
  /** What it is in full. */
  readonly title: string;
  readonly slider: ReturnType<typeof sliderOf>;
  /** What stands beside the number. */
  readonly beside?: HTMLElement;
}

export interface Dial {
  readonly element: HTMLElement;
  /** Whether it can be asked for now, what it has, and what is asked for. */
  readonly show: (isKnown: boolean, has: number | null, wanted: number | null) => void;
  /** How far it goes with the others held; null where nobody knows. */
  readonly reach: (ends: readonly [number, number] | null) => void;
}

export function dial({ actions }: Context, { name, label, title, slider, beside }: Dialled): Dial {
  const { toShare, toValue } = slider;
  const ask = (value: number) => actions.ask(name, Number(value.toPrecision(4)));
  const free = () => actions.ask(name, null);
  const range = el("input", {
    type: "range",
    min: 0,
    max: 1,
    step: 0.001,
    "aria-label": title,
    title: "Double click: let it go",
    oninput: () => ask(toValue(Number(range.value))),
    ondblclick: free,
  });
  const value = el("input.field", {
    type: "number",
    name,
    step: "any",
    "aria-label": `${title}, as a number`,
    onchange: () => (Number.isFinite(value.valueAsNumber) ? ask(value.valueAsNumber) : free()),
  });
  const reached = el("i.reach");
  const release = iconButton("close", `Let ${title} go`, free);
  const element = el(
    "li",
    { title },
    el("span.cut", label),
    el("span.track", reached, range),
    value,
    ...(beside ? [beside] : []),
    release,
  );
  return {
    element,
    show: (isKnown, has, wanted) => {
      element.dataset.asked = String(wanted !== null);
      release.disabled = wanted === null;
      range.disabled = value.disabled = !isKnown;
      const shown = wanted ?? has;
      range.value = String(shown === null ? 0 : toShare(shown));
      if (!value.matches(":focus") || wanted !== null) value.value = shown === null ? "" : inDigits(shown);
    },
    reach: (ends) => {
      reached.hidden = ends === null;
      if (ends === null) return;
      reached.style.left = `${100 * toShare(ends[0])}%`;
      reached.style.right = `${100 * (1 - toShare(ends[1]))}%`;
    },
  };
}
