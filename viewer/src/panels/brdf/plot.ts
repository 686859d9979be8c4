// What the plots of the BRDF panel share.
//
// All that they show is linear in the BRDF: each material has samples of its own, made once, and the mix's are the weighted sum.

import type { Rgb, Table } from "../../brdf/table";

export interface Size {
  readonly width: number;
  readonly height: number;
}

/** What is under a place of the canvas. */
export interface Reading {
  /** Name and degrees. */
  readonly angles: readonly (readonly [string, number])[];
  /** Null where it is unmeasured. */
  readonly value: Rgb | null;
  readonly unit: string;
  /** Where to mark it. */
  readonly at: readonly (readonly [number, number])[];
}

export interface Plot {
  /** What the samples depend on beside the table. */
  readonly key: string;
  /** Of the samples: RGB one after another, NaN where unmeasured. */
  readonly length: number;
  /** The samples of a material are made in so many steps of some milliseconds. */
  readonly nSteps: number;
  readonly fill: (table: Table, samples: Float64Array, step: number) => void;
  /** With the samples of what is compared, `beside`, over it in dashes where the plot has lines. */
  readonly draw: (pen: Pen, size: Size, mixed: Float64Array, beside: Float64Array) => void;
  readonly read: (
    x: number,
    y: number,
    size: Size,
    mixed: Float64Array,
    beside: Float64Array,
  ) => Reading | null;
}

export interface Pen {
  readonly context: CanvasRenderingContext2D;
  readonly line: string;
  readonly quiet: string;
  readonly text: string;
  readonly accent: string;
  readonly channels: readonly [string, string, string];
  /** How colours that lie over each other add up to grey. */
  readonly blend: "multiply" | "screen";
}

/** Of the lines of what is compared. */
export const DASHES: readonly number[] = [4, 3];

export const SCALES = ["linear", "cube root", "log"] as const;
export type Scale = (typeof SCALES)[number];

/** Where between `low` (0) and `high` (1) a value stands; only the logarithm looks at `low`. */
export function scaled(scale: Scale, value: number, low: number, high: number): number {
  const share = Math.max(value, 0) / high;
  if (scale === "linear") return share;
  if (scale === "cube root") return Math.cbrt(share);
  return Math.max(0, Math.log(Math.max(value, low) / low) / Math.log(high / low));
}

/** Values to mark between `low` and `high`: powers of ten, or even steps. */
export function marks(scale: Scale, low: number, high: number): number[] {
  if (scale === "linear") {
    const step = niceStep(high / 3);
    return Array.from({ length: Math.floor(high / step + 1e-9) }, (_, i) => (i + 1) * step);
  }
  const from = scale === "log" ? low : high / 2000;
  const first = Math.ceil(Math.log10(from) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => 10 ** (first + i));
}

function niceStep(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * (x / power >= 5 ? 5 : x / power >= 2 ? 2 : 1);
}

/** Three digits, in the shortest way. */
export function short(x: number): string {
  if (x === 0) return "0";
  const size = Math.abs(x);
  return size >= 0.001 && size < 10_000 ? String(Number(x.toPrecision(3))) : x.toExponential(1);
}

/** Write at a point; an angle's second letter (`θh`) is its index. */
export function write(
  { context, quiet }: Pen,
  text: string,
  x: number,
  y: number,
  align: CanvasTextAlign = "center",
): void {
  context.fillStyle = quiet;
  context.font = "10.5px system-ui, sans-serif";
  context.textAlign = align;
  const isAngle = /^[θφ]\w$/.test(text);
  context.fillText(isAngle ? text[0]! : text, x, y);
  if (!isAngle) return;
  context.textAlign = "left";
  context.font = "8px system-ui, sans-serif";
  context.fillText(text[1]!, x + 4, y + 3);
}

/** Write upwards along an axis. */
export function writeUpwards(pen: Pen, text: string, x: number, y: number): void {
  const { context } = pen;
  context.save();
  context.translate(x, y);
  context.rotate(-Math.PI / 2);
  write(pen, text, 0, 0);
  context.restore();
}

export function stroke({ context }: Pen, colour: string, ...points: (readonly [number, number])[]): void {
  context.strokeStyle = colour;
  context.beginPath();
  for (const [x, y] of points) context.lineTo(x, y);
  context.stroke();
}
