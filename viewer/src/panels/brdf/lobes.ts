// Polar lobes in the plane of incidence, at an azimuth of the light: it comes from the left, and how much goes where is how far the
// curve reaches.

import { type Direction, toDirection, toHalfDiff } from "../../brdf/halfdiff";
import { evaluate } from "../../brdf/table";
import { clamp } from "../../numbers";
import {
  DASHES,
  marks,
  type Pen,
  type Plot,
  type Scale,
  type Size,
  scaled,
  short,
  stroke,
  write,
} from "./plot";

/** Half degrees from -89.5 (where the light is) to 89.5. */
const ANGLES = Array.from({ length: 359 }, (_, i) => ((i - 179) / 2) * (Math.PI / 180));
const DECADES = 6;

export function lobes(thetaIDegrees: number, phiIDegrees: number, scale: Scale): Plot {
  const [thetaI, phiI] = [thetaIDegrees, phiIDegrees].map((degrees) => (degrees * Math.PI) / 180) as [
    number,
    number,
  ];
  const wi = toDirection(thetaI, phiI);
  const towards = (angle: number): Direction => toDirection(-angle, phiI);
  return {
    key: `lobes ${thetaIDegrees} ${phiIDegrees}`,
    length: 3 * ANGLES.length,
    nSteps: 1,
    fill: (table, samples) => {
      ANGLES.forEach((angle, i) => {
        samples.set(evaluate(table, wi, towards(angle)), 3 * i);
      });
    },
    draw: (pen, size, mixed, beside) => {
      const frame = toFrame(size, mixed, beside);
      drawRings(pen, frame, scale);
      drawLobes(pen, frame, scale, mixed);
      pen.context.setLineDash([...DASHES]);
      if (beside.length) drawLobes(pen, frame, scale, beside, "");
      pen.context.setLineDash([]);
      drawLight(pen, frame, thetaI);
    },
    read: (x, y, size, mixed, beside) => {
      const frame = toFrame(size, mixed, beside);
      if (y > frame.y0 + 4) return null;
      const i = Math.round(2 * (Math.atan2(x - frame.x0, frame.y0 - y) * (180 / Math.PI))) + 179;
      const angle = ANGLES[clamp(i, 0, ANGLES.length - 1)]!;
      const at = 3 * ANGLES.indexOf(angle);
      const { thetaH, thetaD } = toHalfDiff(wi, towards(angle));
      const value = [mixed[at]!, mixed[at + 1]!, mixed[at + 2]!] as const;
      return {
        angles: [
          ["θo", Math.abs(angle) * (180 / Math.PI)],
          ["θh", thetaH * (180 / Math.PI)],
          ["θd", thetaD * (180 / Math.PI)],
        ],
        value,
        unit: "1/sr",
        at: value.map((v) => toCanvas(frame, scale, v, angle)),
      };
    },
  };
}

type Frame = ReturnType<typeof toFrame>;

function toFrame({ width, height }: Size, mixed: Float64Array, beside: Float64Array) {
  const all = [...mixed, ...beside];
  const high = Math.max(...all, 1e-6);
  const least = Math.min(...all.filter((value) => value > high / 10 ** DECADES), high / 10);
  const low = 10 ** Math.floor(Math.log10(least));
  const reach = Math.min(width / 2 - 16, height - 30);
  return { x0: width / 2, y0: (height + reach) / 2 - 4, reach, low, high };
}

function toCanvas(
  { x0, y0, reach, low, high }: Frame,
  scale: Scale,
  value: number,
  angle: number,
): readonly [number, number] {
  const r = reach * scaled(scale, value, low, high);
  return [x0 + r * Math.sin(angle), y0 - r * Math.cos(angle)];
}

function drawLobes(pen: Pen, frame: Frame, scale: Scale, mixed: Float64Array, filled = "33"): void {
  const { context, channels, blend } = pen;
  context.globalCompositeOperation = blend;
  context.lineWidth = 1.5;
  channels.forEach((colour, c) => {
    context.beginPath();
    ANGLES.forEach((angle, i) => {
      context.lineTo(...toCanvas(frame, scale, mixed[3 * i + c]!, angle));
    });
    context.closePath();
    context.fillStyle = `${colour}${filled}`;
    context.strokeStyle = colour;
    if (filled) context.fill();
    context.stroke();
  });
  context.globalCompositeOperation = "source-over";
}

function drawRings(pen: Pen, { x0, y0, reach, low, high }: Frame, scale: Scale): void {
  const { context, line } = pen;
  context.lineWidth = 1;
  let last = Number.POSITIVE_INFINITY;
  for (const value of marks(scale, low, high).reverse()) {
    const r = reach * scaled(scale, value, low, high);
    // Room for the numbers below the base line.
    if (r < 24 || last - r < 30) continue;
    last = r;
    context.strokeStyle = line;
    context.beginPath();
    context.arc(x0, y0, r, Math.PI, 2 * Math.PI);
    context.stroke();
    write(pen, short(value), x0 - r, y0 + 14);
  }
  stroke(pen, line, [x0 - reach, y0], [x0 + reach, y0]);
  stroke(pen, line, [x0, y0], [x0, y0 - reach]);
  write(pen, "1/sr", x0 + reach, y0 + 14, "right");
}

function drawLight(pen: Pen, { x0, y0, reach }: Frame, thetaI: number): void {
  const { context, accent } = pen;
  const [x, y] = [x0 - reach * Math.sin(thetaI), y0 - reach * Math.cos(thetaI)];
  context.setLineDash([3, 3]);
  stroke(pen, accent, [x, y], [x0, y0]);
  context.setLineDash([]);
  context.fillStyle = accent;
  context.beginPath();
  context.arc(x, y, 3.5, 0, 2 * Math.PI);
  context.fill();
}
