// The BRDF itself: polar lobes for a light direction, a slice of the table, or the albedo, with the numbers under the pointer.

import { type DrawableGrid, isIsotropic } from "../../brdf/grid";
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

/** An angle that a view can be told, named as it is written, up to `max`. */
interface Dial {
  readonly angle: readonly [letter: string, index: string];
  readonly max: number;
  degrees: number;
}

/** What a view can be told. */
interface Settings {
  /** The azimuth from the tangent: of the light, or phi_h. It matters to tables that depend on phi_h. */
  readonly turn: Dial;
  readonly angle: Dial | null;
  scale: Scale | null;
}

function toSettings([, phiH]: DrawableGrid): Record<PlotKind, Settings> {
  const max = Math.round((phiH.stop * 180) / Math.PI) - 1;
  const turn = (index: string): Dial => ({ angle: ["φ", index], max, degrees: 0 });
  return {
    lobes: { turn: turn("i"), angle: { angle: ["θ", "i"], max: 85, degrees: 45 }, scale: "cube root" },
    slice: { turn: turn("h"), angle: { angle: ["φ", "d"], max: 179, degrees: 90 }, scale: "linear" },
    albedo: { turn: turn("i"), angle: null, scale: null },
  };
}

export function brdfPanel(context: Context): HTMLElement {
  return new BrdfPanel(context).element;
}

class BrdfPanel {
  readonly element: HTMLElement;
  private readonly settings: Record<PlotKind, Settings>;
  private readonly samples = new Samples();
  private readonly canvas: HTMLCanvasElement;
  private readonly reading = el("p.quiet.reading");
  private pen: Pen;
  private pointer: { readonly x: number; readonly y: number } | null = null;
  private readonly update = paced(() => this.draw(), BESIDE);
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly context: Context) {
    const { store, tables } = context;
    this.settings = toSettings(tables.grid);
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
      const { turn, angle, scale } = this.settings[plot];
      const dials = isIsotropic(this.context.tables.grid) ? [angle] : [angle, turn];
      controls.replaceChildren(
        ...dials.filter((dial) => dial !== null).map((dial) => this.dial(dial)),
        ...(scale === null ? [] : [this.scale(this.settings[plot], scale)]),
      );
      this.update();
    });
    return element;
  }

  private dial(dial: Dial): HTMLElement {
    const [letter, index] = dial.angle;
    const input = el("input", {
      type: "range",
      min: 0,
      max: dial.max,
      step: 1,
      "aria-label": `Angle ${letter}${index} in degrees`,
      value: dial.degrees,
      oninput: () => {
        dial.degrees = Number(input.value);
        output.textContent = `${dial.degrees}°`;
        this.update();
      },
    });
    const output = el("output", `${dial.degrees}°`);
    return el("label.line", el("span", letter, el("sub", index)), input, output);
  }

  private scale(settings: Settings, scale: Scale): HTMLElement {
    const options = SCALES.map((scale) => [scale] as const);
    const select = dropdown({ "aria-label": "Scale" }, options, (chosen) => {
      settings.scale = chosen;
      this.update();
    });
    select.value = scale;
    return select;
  }

  private point(pointer: { readonly x: number; readonly y: number } | null): void {
    this.pointer = pointer;
    this.update();
  }

  private plot(): Plot {
    const { grid } = this.context.tables;
    const { plot } = this.context.store.get();
    const { turn, angle, scale } = this.settings[plot];
    if (plot === "lobes") return lobes(angle!.degrees, turn.degrees, scale!);
    return plot === "slice" ? slice(grid, turn.degrees, angle!.degrees, scale!) : albedo(grid, turn.degrees);
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
