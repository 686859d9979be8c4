// Small pictures along t, ticks where the recipe changes its simplex, and a range input on top. With a second row for the
// space that is compared.

import { comparedSpace } from "../../compared";
import type { Context } from "../../context";
import { el, onResize, style } from "../../dom";
import { type Route, recipeAt } from "../../route";
import { isAway } from "../../shown";

/**
 * Of the strip, in CSS pixels, however many rows it has; and of the ticks below each, with the names of several. Its height, and
 * that of a name, is in the style sheet, too.
 */
const HEIGHT = 68;
const FOOT = 8;
const NAME = 13;
/** Of the slider's thumb: as wide as a picture where there is one row. */
const THUMB = HEIGHT - FOOT;
/** Room for a picture, as a share of its width. */
const PITCH = 1.07;

export function strip(context: Context): HTMLElement {
  const { store } = context;
  const canvas = el("canvas", { "aria-hidden": "true" });
  const names = el("div.names");
  const element = el("div.strip", canvas, names, ...slider(context));
  const draw = () => drawRows(context, canvas, draw);
  onResize(element, (width, height) => {
    canvas.width = width;
    canvas.height = height;
    draw();
  });
  store.watch(["route", "otherRoute", "scheme", "pictured"], draw);
  store.watch(["atPoint", "held"], (state) => element.classList.toggle("away", isAway(state)));
  store.watch(["space", "compare"], ({ space, compare }) => {
    const other = comparedSpace(compare);
    const rows = other === null ? [] : [space, other];
    names.replaceChildren(...rows.map((name) => el("span", name)));
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
    playhead.style.left = `calc(${THUMB / 2}px + ${t} * (100% - ${THUMB}px))`;
  });
  return [input, playhead];
}

/** `again` runs when pictures have come that were missing. */
function drawRows(context: Context, canvas: HTMLCanvasElement, again: () => void): void {
  const pen = canvas.getContext("2d")!;
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = canvas.width / Math.max(width, 1);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.imageSmoothingQuality = "high";
  const { route, otherRoute } = context.store.get();
  const routes = [route, otherRoute].filter((each) => each !== null);
  const high = HEIGHT / Math.max(routes.length, 1);
  const side = high - (routes.length > 1 ? NAME : FOOT);
  routes.forEach((each, row) => {
    drawPictures(context, pen, each, again, { width, top: row * high, side });
    drawTicks(context, pen, each, width, (row + 1) * high);
  });
}

/** Where t is, from left to right. */
function toX(t: number, width: number): number {
  return THUMB / 2 + t * (width - THUMB);
}

function drawPictures(
  { thumbnails }: Context,
  pen: CanvasRenderingContext2D,
  route: Route,
  again: () => void,
  { width, top, side }: { readonly width: number; readonly top: number; readonly side: number },
): void {
  const cell = new OffscreenCanvas(thumbnails.size, thumbnails.size);
  const last = Math.max(1, Math.floor((width - THUMB) / (side * PITCH)));
  for (let i = 0; i <= last; i++) {
    const t = i / last;
    cell.getContext("2d")!.putImageData(thumbnails.picture(recipeAt(route, t), route, again), 0, 0);
    pen.drawImage(cell, toX(t, width) - side / 2, top, side, side);
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
  pen.fillRect(toX(0, width), bottom - 1, width - THUMB, 1);
  ticks(crossings, 1, 4, "--quiet");
  ticks(stops, 2, 7, "--text");
}
