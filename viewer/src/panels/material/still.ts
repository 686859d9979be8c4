// Without WebGL2: the small pictures, mixed on the processor.

import type { Context } from "../../context";
import { el } from "../../dom";

export function stillPictures({ store, thumbnails }: Context, panel: HTMLElement, reason: string): void {
  const canvas = el("canvas.view.still", { width: thumbnails.size, height: thumbnails.size });
  const text = `A small picture stands in for the live one. ${reason}`;
  panel.prepend(canvas, el("p.tag.reason", { role: "status" }, text));
  for (const part of panel.querySelectorAll(".overlay.bottom, .split")) part.remove();
  store.watch(["recipe"], ({ recipe }) => {
    if (recipe.length === 0) return;
    canvas.getContext("2d")!.putImageData(thumbnails.picture(recipe), 0, 0);
    panel.dataset.ready = "still";
  });
}
