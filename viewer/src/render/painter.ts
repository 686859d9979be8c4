// Basis images on the graphics card, and recipes made from them.
//
// Each material has a layer of one array texture: its picture under the present light and camera, as a running mean
// over samples. All materials use the same points, and no density depends on t, so a recipe's picture is a weighted sum of
// layers: moving t is one pass of dot products, without noise starting over.

import * as THREE from "three";

import type { PointLight } from "../api/schema";
import { type Ingredient, namesIn } from "../recipe";
import { TONES, type Tone, turnedAbout, type View } from "../scene";
import { NoCardError, toRenderer } from "./card";
import type { Environment } from "./environment";
import { type Layer, Layers } from "./layers";
import { SAMPLES_TO_SHOW } from "./quality";
import { compositeShader, environmentShader, MAX_TERMS, Pass, pointsShader } from "./shaders";
import { Stage } from "./stage";
import { isFiner, type TableOnCard, type Tables, whiteTable } from "./tables";

/** Under an environment, and under points. */
const TARGET_SAMPLES = [384, 128] as const;
const LAYER_BYTES = 400e6;
const MIN_LAYERS = 24;
/** Samples are added as a running mean: the new one counts `blendAlpha`. */
const RUNNING_MEAN = {
  blending: THREE.CustomBlending,
  blendSrc: THREE.ConstantAlphaFactor,
  blendDst: THREE.OneMinusConstantAlphaFactor,
  transparent: true,
} as const;
/** What is enough to be timed, in milliseconds; and the part of the picture that is tried first. */
const TIMED = 8;
const FIRST_PART = 1 / 64;

const NOTHING: Ingredient = { name: "", weight: [0, 0, 0] };

/** What is to be seen: a recipe, another one to the right of `split`, and how bright. */
export interface Shown {
  readonly recipe: readonly Ingredient[];
  readonly other: readonly Ingredient[];
  readonly split: number;
  /** Factor of the light. */
  readonly exposure: number;
  readonly tone: Tone;
}

export class Painter {
  private readonly stage = new Stage();
  private readonly renderer: THREE.WebGLRenderer;
  private target: THREE.WebGLArrayRenderTarget | null = null;
  private layers = new Layers(0);
  /** Where shaders are tried. */
  private readonly trial = layerTarget(1, 1, 1);
  private readonly white = whiteTable();
  /** The sample whose geometry the stage's buffer holds. */
  private buffered = -1;
  private shown: readonly [readonly Ingredient[], readonly Ingredient[]] = [[], []];
  /** How often another recipe came to be shown. */
  changes = 0;
  private readonly points: Pass;
  private readonly environment: Pass;
  private readonly composite = new Pass(compositeShader, { blending: THREE.NoBlending });
  /** That of the present light. */
  private pass: Pass;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly tables: Tables,
    private readonly lights: readonly PointLight[],
  ) {
    this.renderer = toRenderer({
      canvas,
      alpha: true,
      antialias: false,
      preserveDrawingBuffer: true,
    });
    this.renderer.autoClear = false;
    this.renderer.setPixelRatio(1);
    const needed = ["EXT_color_buffer_float", "EXT_float_blend"];
    if (!needed.every((extension) => this.renderer.extensions.has(extension)))
      throw new NoCardError(`This browser cannot draw into float textures (${needed.join(", ")}).`);
    const [uNormal, uPosition] = this.stage.target.textures;
    const surface = { uNormal, uPosition, uEye: this.stage.camera.position };
    this.environment = new Pass(environmentShader(tables.grid), RUNNING_MEAN).set(surface);
    this.points = new Pass(pointsShader(tables.grid), RUNNING_MEAN).set({
      ...surface,
      uLights: this.lightsAt(0),
      uIntensities: lights.map(({ intensity }) => intensity),
    });
    this.pass = this.environment;
  }

  dispose(): void {
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Another size, for so many materials at least: all pictures begin anew, and the canvas is empty until one is shown. */
  resize(width: number, height: number, least = MIN_LAYERS): void {
    this.renderer.setSize(width, height, false);
    this.stage.resize(width, height);
    this.target?.dispose();
    const fitting = Math.floor(LAYER_BYTES / (16 * width * height));
    const nLayers = Math.min(MAX_TERMS, Math.max(least, fitting));
    this.target = layerTarget(width, height, nLayers);
    this.composite.set({ uBasis: this.target.texture });
    this.layers = new Layers(nLayers);
    this.shown = [[], []];
    this.buffered = -1;
  }

  hasSize(width: number, height: number): boolean {
    return this.target?.width === width && this.target.height === height;
  }

  /** Have the card compile what a light needs (null: the three points), drawing one pixel; the page is not kept waiting. */
  async prepare(environment: Environment | null): Promise<void> {
    const pass = environment === null ? this.points : this.environment;
    await Promise.all([this.stage.sphere, pass, this.composite].map((each) => each.compile(this.renderer)));
    // Some cards leave the better part to the first drawing, and do it for each way of blending anew.
    for (const samples of [0, 1]) this.draw(pass, this.white, samples, this.trial, 0);
    const isDone = this.fence();
    while (!isDone()) await new Promise((resolve) => setTimeout(resolve, 4));
  }

  /** Look from elsewhere, at something else or in another light (null: the three points): all samples start over. */
  look(view: View, environment: Environment | null): void {
    this.stage.look(view);
    this.pass = environment === null ? this.points : this.environment;
    const { occluder } = this.stage;
    this.points.set({ uLights: this.lightsAt(view.turn) });
    this.pass.set({
      uGrain: (view.grain * Math.PI) / 180,
      uBoxes: occluder?.boxes ?? null,
      uTriangles: occluder?.triangles ?? null,
      uBoxCount: occluder?.nBoxes ?? 0,
    });
    if (environment !== null) {
      const { picture, rows, chances } = environment;
      this.environment.set({
        uEnv: picture,
        uEnvRows: rows,
        uEnvChances: chances,
        uEnvTurn: view.turn / 360,
      });
    }
    this.restart();
  }

  private lightsAt(degrees: number): THREE.Vector3[] {
    return this.lights.map(({ at }) => new THREE.Vector3(...turnedAbout(at, degrees)));
  }

  get targetSamples(): number {
    return TARGET_SAMPLES[this.pass === this.points ? 1 : 0];
  }

  /** The samples of each of these materials whose table has come. */
  samples(names: readonly string[]): number[] {
    return names.filter((name) => this.tables.get(name)).map((name) => this.layers.samples([name]));
  }

  /**
   * Add up to so many pieces, each a share of a sample, to the layer that has the fewest samples; how many were added before
   * all had enough.
   */
  improve(names: readonly string[], pieces: number, share: number, target: number): number {
    const staying = [...names, ...namesIn(...this.shown)];
    const rows = Math.ceil(share * (this.target?.height ?? 0));
    for (let piece = 0; piece < pieces; piece++) {
      const next = this.neediest(names, target, staying);
      if (next === undefined) return piece;
      this.addRows(next.layer, next.table, rows);
    }
    return pieces;
  }

  /** Tells whether the card has done what it was told until now. */
  fence(): () => boolean {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    let sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return () => {
      // Of a lost context there is nothing to wait for.
      if (sync && gl.clientWaitSync(sync, 0, 0) === gl.TIMEOUT_EXPIRED) return false;
      if (sync) gl.deleteSync(sync);
      sync = null;
      return true;
    };
  }

  /** Milliseconds of a pass over the present picture, of a part that takes long enough to be timed; the card is waited for. */
  measure(): number {
    // The first drawing of an object is none to go by.
    this.time(FIRST_PART);
    let part = FIRST_PART;
    let milliseconds = this.time(part);
    while (milliseconds < TIMED && part < 1) {
      part *= 4;
      milliseconds = this.time(part);
    }
    this.restart();
    return milliseconds / part;
  }

  /** Whether the present pictures make one of `wanted`, or of what was shown before, which then stays. */
  show(wanted: Shown): boolean {
    if (
      wanted.recipe.length > 0 &&
      this.layers.samples(namesIn(wanted.recipe, wanted.other)) >= this.least(wanted)
    ) {
      if (wanted.recipe !== this.shown[0]) this.changes++;
      this.shown = [wanted.recipe, wanted.other];
    }
    const [recipe, other] = this.shown;
    // All samples may just have started over: the last picture stays until each material has one again. Before the first
    // picture an empty one is drawn all the same, for a card begins with the samples when the canvas is drawn on.
    if (this.layers.samples(namesIn(recipe, other)) === 0) return false;
    this.composite.set({
      uTerms: this.terms(recipe),
      uOtherTerms: this.terms(other),
      uCount: Math.min(recipe.length, MAX_TERMS),
      uOtherCount: Math.min(other.length, MAX_TERMS),
      uSplit: (other.length ? wanted.split : 1) * this.target!.width,
      toneMappingExposure: wanted.exposure,
      uTone: TONES.indexOf(wanted.tone),
    });
    this.composite.draw(this.renderer, null);
    return recipe.length > 0;
  }

  /** Samples that what is wanted needs to be shown: as many as are not noisy where it is the same in a finer table. */
  private least({ recipe, other }: Shown): number {
    const before = namesIn(...this.shown);
    const isSame = namesIn(recipe, other).some((name) => before.some((each) => isFiner(name, each)));
    return isSame && this.layers.samples(before) > 0 ? Math.min(SAMPLES_TO_SHOW, this.targetSamples) : 1;
  }

  /** Weights and layers, as many as the shader has. */
  private terms(recipe: readonly Ingredient[]): THREE.Vector4[] {
    return Array.from({ length: MAX_TERMS }, (_, i) => {
      const {
        name,
        weight: [r, g, b],
      } = recipe[i] ?? NOTHING;
      return new THREE.Vector4(r, g, b, this.layers.get(name)?.index ?? 0);
    });
  }

  private restart(): void {
    this.buffered = -1;
    this.layers.restart();
  }

  private neediest(names: readonly string[], target: number, staying: readonly string[]) {
    let best: { layer: Layer; table: TableOnCard } | undefined;
    for (const name of names) {
      const table = this.tables.get(name);
      const layer = table && this.layers.obtain(name, staying);
      if (!table || !layer || layer.samples >= target) continue;
      if (best === undefined || layer.samples < best.layer.samples) best = { layer, table };
    }
    return best;
  }

  private addRows(layer: Layer, table: TableOnCard, atMost: number): void {
    const { width, height, scissor } = this.target!;
    if (this.buffered !== layer.samples) {
      this.buffered = layer.samples;
      // The middle of the pixel first: the picture while orbiting does not shake.
      this.stage.draw(this.renderer, jitter(layer.samples, 0), jitter(layer.samples, 1));
    }
    const rows = Math.min(atMost, height - layer.rows);
    scissor.set(0, layer.rows, width, rows);
    this.draw(this.pass, table, layer.samples, this.target!, layer.index);
    this.layers.add(layer, rows, height);
  }

  /** Add one sample of a table to the mean of `samples` in a layer. */
  private draw(
    pass: Pass,
    { texture, scale, turns, lobe, lobeTurns }: TableOnCard,
    samples: number,
    target: THREE.WebGLArrayRenderTarget,
    index: number,
  ): void {
    pass.set({ uTable: texture, uScale: scale, uTurns: turns });
    if (pass === this.environment) pass.set({ uLobe: lobe, uLobeTurns: lobeTurns, uSample: samples });
    pass.material.blending = samples === 0 ? THREE.NoBlending : THREE.CustomBlending;
    pass.material.blendAlpha = 1 / (samples + 1);
    pass.draw(this.renderer, target as never, index);
  }

  /** Milliseconds that the middle rows of a white material take, in a layer that starts over. */
  private time(part: number): number {
    const gl = this.renderer.getContext();
    const { height } = this.target!;
    const rows = Math.ceil(part * height);
    const first = Math.floor((height - rows) / 2);
    const start = performance.now();
    this.addRows({ index: 0, samples: 0, rows: first, used: 0 }, this.white, rows);
    gl.readPixels(0, first, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array(4));
    return performance.now() - start;
  }
}

function layerTarget(width: number, height: number, depth: number): THREE.WebGLArrayRenderTarget {
  const target = new THREE.WebGLArrayRenderTarget(width, height, depth, {
    type: THREE.FloatType,
    format: THREE.RGBAFormat,
    minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
    depthBuffer: false,
  });
  target.scissorTest = true;
  return target;
}

/** 2^32 times the fractions of the square roots of 2 and 3: independent of the steps that the shaders take (STEPS). */
const JITTER = [0x6a09e667, 0xbb67ae85] as const;

/** The i-th point of a two-dimensional additive recurrence, shifted to start in the middle. */
function jitter(i: number, dimension: 0 | 1): number {
  return ((Math.imul(i, JITTER[dimension]) + 0x80000000) >>> 0) / 4294967296;
}
