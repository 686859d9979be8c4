// Directional albedo over theta_i: the share of the light from each direction that the material gives back, per channel.

import { directionalAlbedo } from "../../brdf/albedo";
import { type DrawableGrid, isIsotropic } from "../../brdf/grid";
import { clamp } from "../../numbers";
import { DASHES, marks, type Pen, type Plot, type Size, short, stroke, write, writeUpwards } from "./plot";

/** Directions of light, in degrees; at 90 nothing arrives. */
const ANGLES = [...Array.from({ length: 18 }, (_, i) => 5 * i), 88];
/** Nodes of the integral: half as many in azimuth as Python takes. On a table like chrome's both are .14 % off (brdf.test.ts). */
export const NODES = [360, 30] as const;
/** Of tables that depend on phi_h, whose highlights may be narrow in it: turned steel is .6 % off. */
export const NODES_OF_TURNS = [180, 120] as const;
const DEGREE = Math.PI / 180;

/** Of light from an azimuth. */
export function albedo(grid: DrawableGrid, phiIDegrees: number): Plot {
  const nodes = isIsotropic(grid) ? NODES : NODES_OF_TURNS;
  return {
    key: `albedo ${phiIDegrees}`,
    length: 3 * ANGLES.length,
    nSteps: ANGLES.length,
    fill: (table, samples, step) =>
      samples.set(directionalAlbedo(table, ANGLES[step]! * DEGREE, phiIDegrees * DEGREE, ...nodes), 3 * step),
    draw: (pen, size, mixed, beside) => {
      const frame = toFrame(size, mixed, beside);
      drawAxes(pen, frame);
      drawCurves(pen, frame, mixed);
      pen.context.setLineDash([...DASHES]);
      if (beside.length) drawCurves(pen, frame, beside);
      pen.context.setLineDash([]);
    },
    read: (x, _, size, mixed, beside) => {
      const frame = toFrame(size, mixed, beside);
      const degrees = ((x - frame.x0) / frame.width) * 90;
      if (degrees < -2 || degrees > 92) return null;
      const i = clamp(Math.round(degrees / 5), 0, ANGLES.length - 1);
      const value = [mixed[3 * i]!, mixed[3 * i + 1]!, mixed[3 * i + 2]!] as const;
      return {
        angles: [["θi", ANGLES[i]!]],
        value,
        unit: "",
        at: value.map((v) => toCanvas(frame, ANGLES[i]!, v)),
      };
    },
  };
}

type Frame = ReturnType<typeof toFrame>;

function toFrame({ width, height }: Size, mixed: Float64Array, beside: Float64Array) {
  const high = Math.max(1, 1.05 * Math.max(...mixed, ...beside));
  return { x0: 46, y0: height - 36, width: width - 58, height: height - 44, high };
}

function toCanvas({ x0, y0, width, height, high }: Frame, degrees: number, value: number): [number, number] {
  return [x0 + (degrees / 90) * width, y0 - (value / high) * height];
}

function drawCurves(pen: Pen, frame: Frame, mixed: Float64Array): void {
  const { context, blend, channels } = pen;
  context.lineWidth = 1.75;
  context.globalCompositeOperation = blend;
  channels.forEach((colour, c) => {
    stroke(pen, colour, ...ANGLES.map((degrees, i) => toCanvas(frame, degrees, mixed[3 * i + c]!)));
  });
  context.globalCompositeOperation = "source-over";
}

function drawAxes(pen: Pen, frame: Frame): void {
  const { context, line, quiet } = pen;
  context.lineWidth = 1;
  for (const value of [0, ...marks("linear", 0, frame.high)]) {
    const [x, y] = toCanvas(frame, 0, value);
    // Above 1 more light would come back than arrived.
    stroke(pen, value === 1 ? quiet : line, [x, y], toCanvas(frame, 90, value));
    write(pen, short(value), x - 6, y + 4, "right");
  }
  for (const degrees of [0, 30, 60, 90])
    write(pen, `${degrees}°`, toCanvas(frame, degrees, 0)[0], frame.y0 + 14);
  write(pen, "θi", frame.x0 + frame.width / 2, frame.y0 + 29);
  writeUpwards(pen, "albedo", 12, frame.y0 - frame.height / 2);
}
