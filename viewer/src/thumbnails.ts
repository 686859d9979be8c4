// Small pictures of all materials, mixed on the processor: a recipe's picture before any table has come.

import type { Block, Client } from "./api/client";
import type { RecipeDocument } from "./api/schema";
import { LINEAR } from "./blend";
import { HALF } from "./brdf/half";
import { toByte } from "./colour";
import { el } from "./dom";
import { type Ingredient, toDocument } from "./recipe";

/** Pictures of mixes that are asked for together, and that are kept: 64 KB each. */
const AT_ONCE = 64;
const MAX_MIXES = 256;
/** Blocks along a side, to tell pictures apart by. */
const COARSE = 8;

export class Thumbnails {
  size = 64;
  private byName: ReadonlyMap<string, Float32Array> = new Map();
  private readonly averaged = new Map<string, Float64Array>();

  /** Pictures of mixes that are not made of the materials' own, those asked for last at the end; null: being made. */
  private readonly mixes = new Map<string, Float32Array | null>();
  /** Those to be asked for, and who waits for them. */
  private missing: RecipeDocument[] = [];
  private readonly waiting = new Set<() => void>();

  constructor(
    private readonly names: readonly string[],
    private readonly library: string,
    private readonly make: Client["thumbnailsOf"],
  ) {}

  /** The pictures have come: those that stand on the page already are painted. */
  fill(block: Block, root: HTMLElement): void {
    const [, size = 0] = block.shape;
    this.size = size;
    const n = 4 * size * size;
    this.byName = new Map(this.names.map((name, i) => [name, pictureIn(block, i, n)]));
    for (const canvas of root.querySelectorAll<HTMLCanvasElement>("canvas.thumbnail"))
      this.paint(canvas, canvas.dataset.material!);
  }

  /** The picture of a recipe, ready for a canvas; until it is made the linear one stands in, and `then` runs when it is. */
  picture(recipe: readonly Ingredient[], blend: string = LINEAR, then: () => void = () => {}): ImageData {
    const n = 4 * this.size * this.size;
    const sum =
      (blend !== LINEAR && recipe.length > 1 && this.ofMix(recipe, blend, then)) || this.sum(recipe);
    const bytes = new Uint8ClampedArray(n);
    for (let i = 0; i < n; i += 4) {
      bytes[i] = toByte(sum[i]!);
      bytes[i + 1] = toByte(sum[i + 1]!);
      bytes[i + 2] = toByte(sum[i + 2]!);
      bytes[i + 3] = Math.round(255 * this.edge(i / 4) * (sum[i + 3]! > 0 ? 1 : 0));
    }
    return new ImageData(bytes, this.size, this.size);
  }

  private sum(recipe: readonly Ingredient[]): Float32Array {
    const sum = new Float32Array(4 * this.size * this.size);
    for (const { name, weight } of recipe) {
      const part = this.byName.get(name);
      if (part !== undefined) add(sum, part, weight);
    }
    return sum;
  }

  /** The picture of a mix; null when it is not there, and is asked for. */
  private ofMix(recipe: readonly Ingredient[], blend: string, then: () => void): Float32Array | null {
    const document = toDocument(this.library, recipe, blend);
    const key = JSON.stringify(document);
    const known = this.mixes.get(key) ?? null;
    if (known !== null) return known;
    this.waiting.add(then);
    if (this.mixes.has(key)) return null;
    this.mixes.set(key, null);
    // All that are drawn together are asked for together.
    if (this.missing.push(document) === 1) queueMicrotask(() => void this.ask());
    return null;
  }

  private async ask(): Promise<void> {
    const asked = this.missing.splice(0, AT_ONCE);
    if (this.missing.length) queueMicrotask(() => void this.ask());
    const keys = asked.map((document) => JSON.stringify(document));
    try {
      const block = await this.make(asked);
      keys.forEach((key, i) => {
        this.mixes.set(key, pictureIn(block, i, 4 * this.size * this.size));
      });
    } catch {
      // The linear picture stays; who draws again asks again.
      for (const key of keys) this.mixes.delete(key);
      return;
    }
    for (const [key] of [...this.mixes].slice(0, -MAX_MIXES)) this.mixes.delete(key);
    const waiting = [...this.waiting];
    this.waiting.clear();
    for (const then of waiting) then();
  }

  /** How different two recipes look: the distance of their pictures' blocks, in about the scale of lightness. */
  distance(a: readonly Ingredient[], b: readonly Ingredient[]): number {
    const [x, y] = [a, b].map((each) => this.blocks(each, COARSE));
    return Math.hypot(...x!.map((value, i) => Math.cbrt(value) - Math.cbrt(y![i]!)));
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

  /** The mean colour of a recipe's sphere, linear RGB. */
  mean(recipe: readonly Ingredient[]): number[] {
    // Of the square, a disc of pi / 4 is sphere.
    return [...this.blocks(recipe, 1)].map((x) => (4 / Math.PI) * x);
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
    const key = `${n} ${name}`;
    const known = this.averaged.get(key);
    if (known !== undefined) return known;
    const picture = this.byName.get(name);
    const blocks = new Float64Array(3 * n * n);
    const share = (n / this.size) ** 2;
    for (let pixel = 0; picture !== undefined && pixel < this.size * this.size; pixel++) {
      const x = Math.floor(((pixel % this.size) * n) / this.size);
      const y = Math.floor((Math.floor(pixel / this.size) * n) / this.size);
      for (let c = 0; c < 3; c++) blocks[3 * (y * n + x) + c]! += share * picture[4 * pixel + c]!;
    }
    if (picture !== undefined) this.averaged.set(key, blocks);
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

/** The i-th picture of `n` numbers. */
function pictureIn({ halfs, scale }: Block, i: number, n: number): Float32Array {
  return Float32Array.from(
    halfs.subarray(i * n, (i + 1) * n),
    (bits, j) => HALF[bits]! * (j % 4 === 3 ? 1 : scale[j % 4]!),
  );
}

function add(sum: Float32Array, part: Float32Array, [r, g, b]: Ingredient["weight"]): void {
  for (let i = 0; i < sum.length; i += 4) {
    sum[i]! += r * part[i]!;
    sum[i + 1]! += g * part[i + 1]!;
    sum[i + 2]! += b * part[i + 2]!;
    sum[i + 3] = part[i + 3]!;
  }
}
