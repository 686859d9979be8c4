// The samples of materials for a plot: made once for each, some milliseconds at a time, and mixed by weights.

import type { Table } from "../../brdf/table";
import type { Ingredient } from "../../recipe";
import type { Plot } from "./plot";

/** Materials whose samples are kept; the largest, a slice of the MERL grid, take 200 KB each. */
const MAX_KEPT = 64;

interface Kept {
  readonly values: Float64Array;
  steps: number;
}

export class Samples {
  private key = "";
  private kept = new Map<string, Kept>();

  /** Work for about so long; the share that is done, 1 when `mix` has all it needs. */
  make(
    plot: Plot,
    recipe: readonly Ingredient[],
    table: (name: string) => Table | undefined,
    milliseconds: number,
  ): number {
    if (plot.key !== this.key || this.kept.size > MAX_KEPT) {
      this.key = plot.key;
      this.kept = new Map();
    }
    const end = performance.now() + milliseconds;
    let done = 0;
    for (const { name } of recipe) {
      const from = table(name);
      if (from === undefined) continue;
      const own = this.kept.get(name) ?? { values: new Float64Array(plot.length), steps: 0 };
      this.kept.set(name, own);
      while (own.steps < plot.nSteps && performance.now() < end) plot.fill(from, own.values, own.steps++);
      done += own.steps;
    }
    return done / (recipe.length * plot.nSteps);
  }

  mix(plot: Plot, recipe: readonly Ingredient[]): Float64Array {
    const sum = new Float64Array(plot.length);
    for (const { name, weight } of recipe) {
      const { values } = this.kept.get(name)!;
      for (let i = 0; i < sum.length; i += 3) {
        sum[i]! += weight[0] * values[i]!;
        sum[i + 1]! += weight[1] * values[i + 1]!;
        sum[i + 2]! += weight[2] * values[i + 2]!;
      }
    }
    return sum;
  }
}
