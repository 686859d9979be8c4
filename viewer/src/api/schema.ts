// Written by viewer/scripts/make_types.py from halfway.server.schema. Do not edit.

/** What went wrong, in one line that says what to do. */
export interface Problem {
  readonly error: string;
}

/** How far what is being computed is. */
export interface ProgressView {
  readonly label: string;
  readonly done: number;
  readonly total: number;
  readonly seconds: number;
}

/** An answer that is still being computed: ask again. */
export interface NotYet {
  readonly error: string;
  readonly progress: ProgressView | null;
}

/** One measured material of the library. */
export interface Material {
  readonly name: string;
}

/** One axis of the grid; see `halfway.halfdiff.Axis`. */
export interface Axis {
  readonly angle: string;
  readonly size: number;
  readonly stop: number;
  readonly power: number;
  readonly periodic: boolean;
}

/** A space that routes can go through. */
export interface SpaceSummary {
  readonly name: string;
  readonly text: string;
  readonly usual_blend: string;
}

/** A point light; world coordinates have z up, y away from the camera. */
export interface PointLight {
  readonly at: readonly [number, number, number];
  readonly intensity: number;
}

/** What is being explored. */
export interface LibrarySummary {
  readonly format: 1;
  readonly version: string;
  readonly name: string;
  readonly address: string;
  readonly description: string;
  readonly source: string;
  readonly licence: string;
  readonly checksum: string;
  readonly grid: readonly Axis[];
  readonly small_grid: readonly Axis[];
  readonly materials: readonly Material[];
  readonly spaces: readonly SpaceSummary[];
  readonly blends: readonly string[];
  readonly paces: readonly string[];
  readonly lights: readonly PointLight[];
  readonly exports: readonly string[];
  readonly recolours: boolean;
  readonly notice: string;
}

/** The materials as points, whose first three coordinates can be looked at. */
export interface EmbeddingView {
  readonly name: string;
  readonly channel: "r" | "g" | "b" | "all";
  readonly axes: readonly string[];
  readonly points: readonly (readonly number[])[];
  readonly edges: readonly (readonly [number, number])[];
}

/** A space, to be looked at: one embedding, or one per channel. */
export interface SpaceView {
  readonly name: string;
  readonly has_points: boolean;
  readonly embeddings: readonly EmbeddingView[];
}

/** Weights at the knots of a leg, per channel: ``[knot][name]``. */
export interface WeightTable {
  readonly r: readonly (readonly number[])[];
  readonly g: readonly (readonly number[])[];
  readonly b: readonly (readonly number[])[];
}

/** How far a leg has come, at some t of it; linear between. */
export interface PaceView {
  readonly t: readonly number[];
  readonly length: readonly number[];
}

/** The way from one material to another in a space, as weights at knots between which they are linear in t. */
export interface LegView {
  readonly names: readonly string[];
  readonly knots: readonly number[];
  readonly weights: WeightTable;
  readonly paces: Readonly<Record<string, PaceView>>;
}

/** A recipe's weights where the channels differ. */
export interface ChannelWeights {
  readonly r: Readonly<Record<string, number>>;
  readonly g: Readonly<Record<string, number>>;
  readonly b: Readonly<Record<string, number>>;
}

/** A recipe: barycentric weights over materials, how they are mixed, and what the body of that is multiplied by. */
export interface RecipeDocument {
  readonly library: string;
  readonly blend: string;
  readonly weights: ChannelWeights | Readonly<Record<string, number>>;
  readonly body_scale?: readonly [number, number, number] | null;
}

/** A point of a space: the coordinates of its embeddings, one embedding after another. */
export interface Point {
  readonly space: string;
  readonly blend?: string | null;
  readonly point: readonly number[];
}

/** The material at a point of a space. */
export interface PositionView {
  readonly recipe: RecipeDocument;
  readonly point: readonly number[];
  readonly inside: boolean;
}

/** An attribute, and its values over the library; see `halfway.instruments`. */
export interface AttributeView {
  readonly name: string;
  readonly label: string;
  readonly unit: string;
  readonly needs: string;
  readonly values: readonly (number | null)[];
}

/** The attributes that are one number. */
export interface AttributesView {
  readonly attributes: readonly AttributeView[];
}

/** A recipe that is like another one, and has these attributes and perceived qualities. */
export interface Wanted {
  readonly like: RecipeDocument;
  readonly set: Readonly<Record<string, number | string>>;
  readonly release: readonly string[];
  readonly ranges: readonly string[];
  readonly draft: boolean;
}

/** An attribute that should have stayed what it was. */
export interface GivenUp {
  readonly name: string;
  readonly was: string;
  readonly now: string;
}

/** The recipe that misses least of what is wanted. */
export interface FoundView {
  readonly recipe: RecipeDocument;
  readonly attributes: Readonly<Record<string, number | null>>;
  readonly missed: readonly string[];
  readonly body: string;
  readonly difference: number | null;
  readonly given_up: readonly GivenUp[];
  readonly ranges: Readonly<Record<string, readonly [number, number]>>;
}

/** How different people would find each material from a recipe; see `halfway.people.Impressions`. */
export interface AlikeView {
  readonly distances: readonly number[];
}

/** How a material is perceived in one respect; see `halfway.people.Perceived`. */
export interface PerceivedView {
  readonly name: string;
  readonly value: number;
  readonly trust: string;
}

/** How people would perceive a recipe. */
export interface PerceptionView {
  readonly perceived: readonly PerceivedView[];
}

/** A measurement that is a material of the library now. */
export interface Added {
  readonly name: string;
}

/** How different people would find each two materials of a static explorer. */
export interface AlikeFile {
  readonly distances: readonly (readonly number[])[];
}

/** What a file of numbers holds; see `halfway.server.blocks`. */
export interface BlockFile {
  readonly shape: readonly number[];
  readonly scale: readonly [number, number, number];
}

/** A static explorer: the library, and what its files hold (see `halfway.server.static`). */
export interface Folder {
  readonly format: 1;
  readonly library: LibrarySummary;
  readonly thumbnails: BlockFile;
  readonly environment: BlockFile;
  readonly tables: readonly BlockFile[];
}

/** The simplices between the materials in one chart of a space. */
export interface ChartView {
  readonly simplices: readonly (readonly number[])[];
  readonly barycentric: readonly (readonly (readonly number[])[])[];
}

/** The charts of a space of a static explorer: one for all channels, or one for each. */
export interface ChartsFile {
  readonly charts: readonly ChartView[];
}
