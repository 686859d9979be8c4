// Environments that come with the page: pictures from @pmndrs/assets (CC0), each loaded when it is first chosen.

import { DataUtils, HalfFloatType } from "three";
import { EXRLoader } from "three/addons/loaders/EXRLoader.js";
import { HDRLoader } from "three/addons/loaders/HDRLoader.js";

import { type Block, Problem } from "../api/client";
import { HALF } from "../brdf/half";
import type { Picture } from "../scene";

const FILES: Record<Picture, () => Promise<{ default: string }>> = {
  apartment: () => import("@pmndrs/assets/hdri/apartment.exr"),
  city: () => import("@pmndrs/assets/hdri/city.exr"),
  dawn: () => import("@pmndrs/assets/hdri/dawn.exr"),
  forest: () => import("@pmndrs/assets/hdri/forest.exr"),
  lobby: () => import("@pmndrs/assets/hdri/lobby.exr"),
  night: () => import("@pmndrs/assets/hdri/night.exr"),
  park: () => import("@pmndrs/assets/hdri/park.exr"),
  sunset: () => import("@pmndrs/assets/hdri/sunset.exr"),
  warehouse: () => import("@pmndrs/assets/hdri/warehouse.exr"),
};

/** Mean radiance of every picture, about that of the studio: no exposure is needed to go from one to another. */
const MEAN = 0.6;

/** A person's own picture: latitude and longitude, .hdr or .exr, up is up. */
export async function readLight(file: File): Promise<Block> {
  const bytes = await file.arrayBuffer();
  const loader = file.name.toLowerCase().endsWith(".exr") ? new EXRLoader() : new HDRLoader();
  try {
    const { data, width = 0, height = 0 } = loader.setDataType(HalfFloatType).parse(bytes);
    // The two loaders begin at other ends.
    const rows =
      loader instanceof EXRLoader ? upright(data as Uint16Array, width, height) : (data as Uint16Array);
    return toBlock(resampled(rows, width, height));
  } catch {
    throw new Problem(
      `${file.name} is no picture of light that the page reads: expected .hdr or .exr in RGB.`,
    );
  }
}

interface Halfs {
  readonly halfs: Uint16Array<ArrayBuffer>;
  readonly width: number;
  readonly height: number;
}

function toBlock({ halfs, width, height }: Halfs): Block {
  return { halfs: normalised(halfs, height), shape: [height, width, 4], scale: [1, 1, 1] };
}

/** At most so large, and as cells of a table need it: means of the pixels that fall into each. */
function resampled(halfs: Uint16Array, fromWidth: number, fromHeight: number): Halfs {
  const whole = (size: number, most: number) => Math.max(8, 8 * Math.floor(Math.min(size, most) / 8));
  const [width, height] = [whole(fromWidth, 1024), whole(fromHeight, 512)];
  const sums = new Float64Array(4 * width * height);
  for (let y = 0; y < fromHeight; y++) {
    const row = Math.floor((y * height) / fromHeight) * width;
    for (let x = 0; x < fromWidth; x++) {
      const [to, from] = [4 * (row + Math.floor((x * width) / fromWidth)), 4 * (y * fromWidth + x)];
      for (let c = 0; c < 3; c++) sums[to + c]! += Math.max(HALF[halfs[from + c]!]!, 0);
      sums[to + 3]!++;
    }
  }
  const means = Uint16Array.from(sums, (sum, i) =>
    DataUtils.toHalfFloat(i % 4 === 3 ? 1 : Math.min(sum / (sums[i - (i % 4) + 3]! || 1), 65000)),
  );
  return { halfs: means, width, height };
}

export async function loadPicture(picture: Picture): Promise<Block> {
  const { default: url } = await FILES[picture]();
  const text = atob(url.slice(url.indexOf(",") + 1));
  const bytes = Uint8Array.from(text, (character) => character.charCodeAt(0));
  const { data, width = 0, height = 0 } = new EXRLoader().setDataType(HalfFloatType).parse(bytes.buffer);
  return toBlock({ halfs: upright(data as Uint16Array, width, height), width, height });
}

/** The loader's first row is the lowest. */
function upright(halfs: Uint16Array, width: number, height: number): Uint16Array<ArrayBuffer> {
  const turned = new Uint16Array(halfs.length);
  for (let row = 0; row < height; row++) {
    turned.set(halfs.subarray(4 * width * row, 4 * width * (row + 1)), 4 * width * (height - 1 - row));
  }
  return turned;
}

function normalised(halfs: Uint16Array<ArrayBuffer>, height: number): Uint16Array<ArrayBuffer> {
  const width = halfs.length / (4 * height);
  let sum = 0;
  let area = 0;
  for (let row = 0; row < height; row++) {
    const sine = Math.sin((Math.PI * (row + 0.5)) / height);
    for (let column = 0; column < width; column++) {
      const at = 4 * (row * width + column);
      sum += sine * (HALF[halfs[at]!]! + HALF[halfs[at + 1]!]! + HALF[halfs[at + 2]!]!);
      area += 3 * sine;
    }
  }
  const scale = (MEAN * area) / sum;
  return halfs.map((bits, i) =>
    i % 4 === 3 ? bits : DataUtils.toHalfFloat(Math.min(scale * HALF[bits]!, 65000)),
  );
}
