// The line between two materials in one picture: the present one to the left, the compared one to the right.

import { comparedKept, comparedSpace, comparedStop } from "../../compared";
import type { Context } from "../../context";
import { el } from "../../dom";
import { clamp } from "../../numbers";
import { shortName } from "../../title";

const STEP = 0.02;
/** The line stays that far from the edges. */
const EDGE = 0.03;

export function splitHandle({ store }: Context): HTMLElement {
  const [left, right] = [el("span.tag.cut"), el("span.tag.cut")];
  const move = (split: number) => store.set({ split: clamp(split, EDGE, 1 - EDGE) });
  const handle = el("div.split", {
    role: "slider",
    tabindex: 0,
    "aria-label": "Split between the two materials",
    "aria-valuemin": 0,
    "aria-valuemax": 100,
    onpointerdown: (event) => handle.setPointerCapture(event.pointerId),
    onpointermove: (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const box = handle.parentElement!.getBoundingClientRect();
      move((event.clientX - box.left) / box.width);
    },
    onkeydown: (event) => {
      if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
      event.preventDefault();
      event.stopPropagation();
      move(store.get().split + (event.key === "ArrowRight" ? STEP : -STEP));
    },
  });
  handle.append(left, right);
  store.watch(["space", "compare", "split", "held", "kept", "recipe"], (state) => {
    const { space, compare, split, kept } = state;
    handle.hidden = compare === "";
    left.textContent = comparedSpace(compare) === null ? shortName(state) : space;
    right.textContent = comparedKept({ compare, kept })?.name ?? comparedStop(compare) ?? compare;
    handle.style.setProperty("--split", String(split));
    handle.setAttribute("aria-valuenow", String(Math.round(100 * split)));
  });
  return handle;
}
