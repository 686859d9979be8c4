// Small pictures along t, ticks where the recipe changes its simplex, and a range input on top. With a second row for the
// space that is compared.

import type { Context } from "../../context";
import { el, onResize, style } from "../../dom";
import { type Route, recipeAt } from "../../route";
import { comparedSpace } from "../../state";

/** Of a row, in CSS pixels: a picture, and the ticks below it. */
const SIDE = 58;
const FOOT = 9;
/** Room for a picture, as a share of its width. */
const PITCH = 1.07;

export function strip(context: Context): HTMLElement {
  const { store } = context;
  const canvas = el("canvas", { "aria-hidden": "true" });
  const names = el("div.names");
  const element = el("div.strip", canvas, names, ...slider(context));
  const draw = () => drawRows(context, canvas);
  onResize(element, (width, height) => {
    canvas.width = width;
    canvas.height = height;
    draw();
  });
  store.watch(["route", "otherRoute", "scheme"], draw);
  store.watch(["atPoint"], ({ atPoint }) => element.classList.toggle("away", atPoint !== null));
  store.watch(["space", "compare"], ({ space, compare }) => {
    const other = comparedSpace(compare);
    const rows = other === null ? [] : [space, other];
    names.replaceChildren(...rows.map((name) => el("span", name)));
    element.style.height = `${(SIDE + FOOT) * Math.max(1, rows.length)}px`;
  });
  return element;
}

/** The input, and where it is. */
function slider({ store, actions }: Context): HTMLElement[] {
  const playhead = el("div.playhead");
  const input = el("input", {
    name: "t",
    type: "range",
    min: 0,
    max: 1,
    step: 0.001,
    "aria-label": "Position t on the route",
    oninput: () => {
      store.set({ playing: false });
      actions.setT(Number(input.value));
    },
  });
  store.watch(["t"], ({ t }) => {
    input.value = String(t);
    // The middle of a range input's thumb stays half a thumb away from the ends.
    playhead.style.left = `calc(${SIDE / 2}px + ${t} * (100% - ${SIDE}px))`;
  });
  return [input, playhead];
}

function drawRows(context: Context, canvas: HTMLCanvasElement): void {
  const pen = canvas.getContext("2d")!;
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = canvas.width / Math.max(width, 1);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.imageSmoothingQuality = "high";
  const { route, otherRoute } = context.store.get();
  [route, otherRoute].forEach((each, row) => {
    if (each === null) return;
    drawPictures(context, pen, each, width, row * (SIDE + FOOT));
    drawTicks(context, pen, each, width, (row + 1) * (SIDE + FOOT));
  });
}

/** Where t is, from left to right. */
function toX(t: number, width: number): number {
  return SIDE / 2 + t * (width - SIDE);
}

function drawPictures(
  { thumbnails }: Context,
  pen: CanvasRenderingContext2D,
  route: Route,
  width: number,
  top: number,
): void {
  const cell = new OffscreenCanvas(thumbnails.size, thumbnails.size);
  const last = Math.max(1, Math.floor((width - SIDE) / (SIDE * PITCH)));
  for (let i = 0; i <= last; i++) {
    const t = i / last;
    cell.getContext("2d")!.putImageData(thumbnails.picture(recipeAt(route, t)), 0, 0);
    pen.drawImage(cell, toX(t, width) - SIDE / 2, top, SIDE, SIDE);
  }
}

function drawTicks(
  { root }: Context,
  pen: CanvasRenderingContext2D,
  { crossings, stops }: Route,
  width: number,
  bottom: number,
): void {
  const ticks = (ts: readonly number[], wide: number, high: number, colour: string) => {
    pen.fillStyle = style(root, colour);
    for (const t of ts) pen.fillRect(toX(t, width) - wide / 2, bottom - high, wide, high);
  };
  pen.fillStyle = style(root, "--line");
  pen.fillRect(toX(0, width), bottom - 1, width - SIDE, 1);
  ticks(crossings, 1, 4, "--quiet");
  ticks(stops, 2, 7, "--text");
}
