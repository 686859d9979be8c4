// Small pictures of all materials, mixed on the processor: a recipe's picture before any table has come.

import type { Block } from "./api/client";
import { HALF } from "./brdf/half";
import { toByte } from "./colour";
import { el } from "./dom";
import type { Ingredient } from "./recipe";

export class Thumbnails {
  size = 64;
  private byName: ReadonlyMap<string, Float32Array> = new Map();
  private readonly averaged = new Map<string, Float64Array>();

  constructor(private readonly names: readonly string[]) {}

  /** The pictures have come: those that stand on the page already are painted. */
  fill(block: Block, root: HTMLElement): void {
    const [, size = 0] = block.shape;
    this.size = size;
    const n = 4 * size * size;
    this.byName = new Map(
      this.names.map((name, i) => [
        name,
        Float32Array.from(
          block.halfs.subarray(i * n, (i + 1) * n),
          (bits, j) => HALF[bits]! * (j % 4 === 3 ? 1 : block.scale[j % 4]!),
        ),
      ]),
    );
    for (const canvas of root.querySelectorAll<HTMLCanvasElement>("canvas.thumbnail"))
      this.paint(canvas, canvas.dataset.material!);
  }

  /** The picture of a recipe, ready for a canvas. */
  picture(recipe: readonly Ingredient[]): ImageData {
    const n = 4 * this.size * this.size;
    const sum = new Float32Array(n);
    for (const { name, weight } of recipe) {
      const part = this.byName.get(name);
      if (part !== undefined) add(sum, part, weight);
    }
    const bytes = new Uint8ClampedArray(n);
    for (let i = 0; i < n; i += 4) {
      bytes[i] = toByte(sum[i]!);
      bytes[i + 1] = toByte(sum[i + 1]!);
      bytes[i + 2] = toByte(sum[i + 2]!);
      bytes[i + 3] = Math.round(255 * this.edge(i / 4) * (sum[i + 3]! > 0 ? 1 : 0));
    }
    return new ImageData(bytes, this.size, this.size);
  }

  /** The picture of a recipe averaged to `n` x `n` blocks, linear RGB one after another. */
  blocks(recipe: readonly Ingredient[], n: number): Float64Array {
    const sum = new Float64Array(3 * n * n);
    for (const { name, weight } of recipe) {
      const part = this.blocksOf(name, n);
      for (let i = 0; i < sum.length; i++) sum[i]! += weight[i % 3]! * part[i]!;
    }
    return sum;
  }

  of(name: string): ImageData {
    return this.picture([{ name, weight: [1, 1, 1] }]);
  }

  /** A canvas with the picture of one material. */
  canvas(name: string): HTMLCanvasElement {
    const canvas = el("canvas.thumbnail", { "data-material": name });
    this.paint(canvas, name);
    return canvas;
  }

  private paint(canvas: HTMLCanvasElement, name: string): void {
    canvas.width = canvas.height = this.size;
    canvas.getContext("2d")!.putImageData(this.of(name), 0, 0);
  }

  private blocksOf(name: string, n: number): Float64Array {
    const known = this.averaged.get(name);
    if (known !== undefined) return known;
    const picture = this.byName.get(name);
    const blocks = new Float64Array(3 * n * n);
    const share = (n / this.size) ** 2;
    for (let pixel = 0; picture !== undefined && pixel < this.size * this.size; pixel++) {
      const x = Math.floor(((pixel % this.size) * n) / this.size);
      const y = Math.floor((Math.floor(pixel / this.size) * n) / this.size);
      for (let c = 0; c < 3; c++) blocks[3 * (y * n + x) + c]! += share * picture[4 * pixel + c]!;
    }
    this.averaged.set(name, blocks);
    return blocks;
  }

  /** Coverage of a pixel by the disc that touches all four sides. */
  private edge(pixel: number): number {
    const r = this.size / 2;
    const x = (pixel % this.size) + 0.5 - r;
    const y = Math.floor(pixel / this.size) + 0.5 - r;
    return Math.min(Math.max(r - Math.hypot(x, y), 0), 1);
  }
}

function add(sum: Float32Array, part: Float32Array, [r, g, b]: Ingredient["weight"]): void {
  for (let i = 0; i < sum.length; i += 4) {
    sum[i]! += r * part[i]!;
    sum[i + 1]! += g * part[i + 1]!;
    sum[i + 2]! += b * part[i + 2]!;
    sum[i + 3] = part[i + 3]!;
  }
}
