// The table of a mix whose pictures do not mix, made by whoever answers: small while something moves, then in full.
//
// One question at a time. What is wanted when an answer has come is asked for next, so nothing is ever queued; the full table is
// asked for when nothing has moved for a while, and taken back when something does.

import type { Block } from "./api/client";
import type { RecipeDocument } from "./api/schema";

/** Milliseconds without a change after which the full table is asked for. */
const STILL = 250;

export interface Asking {
  readonly table: (recipe: RecipeDocument, small: boolean, signal: AbortSignal) => Promise<Block>;
  /** A table has come; the one of before is to be seen until it is drawn. */
  readonly onTable: (block: Block, small: boolean) => void;
  /** Whether what came last is not the full table of what is wanted. */
  readonly onBehind: (behind: boolean) => void;
  /** What failed, and null when it did not. */
  readonly onProblem: (problem: string | null) => void;
}

export class MixedTable {
  private wanted: RecipeDocument | null = null;
  private running = false;
  /** What only makes sense while nothing moves. */
  private still = new AbortController();

  constructor(private readonly asking: Asking) {}

  /** What is to be seen from now on; null for nothing. */
  want(recipe: RecipeDocument | null): void {
    if (JSON.stringify(recipe) === JSON.stringify(this.wanted)) return;
    this.wanted = recipe;
    this.still.abort();
    this.asking.onBehind(recipe !== null);
    if (!this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    let recipe = this.wanted;
    while (recipe !== null) {
      this.still = new AbortController();
      const came = await this.fetch(recipe, true, new AbortController().signal);
      if (came && this.wanted === recipe) await this.refine(recipe, this.still.signal);
      if (this.wanted === recipe) break;
      recipe = this.wanted;
    }
    this.running = false;
  }

  private async refine(recipe: RecipeDocument, moved: AbortSignal): Promise<void> {
    await new Promise((resolve) => {
      const timer = setTimeout(resolve, STILL);
      moved.addEventListener("abort", () => {
        clearTimeout(timer);
        resolve(null);
      });
    });
    if (moved.aborted) return;
    if (await this.fetch(recipe, false, moved)) this.asking.onBehind(false);
  }

  /** Whether a table came. */
  private async fetch(recipe: RecipeDocument, small: boolean, signal: AbortSignal): Promise<boolean> {
    try {
      const block = await this.asking.table(recipe, small, signal);
      if (this.wanted === null || signal.aborted) return false;
      this.asking.onTable(block, small);
      this.asking.onProblem(null);
      return true;
    } catch (error) {
      if (!signal.aborted) this.asking.onProblem((error as Error).message);
      return false;
    }
  }
}
