// Small pictures of all materials, mixed on the processor: a recipe's picture before any table has come.

import type { Client, Pictures } from "./api/client";
import type { RecipeDocument } from "./api/schema";
import { bodyScale, type Mixing, PLAIN, picturesMix } from "./blend";
import { toByte } from "./colour";
import { el } from "./dom";
import { pauseAfter } from "./paced";
import { type Ingredient, toDocument } from "./recipe";
import { addTo, toScreen, valueAt } from "./rgbe";

/** Pictures of mixes that are asked for together, and that are kept: 16 KB each. */
const AT_ONCE = 64;
const MAX_MIXES = 256;

export class Thumbnails {
  size = 64;
  /** Told what failed, and null when it did not. */
  onProblem: (problem: string | null) => void = () => {};
  private byName: ReadonlyMap<string, Uint8Array> = new Map();
  /** Canvases made before the pictures came, on the page or not. */
  private readonly blank = new Map<HTMLCanvasElement, string>();
  private readonly averaged = new Map<string, Float32Array>();

  /** Pictures of mixes that are not made of the materials' own, those asked for last at the end; null: being made. */
  private readonly mixes = new Map<string, Uint8Array | null>();
  /** Those to be asked for, and who waits for them. */
  private missing: RecipeDocument[] = [];
  private readonly waiting = new Set<() => void>();
  private failures = 0;

  constructor(
    private readonly names: readonly string[],
    private readonly library: string,
    private readonly make: Client["thumbnailsOf"],
    private readonly gone: AbortSignal,
  ) {}

  /** The pictures have come. */
  fill(pictures: Pictures): void {
    const [, size = 0] = pictures.shape;
    this.size = size;
    this.byName = new Map(this.names.map((name, i) => [name, pictureIn(pictures, i, size)]));
    for (const [canvas, name] of this.blank) this.paint(canvas, name);
    this.blank.clear();
  }

  /** The picture of a recipe, ready for a canvas; until it is made the linear one stands in, and `then` runs when it is. */
  picture(recipe: readonly Ingredient[], mixing: Mixing = PLAIN, then: () => void = () => {}): ImageData {
    const own = this.ofMix(recipe, mixing, then);
    return this.disc(own ? toScreen(own) : this.sum(recipe));
  }

  of(name: string): ImageData {
    const picture = this.byName.get(name) ?? new Uint8Array(4 * this.size * this.size);
    return this.disc(toScreen(picture));
  }

  private disc(bytes: Uint8ClampedArray<ArrayBuffer>): ImageData {
    for (let i = 3; i < bytes.length; i += 4) bytes[i]! *= this.edge((i - 3) / 4);
    return new ImageData(bytes, this.size, this.size);
  }

  private sum(recipe: readonly Ingredient[]): Uint8ClampedArray<ArrayBuffer> {
    const sum = new Float32Array(4 * this.size * this.size);
    for (const { name, weight } of recipe) {
      const part = this.byName.get(name);
      if (part !== undefined) addTo(sum, part, weight);
    }
    return Uint8ClampedArray.from(sum, (x, i) => (i % 4 === 3 ? 255 * x : toByte(x)));
  }

  /** The picture of a mix; null where it is the sum of its materials', or is not there, and is asked for. */
  private ofMix(recipe: readonly Ingredient[], mixing: Mixing, then: () => void): Uint8Array | null {
    // In every blend one material is itself.
    if (picturesMix(mixing) || (recipe.length < 2 && bodyScale(mixing) === null)) return null;
    const document = toDocument(this.library, recipe, mixing);
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
      const pictures = await this.make(asked);
      keys.forEach((key, i) => {
        this.mixes.set(key, pictureIn(pictures, i, this.size));
      });
    } catch (error) {
      this.fail(keys, error as Error);
      return;
    }
    this.failures = 0;
    this.onProblem(null);
    for (const [key] of [...this.mixes].slice(0, -MAX_MIXES)) this.mixes.delete(key);
    this.drawAgain();
  }

  /** The linear pictures stay, until who waits draws again and so asks again: later each time that it fails. */
  private fail(keys: readonly string[], { name, message }: Error): void {
    if (this.gone.aborted || name === "AbortError") return;
    this.onProblem(`Small pictures of mixes did not come (${message}): they are asked for again.`);
    const again = () => {
      for (const key of keys) this.mixes.delete(key);
      if (!this.gone.aborted) this.drawAgain();
    };
    setTimeout(again, pauseAfter(this.failures++));
  }

  private drawAgain(): void {
    const waiting = [...this.waiting];
    this.waiting.clear();
    for (const then of waiting) then();
  }

  /** The picture of a recipe averaged to `n` x `n` blocks, linear RGB one after another; of another mixing as `picture`. */
  blocks(
    recipe: readonly Ingredient[],
    n: number,
    mixing: Mixing = PLAIN,
    then: () => void = () => {},
  ): Float32Array {
    const own = this.ofMix(recipe, mixing, then);
    if (own) return this.average(own, n);
    const sum = new Float32Array(3 * n * n);
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

  /** A canvas with the picture of one material. */
  canvas(name: string): HTMLCanvasElement {
    const canvas = el("canvas.thumbnail");
    if (this.byName.size > 0) this.paint(canvas, name);
    else this.blank.set(canvas, name);
    return canvas;
  }

  paint(canvas: HTMLCanvasElement, name: string): void {
    canvas.width = canvas.height = this.size;
    canvas.getContext("2d")!.putImageData(this.of(name), 0, 0);
  }

  private blocksOf(name: string, n: number): Float32Array {
    const key = `${n} ${name}`;
    const known = this.averaged.get(key);
    if (known !== undefined) return known;
    const picture = this.byName.get(name);
    if (picture === undefined) return new Float32Array(3 * n * n);
    const blocks = this.average(picture, n);
    this.averaged.set(key, blocks);
    return blocks;
  }

  private average(picture: Uint8Array, n: number): Float32Array {
    const blocks = new Float32Array(3 * n * n);
    const share = (n / this.size) ** 2;
    for (let pixel = 0; pixel < this.size * this.size; pixel++) {
      const x = Math.floor(((pixel % this.size) * n) / this.size);
      const y = Math.floor((Math.floor(pixel / this.size) * n) / this.size);
      for (let c = 0; c < 3; c++) blocks[3 * (y * n + x) + c]! += share * valueAt(picture, pixel, c);
    }
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

/** The i-th of the pictures. */
function pictureIn({ bytes }: Pictures, i: number, size: number): Uint8Array {
  const n = 4 * size * size;
  return bytes.subarray(i * n, (i + 1) * n);
}
