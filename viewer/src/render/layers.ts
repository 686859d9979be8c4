// Which layer of the array texture has whose picture, and how many samples are in it.

export interface Layer {
  readonly index: number;
  samples: number;
  /** Rows that the next sample has already. */
  rows: number;
  used: number;
}

export class Layers {
  private readonly byName = new Map<string, Layer>();
  private clock = 0;

  constructor(private readonly count: number) {}

  get(name: string): Layer | undefined {
    return this.byName.get(name);
  }

  /** The fewest samples that any of these materials has; infinitely many of none. */
  samples(names: readonly string[]): number {
    return Math.min(...names.map((name) => this.byName.get(name)?.samples ?? 0));
  }

  /** Its own layer, a free one, or that of the material used longest ago that is not to stay; undefined where all are to. */
  obtain(name: string, staying: readonly string[]): Layer | undefined {
    const own = this.byName.get(name);
    if (own !== undefined) return own;
    const index = this.byName.size < this.count ? this.byName.size : this.release(staying);
    if (index === undefined) return undefined;
    const layer = { index, samples: 0, rows: 0, used: this.clock++ };
    this.byName.set(name, layer);
    return layer;
  }

  /** The next sample has so many rows more, of `height`. */
  add(layer: Layer, rows: number, height: number): void {
    layer.used = this.clock++;
    layer.rows += rows;
    if (layer.rows < height) return;
    layer.samples++;
    layer.rows = 0;
  }

  /** All samples start over. */
  restart(): void {
    for (const layer of this.byName.values()) layer.samples = layer.rows = 0;
  }

  private release(staying: readonly string[]): number | undefined {
    const spare = [...this.byName].filter(([name]) => !staying.includes(name));
    const [oldest] = spare.sort(([, a], [, b]) => a.used - b.used);
    if (oldest === undefined) return undefined;
    this.byName.delete(oldest[0]);
    return oldest[1].index;
  }
}
