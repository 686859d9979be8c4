// The BRDF itself: polar lobes for a light direction, a slice of the table, or the albedo, with the numbers under the pointer.

import type { Axis } from "../../api/schema";
import type { Context } from "../../context";
import { el, onResize, segments, style } from "../../dom";
import { paced } from "../../render/loop";
import { albedo } from "./albedo";
import { lobes } from "./lobes";
import { type Pen, type Plot, type Reading, SCALES, type Scale, short } from "./plot";
import { Samples } from "./samples";
import { slice } from "./slice";

type View = "lobes" | "slice" | "albedo";

/** Milliseconds that the samples may take before the page has its turn. */
const PATIENCE = 24;
/** Milliseconds between drawings: the picture of the material comes first. */
const BESIDE = 60;
const ANGLES: Record<View, { readonly name: readonly [string, string]; readonly max: number } | null> = {
  lobes: { name: ["θ", "i"], max: 85 },
  slice: { name: ["φ", "d"], max: 179 },
  albedo: null,
};

export function brdfPanel(context: Context): HTMLElement {
  const { store, tables } = context;
  const grid = store.get().library.grid as unknown as readonly [Axis, Axis, Axis];
  let view: View = "lobes";
  const degrees: Record<View, number> = { lobes: 45, slice: 90, albedo: 0 };
  const scales: Record<View, Scale> = { lobes: "cube root", slice: "linear", albedo: "linear" };
  let pointer: { readonly x: number; readonly y: number } | null = null;
  const samples = new Samples();
  const canvas = el(
    "canvas",
    { role: "img", "aria-label": "The BRDF of the mixed material" },
    {
      onpointermove: ({ offsetX: x, offsetY: y }) => {
        pointer = { x, y };
        update();
      },
      onpointerleave: () => {
        pointer = null;
        update();
      },
    },
  );
  let pen = toPen(context, canvas);
  const choice = segments<View>(
    "BRDF view",
    [
      ["lobes", "Lobes"],
      ["slice", "Slice"],
      ["albedo", "Albedo"],
    ],
    (next) => {
      view = next;
      offer();
    },
  );
  const name = el("span.angle");
  const angle = el(
    "input",
    { type: "range", min: 0, step: 1, "aria-label": "Angle in degrees" },
    {
      oninput: () => {
        degrees[view] = Number(angle.value);
        offer();
      },
    },
  );
  const output = el("output");
  const label = el("label", {}, {}, name, angle, output);
  const scale = el(
    "select.field.small",
    { "aria-label": "Scale" },
    {
      onchange: () => {
        scales[view] = scale.value as Scale;
        offer();
      },
    },
    ...SCALES.map((each) => el("option", { value: each }, {}, each)),
  );
  const reading = el("p.reading");
  const offer = () => {
    choice.mark(view);
    const about = ANGLES[view];
    label.hidden = scale.hidden = about === null;
    if (about !== null) {
      name.replaceChildren(about.name[0], el("sub", {}, {}, about.name[1]));
      angle.max = String(about.max);
      angle.value = String(degrees[view]);
      output.textContent = `${degrees[view]}°`;
      scale.value = scales[view];
    }
    update();
  };
  const update = paced(() => draw(), BESIDE);
  let timer = 0;
  /** Not at the pace of drawing: nothing is drawn before the last sample is there. */
  const goOn = () => {
    window.clearTimeout(timer);
    timer = window.setTimeout(draw);
  };
  const plots: Record<View, () => Plot> = {
    lobes: () => lobes(degrees.lobes, scales.lobes),
    slice: () => slice(grid, degrees.slice, scales.slice),
    albedo,
  };
  const draw = () => {
    const { recipe } = store.get();
    if (canvas.width === 0 || recipe.length === 0) return;
    const plot = plots[view]();
    const missing = recipe.some(({ name }) => tables.get(name) === undefined);
    const share = samples.make(plot, recipe, (name) => tables.get(name)?.table, PATIENCE);
    // Until all is there the plot of before stays.
    if (share < 1) {
      reading.textContent = missing ? "loading tables" : `integrating, ${Math.round(100 * share)} %`;
      if (!missing) goOn();
      return;
    }
    const mixed = samples.mix(plot, recipe);
    const size = { width: canvas.clientWidth, height: canvas.clientHeight };
    const ratio = canvas.width / size.width;
    pen.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.context.clearRect(0, 0, size.width, size.height);
    plot.draw(pen, size, mixed);
    const found = pointer && plot.read(pointer.x, pointer.y, size, mixed);
    if (found) mark(pen, found);
    reading.replaceChildren(...(found ? describe(found) : ["point at the plot for numbers"]));
  };
  onResize(canvas, (width, height) => {
    canvas.width = width;
    canvas.height = height;
    // At once, so that it is not empty for a frame.
    draw();
  });
  store.watch(
    ({ scheme }) => scheme,
    () => {
      pen = toPen(context, canvas);
      update();
    },
  );
  store.watch(({ recipe, arrived }) => [recipe, arrived], update);
  offer();
  return el(
    "section.panel.brdf",
    { "aria-label": "BRDF" },
    {},
    el("div.titled", {}, {}, el("h2", {}, {}, "BRDF"), choice.element),
    canvas,
    reading,
    el("div.controls", {}, {}, label, scale),
  );
}

function toPen({ root, store }: Context, canvas: HTMLCanvasElement): Pen {
  const [line, quiet, text, accent, red, green, blue] = [
    "--line",
    "--quiet",
    "--text",
    "--accent",
    "--red",
    "--green",
    "--blue",
  ].map((name) => style(root, name));
  return {
    context: canvas.getContext("2d")!,
    line: line!,
    quiet: quiet!,
    text: text!,
    accent: accent!,
    channels: [red!, green!, blue!],
    blend: store.get().scheme === "light" ? "multiply" : "screen",
  };
}

function mark({ context, text }: Pen, { at }: Reading): void {
  context.strokeStyle = text;
  context.lineWidth = 1.25;
  for (const [x, y] of at) {
    context.beginPath();
    context.arc(x, y, 3.5, 0, 2 * Math.PI);
    context.stroke();
  }
}

function describe({ angles, value, unit }: Reading): (Node | string)[] {
  const places = angles.map(([angle, degrees]) =>
    el("span", {}, {}, angle[0]!, el("sub", {}, {}, angle.slice(1)), ` ${degrees.toFixed(1)}°`),
  );
  if (value === null) return [el("span", {}, {}, ...places), el("span", {}, {}, "unmeasured")];
  const channels = value.map((x, c) => el(`span.${["r", "g", "b"][c]}`, {}, {}, short(x)));
  return [el("span", {}, {}, ...places), el("span", {}, {}, ...channels, unit)];
}
