// What the page asks for, whoever answers: a server (`http`), a folder of files (`files`), or a notebook's kernel (`kernel`).

import type {
  AlikeView,
  AttributesView,
  FoundView,
  LegView,
  LibrarySummary,
  PerceptionView,
  PositionView,
  ProgressView,
  RecipeDocument,
  SpaceView,
  Wanted,
} from "./schema";

/** A failure that a person can act on, in one line that says how. */
export class Problem extends Error {}

/** What is not to be had now, and is asked for again: it is being computed, or nobody answers. */
export class Later extends Problem {
  constructor(
    message: string,
    /** Whether it is being computed, and how far that is; else nobody answers. */
    readonly computed = false,
    readonly progress: ProgressView | null = null,
  ) {
    super(message);
  }
}

/** Half floats for the graphics card. */
export interface Block {
  readonly halfs: Uint16Array<ArrayBuffer>;
  readonly shape: readonly number[];
  readonly scale: readonly [number, number, number];
}

/** Small pictures with shared exponents: see `rgbe`. */
export interface Pictures {
  readonly bytes: Uint8Array<ArrayBuffer>;
  /** How many, rows, columns, 4. */
  readonly shape: readonly number[];
}

/** A file, and a line on how well it stands for the table where it is not the table. */
export interface Exported {
  readonly file: Blob;
  readonly summary: string;
}

/** What the page asks for; every failure that a person can act on is a `Problem`. */
export interface Client {
  readonly library: () => Promise<LibrarySummary>;
  readonly spaceView: (space: string, blend: string) => Promise<SpaceView>;
  /** The way from one material to another that comes after it in the library; with this pace among its own. */
  readonly leg: (
    space: string,
    blend: string,
    start: string,
    stop: string,
    pace: string,
    signal: AbortSignal,
  ) => Promise<LegView>;
  /** The material at a point of a space that has points. */
  readonly at: (
    space: string,
    blend: string,
    point: readonly number[],
    signal: AbortSignal,
  ) => Promise<PositionView>;
  /** What instruments read off all materials. */
  readonly attributes: () => Promise<AttributesView>;
  /** The recipe that is like another and has some attributes; who cannot has no such function. */
  readonly find?: (wanted: Wanted, signal: AbortSignal) => Promise<FoundView>;
  /** How different people would find each material from a recipe, in the library's order. */
  readonly alike: (recipe: RecipeDocument) => Promise<AlikeView>;
  /** How people would perceive a recipe; who cannot has no such function. */
  readonly perceived?: (recipe: RecipeDocument, signal: AbortSignal) => Promise<PerceptionView>;
  readonly thumbnails: () => Promise<Pictures>;
  readonly environment: () => Promise<Block>;
  /** One material's table; `onProgress` is told the share that has come, in [0, 1]. */
  readonly table: (name: string, onProgress?: (share: number) => void) => Promise<Block>;
  /** The table of a recipe, in full or small (the library's `small_grid`). */
  readonly mixed: (recipe: RecipeDocument, small: boolean, signal: AbortSignal) => Promise<Block>;
  /** Pictures of recipes, as those of the materials. */
  readonly thumbnailsOf: (recipes: readonly RecipeDocument[]) => Promise<Pictures>;
  /** A recipe's file, in one of the library's `exports`. */
  readonly exported: (format: string, recipe: RecipeDocument) => Promise<Exported>;
  /** Takes a file of a measurement in, as a material of the library from now on; who cannot has no such function. */
  readonly add?: (file: File) => Promise<string>;
}
