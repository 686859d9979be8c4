// The BRDF itself: polar lobes for a light direction, a slice of the table, or the albedo, with the numbers under the pointer.

import type { DrawableGrid } from "../../brdf/grid";
import type { Context } from "../../context";
import { dropdown, el, onResize, segments, style } from "../../dom";
import { paced } from "../../paced";
import { DRAWN, drawnOf, otherDrawnOf } from "../../shown";
import type { PlotKind } from "../../state";
import { albedo } from "./albedo";
import { lobes } from "./lobes";
import { type Pen, type Plot, type Reading, SCALES, type Scale, short } from "./plot";
import { Samples } from "./samples";
import { slice } from "./slice";

/** Milliseconds that the samples may take before the page has its turn. */
const PATIENCE = 24;
/** Milliseconds between drawings: the picture of the material comes first. */
const BESIDE = 60;

const NOTHING = new Float64Array();

/** What a view can be told: an angle, named as it is written, up to `max`; and a scale. */
interface Settings {
  readonly angle: readonly [letter: string, index: string];
  readonly max: number;
  degrees: number;
  scale: Scale;
}

export function brdfPanel(context: Context): HTMLElement {
  return new BrdfPanel(context).element;
}

class BrdfPanel {
  readonly element: HTMLElement;
  private readonly settings: Record<PlotKind, Settings | null> = {
    lobes: { angle: ["θ", "i"], max: 85, degrees: 45, scale: "cube root" },
    slice: { angle: ["φ", "d"], max: 179, degrees: 90, scale: "linear" },
    albedo: null,
  };
  private readonly samples = new Samples();
  private readonly canvas: HTMLCanvasElement;
  private readonly reading = el("p.quiet.reading");
  private pen: Pen;
  private pointer: { readonly x: number; readonly y: number } | null = null;
  private readonly update = paced(() => this.draw(), BESIDE);
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly context: Context) {
    const { store } = context;
    this.canvas = el("canvas", {
      role: "img",
      "aria-label": "The BRDF of the mixed material",
      onpointermove: ({ offsetX: x, offsetY: y }) => this.point({ x, y }),
      onpointerleave: () => this.point(null),
    });
    this.pen = toPen(context, this.canvas);
    const controls = el("div.line.controls");
    this.element = el(
      "section.panel.brdf",
      { "aria-label": "BRDF" },
      el("div.line.titled", el("h2", "BRDF"), this.viewChoice(controls)),
      this.canvas,
      this.reading,
      controls,
    );
    onResize(this.canvas, (width, height) => {
      this.canvas.width = width;
      this.canvas.height = height;
      // At once, so that it is not empty for a frame.
      this.draw();
    });
    store.watch(["scheme"], () => {
      this.pen = toPen(context, this.canvas);
      this.update();
    });
    store.watch([...DRAWN, "arrived"], this.update);
  }

  private viewChoice(controls: HTMLElement): HTMLElement {
    const { element, mark } = segments<PlotKind>(
      "BRDF view",
      [
        ["lobes", "Lobes"],
        ["slice", "Slice"],
        ["albedo", "Albedo"],
      ],
      (plot) => this.context.store.set({ plot }),
    );
    this.context.store.watch(["plot"], ({ plot }) => {
      mark(plot);
      const settings = this.settings[plot];
      controls.replaceChildren(...(settings ? [this.angle(settings), this.scale(settings)] : []));
      this.update();
    });
    return element;
  }

  private angle(settings: Settings): HTMLElement {
    const [letter, index] = settings.angle;
    const input = el("input", {
      type: "range",
      min: 0,
      max: settings.max,
      step: 1,
      "aria-label": "Angle in degrees",
      value: settings.degrees,
      oninput: () => {
        settings.degrees = Number(input.value);
        output.textContent = `${settings.degrees}°`;
        this.update();
      },
    });
    const output = el("output", `${settings.degrees}°`);
    return el("label.line", el("span", letter, el("sub", index)), input, output);
  }

  private scale(settings: Settings): HTMLElement {
    const options = SCALES.map((scale) => [scale] as const);
    const select = dropdown({ "aria-label": "Scale" }, options, (scale) => {
      settings.scale = scale;
      this.update();
    });
    select.value = settings.scale;
    return select;
  }

  private point(pointer: { readonly x: number; readonly y: number } | null): void {
    this.pointer = pointer;
    this.update();
  }

  private plot(): Plot {
    const { lobes: ofLobes, slice: ofSlice } = this.settings;
    const { library, plot } = this.context.store.get();
    const grid = library.grid as unknown as DrawableGrid;
    if (plot === "lobes") return lobes(ofLobes!.degrees, ofLobes!.scale);
    return plot === "slice" ? slice(grid, ofSlice!.degrees, ofSlice!.scale) : albedo();
  }

  private draw(): void {
    const { store, tables } = this.context;
    const [recipe, otherRecipe] = [drawnOf(store.get()), otherDrawnOf(store.get())];
    if (this.canvas.width === 0 || recipe.length === 0) return;
    const plot = this.plot();
    const all = [...recipe, ...otherRecipe];
    const share = this.samples.make(plot, all, (name) => tables.get(name)?.table, PATIENCE);
    if (share === 1) {
      const beside = otherRecipe.length ? this.samples.mix(plot, otherRecipe) : NOTHING;
      this.show(plot, this.samples.mix(plot, recipe), beside);
      return;
    }
    // Until all is there the plot of before stays.
    const missing = all.some(({ name }) => tables.get(name) === undefined);
    this.reading.textContent = missing ? "loading tables" : `integrating, ${Math.round(100 * share)} %`;
    clearTimeout(this.timer);
    // Not at the pace of drawing: nothing is drawn before the last sample is there.
    if (!missing) this.timer = setTimeout(() => this.draw());
  }

  private show(plot: Plot, mixed: Float64Array, beside: Float64Array): void {
    const { pen, canvas, pointer } = this;
    const size = { width: canvas.clientWidth, height: canvas.clientHeight };
    const ratio = canvas.width / size.width;
    pen.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.context.clearRect(0, 0, size.width, size.height);
    plot.draw(pen, size, mixed, beside);
    const reading = pointer && plot.read(pointer.x, pointer.y, size, mixed, beside);
    if (reading) mark(pen, reading);
    this.reading.replaceChildren(...(reading ? describe(reading) : ["point at the plot for numbers"]));
  }
}

function toPen({ root, store }: Context, canvas: HTMLCanvasElement): Pen {
  const colour = (name: string) => style(root, `--${name}`);
  return {
    context: canvas.getContext("2d")!,
    line: colour("line"),
    quiet: colour("quiet"),
    text: colour("text"),
    accent: colour("accent"),
    channels: [colour("red"), colour("green"), colour("blue")],
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

function describe({ angles, value, unit }: Reading): HTMLElement[] {
  const directions = angles.map(([angle, degrees]) =>
    el("span", angle[0]!, el("sub", angle.slice(1)), ` ${degrees.toFixed(1)}°`),
  );
  const channels = value?.map((x, c) => el(`span.${["r", "g", "b"][c]}`, short(x)));
  return [el("span", ...directions), el("span", ...(channels ? [...channels, unit] : ["unmeasured"]))];
}
