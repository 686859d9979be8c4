// Without WebGL2: the small pictures, mixed on the processor.

import type { Context } from "../../context";
import { el } from "../../dom";
import { mixingOf } from "../../shown";

export function stillPictures(
  { store, thumbnails }: Context,
  panel: HTMLElement,
  area: HTMLElement,
  reason: string,
): void {
  const canvas = el("canvas.view.still", { width: thumbnails.size, height: thumbnails.size });
  area.prepend(canvas);
  const text = `A small picture stands in for the live one. ${reason}`;
  panel.append(el("p.reason.note", { role: "status" }, text));
  for (const part of panel.querySelectorAll(".bottom, .split")) part.remove();
  const draw = () => {
    const state = store.get();
    const { recipe, pictured } = state;
    if (recipe.length === 0 || !pictured) return;
    canvas.getContext("2d")!.putImageData(thumbnails.picture(recipe, mixingOf(state), draw), 0, 0);
    panel.dataset.ready = "still";
  };
  store.watch(["recipe", "pictured"], draw);
}
