// The table itself at one phi_d and phi_h, theta_d over theta_h: the picture of B. Burley, "Physically-Based Shading at Disney", 2012, section 3.

import type { Axis } from "../../api/schema";
import { type DrawableGrid, toAngle, toPosition } from "../../brdf/grid";
import { sample } from "../../brdf/table";
import { toByte } from "../../colour";
import {
  marks,
  type Pen,
  type Plot,
  type Scale,
  type Size,
  scaled,
  short,
  write,
  writeUpwards,
} from "./plot";

/** In linear scale, white is what a white matte surface reflects, as in the published slices. */
const WHITE = 1 / Math.PI;
const LOWEST = 1e-3;
const DEGREE = Math.PI / 180;

export function slice(grid: DrawableGrid, phiHDegrees: number, phiDDegrees: number, scale: Scale): Plot {
  const [axisH, axisT, axisD, axisP] = grid;
  const cell = (axis: Axis, degrees: number) => Math.floor(toPosition(axis, degrees * DEGREE)) % axis.size;
  const [turn, column] = [cell(axisT, phiHDegrees), cell(axisP, phiDDegrees)];
  const [nH, nD] = [axisH.size, axisD.size];
  return {
    key: `slice ${turn} ${column}`,
    length: 3 * nH * nD,
    nSteps: 1,
    fill: (table, samples) => {
      // A small table stands in for the full one: the cells at the same angles.
      const at = (axis: 0 | 1 | 2 | 3, i: number) =>
        Math.floor(toPosition(table.grid[axis], toAngle(grid[axis], i + 0.5)));
      for (let h = 0; h < nH; h++) {
        for (let d = 0; d < nD; d++) {
          const value = sample(table, at(0, h), at(1, turn), at(2, d), at(3, column));
          samples.set(value ?? [Number.NaN, Number.NaN, Number.NaN], 3 * (h * nD + d));
        }
      }
    },
    draw: (pen, size, mixed) => {
      const box = toBox(size);
      const range = toRange(scale, mixed);
      pen.context.imageSmoothingEnabled = false;
      pen.context.drawImage(picture(nH, nD, mixed, scale, range), box.x, box.y, box.side, box.side);
      pen.context.imageSmoothingEnabled = true;
      drawAxes(pen, box, axisH, axisD);
      drawBar(pen, box, scale, range);
    },
    read: (x, y, size, mixed) => {
      const box = toBox(size);
      const [u, v] = [(x - box.x) / box.side, 1 - (y - box.y) / box.side];
      if (u < 0 || u >= 1 || v < 0 || v >= 1) return null;
      const [h, d] = [Math.floor(u * nH), Math.floor(v * nD)];
      const at = 3 * (h * nD + d);
      const value = [mixed[at]!, mixed[at + 1]!, mixed[at + 2]!] as const;
      return {
        angles: [
          ["θh", toAngle(axisH, h + 0.5) / DEGREE],
          ["θd", toAngle(axisD, d + 0.5) / DEGREE],
        ],
        value: value.some(Number.isNaN) ? null : value,
        unit: "1/sr",
        at: [[box.x + ((h + 0.5) / nH) * box.side, box.y + (1 - (d + 0.5) / nD) * box.side]],
      };
    },
  };
}

type Range = readonly [low: number, high: number];

function toRange(scale: Scale, mixed: Float64Array): Range {
  if (scale === "linear") return [0, WHITE];
  const high = mixed.reduce((a, b) => (b > a ? b : a), 1e-6);
  return [Math.min(LOWEST, high / 10), high];
}

/** Linear light is coded for the screen; the other scales are even to the eye as they are. */
function toLevel(scale: Scale, value: number, [low, high]: Range): number {
  const share = scaled(scale, value, low, high);
  return scale === "linear" ? toByte(share) : Math.round(255 * Math.min(share, 1));
}

function picture(nH: number, nD: number, mixed: Float64Array, scale: Scale, range: Range): HTMLCanvasElement {
  const image = new ImageData(nH, nD);
  for (let h = 0; h < nH; h++) {
    for (let d = 0; d < nD; d++) {
      const from = 3 * (h * nD + d);
      const to = 4 * ((nD - 1 - d) * nH + h);
      if (Number.isNaN(mixed[from])) continue;
      for (let c = 0; c < 3; c++) image.data[to + c] = toLevel(scale, mixed[from + c]!, range);
      image.data[to + 3] = 255;
    }
  }
  const cells = document.createElement("canvas");
  cells.width = nH;
  cells.height = nD;
  cells.getContext("2d")!.putImageData(image, 0, 0);
  return cells;
}

type Box = ReturnType<typeof toBox>;

function toBox({ width, height }: Size) {
  const side = Math.max(20, Math.min(height - 36, width - 96));
  return { x: (width - side - 12) / 2, y: Math.max(6, (height - side - 30) / 2), side };
}

function drawAxes(pen: Pen, { x, y, side }: Box, axisH: Axis, axisD: Axis): void {
  for (const degrees of [0, 5, 20, 45, 90]) {
    const share = toPosition(axisH, degrees * DEGREE) / axisH.size;
    write(pen, `${degrees}°`, x + share * side, y + side + 13);
  }
  for (const degrees of [0, 30, 60, 90]) {
    const share = toPosition(axisD, degrees * DEGREE) / axisD.size;
    write(pen, `${degrees}°`, x - 5, y + (1 - share) * side + 4, "right");
  }
  write(pen, "θh", x + side / 2, y + side + 27);
  writeUpwards(pen, "θd", x - 30, y + side / 2);
}

const BAR = 8;

function drawBar(pen: Pen, { x, y, side }: Box, scale: Scale, range: Range): void {
  const { context } = pen;
  const left = x + side + 10;
  const [low, high] = range;
  for (let row = 0; row < side; row++) {
    const share = 1 - row / side;
    const level = scale === "linear" ? toByte(share) : Math.round(255 * share);
    context.fillStyle = `rgb(${level} ${level} ${level})`;
    context.fillRect(left, y + row, BAR, 1);
  }
  let last = Number.POSITIVE_INFINITY;
  for (const value of [...marks(scale, low, high)].reverse()) {
    const at = y + (1 - scaled(scale, value, low, high)) * side;
    if (Math.abs(at - last) < 14) continue;
    last = at;
    write(pen, short(value), left + BAR + 4, at + 4, "left");
  }
  write(pen, "1/sr", left + BAR + 4, y + side + 13, "left");
}
