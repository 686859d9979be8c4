// Small pictures along t, ticks where the recipe changes its simplex, and a range input on top. With a second row for the
// space that is compared.

import type { RouteView } from "../api/schema";
import type { Context } from "../context";
import { el, onResize, style } from "../dom";
import { recipeAt } from "../recipe";
import { comparedStop } from "../state";

/** Of a row, in CSS pixels: a picture, and the ticks below it. */
const SIDE = 58;
const FOOT = 9;

export function strip({ root, store, actions, thumbnails }: Context): HTMLElement {
  const canvas = el("canvas", { "aria-hidden": "true" });
  const head = el("div.playhead");
  const names = el("div.names");
  const input = el(
    "input",
    { name: "t", type: "range", min: 0, max: 1, step: 0.001, "aria-label": "Position t on the route" },
    {
      oninput: () => {
        store.set({ playing: false });
        actions.setT(Number(input.value));
      },
    },
  );
  const element = el("div.strip", {}, {}, canvas, names, input, head);
  store.watch(
    ({ t }) => t,
    (t) => {
      input.value = String(t);
      // The middle of a range input's thumb stays half a thumb away from the ends.
      head.style.left = `calc(${SIDE / 2}px + ${t} * (100% - ${SIDE}px))`;
    },
  );
  store.watch(
    ({ place }) => place !== null,
    (away) => element.classList.toggle("away", away),
  );
  const cell = document.createElement("canvas");
  cell.width = cell.height = thumbnails.size;
  const pen = cell.getContext("2d")!;
  const context = canvas.getContext("2d")!;
  const draw = () => {
    const { route, otherRoute } = store.get();
    const ratio = canvas.width / Math.max(canvas.clientWidth, 1);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    context.imageSmoothingQuality = "high";
    [route, otherRoute].forEach((each, row) => {
      if (each) drawRow(each, canvas.clientWidth, row * (SIDE + FOOT));
    });
  };
  const drawRow = (route: RouteView, width: number, top: number) => {
    const count = Math.max(2, Math.floor((width - SIDE) / (SIDE * 1.07)) + 1);
    const at = (t: number) => SIDE / 2 + t * (width - SIDE);
    for (let i = 0; i < count; i++) {
      const t = i / (count - 1);
      pen.putImageData(thumbnails.picture(recipeAt(route, t)), 0, 0);
      context.drawImage(cell, at(t) - SIDE / 2, top, SIDE, SIDE);
    }
    const bottom = top + SIDE + FOOT;
    context.fillStyle = style(root, "--line");
    context.fillRect(at(0), bottom - 1, width - SIDE, 1);
    context.fillStyle = style(root, "--quiet");
    for (const t of route.crossings) context.fillRect(at(t) - 0.5, bottom - 4, 1, 4);
    context.fillStyle = style(root, "--text");
    for (const t of route.stop_t) context.fillRect(at(t) - 1, bottom - 7, 2, 7);
  };
  onResize(element, (width, height) => {
    canvas.width = width;
    canvas.height = height;
    draw();
  });
  store.watch(({ route, otherRoute, scheme }) => [route, otherRoute, scheme], draw);
  store.watch(
    ({ space, compare }) => [space, compare] as const,
    ([space, compare]) => {
      const rows = compare === "" || comparedStop(compare) !== null ? [] : [space, compare];
      names.replaceChildren(...rows.map((name) => el("span", {}, {}, name)));
      element.style.height = `${(SIDE + FOOT) * Math.max(1, rows.length)}px`;
    },
  );
  return element;
}
