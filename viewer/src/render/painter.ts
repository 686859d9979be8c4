// Basis images on the graphics card, and recipes made from them.
//
// Each material has a layer of one array texture: its picture under the present light and camera, as a running mean
// over samples. All materials use the same points, and no density depends on t, so a recipe's picture is a weighted sum of
// layers: moving t is one pass of dot products, without noise starting over.

import {
  type BufferGeometry,
  ConstantAlphaFactor,
  CustomBlending,
  FloatType,
  NearestFilter,
  NoBlending,
  OneMinusConstantAlphaFactor,
  RGBAFormat,
  Vector3,
  Vector4,
  WebGLArrayRenderTarget,
  WebGLRenderer,
} from "three";

import type { PointLight } from "../api/schema";
import type { Ingredient } from "../recipe";
import type { Environment } from "./environment";
import { compositeShader, environmentShader, MAX_TERMS, Pass, pointsShader } from "./shaders";
import { type Orbit, type Shape, Stage } from "./stage";
import { type TableOnCard, type Tables, whiteTable } from "./tables";

/** Under an environment, and under points. */
const TARGET_SAMPLES = [384, 128] as const;
const LAYER_BYTES = 400e6;
const MIN_LAYERS = 24;

interface Layer {
  readonly index: number;
  samples: number;
  used: number;
}

interface Shown {
  readonly recipe: readonly Ingredient[];
  readonly other: readonly Ingredient[];
  readonly names: readonly string[];
}

export class Painter {
  readonly stage = new Stage();
  private readonly renderer: WebGLRenderer;
  private target: WebGLArrayRenderTarget | null = null;
  private readonly layers = new Map<string, Layer>();
  private readonly white = whiteTable();
  private clock = 0;
  private buffered = -1;
  private shown: Shown = { recipe: [], other: [], names: [] };
  private readonly points: Pass;
  private readonly environment: Pass;
  private readonly composite: Pass;
  /** That of the present light. */
  private pass: Pass;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly tables: Tables,
    lights: readonly PointLight[],
  ) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: false, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    if (
      !this.renderer.extensions.has("EXT_color_buffer_float") ||
      !this.renderer.extensions.has("EXT_float_blend")
    ) {
      throw new Error(
        "This browser cannot draw into float textures (EXT_color_buffer_float, EXT_float_blend).",
      );
    }
    const shared = () => ({
      uTable: { value: null },
      uScale: { value: new Vector3() },
      uNormal: { value: this.stage.target.textures[0] },
      uPosition: { value: this.stage.target.textures[1] },
      uEye: { value: this.stage.camera.position },
      uBoxes: { value: null },
      uTriangles: { value: null },
      uBoxCount: { value: 0 },
    });
    const accumulate = {
      blending: CustomBlending,
      blendSrc: ConstantAlphaFactor,
      blendDst: OneMinusConstantAlphaFactor,
      transparent: true,
    } as const;
    this.points = new Pass(
      pointsShader,
      {
        ...shared(),
        uLights: { value: lights.map(({ at: [x, y, z] }) => new Vector3(x, y, z)) },
        uIntensities: { value: lights.map(({ intensity }) => intensity) },
      },
      accumulate,
    );
    this.environment = new Pass(
      environmentShader,
      {
        ...shared(),
        uEnv: { value: null },
        uEnvRows: { value: null },
        uEnvChances: { value: null },
        uLobe: { value: null },
        uFirst: { value: 0 },
        uSamples: { value: 1 },
      },
      accumulate,
    );
    this.pass = this.environment;
    this.composite = new Pass(
      compositeShader,
      {
        uBasis: { value: null },
        uTerms: { value: Array.from({ length: MAX_TERMS }, () => new Vector4()) },
        uOtherTerms: { value: Array.from({ length: MAX_TERMS }, () => new Vector4()) },
        uCount: { value: 0 },
        uOtherCount: { value: 0 },
        uSplit: { value: 0 },
        uExposure: { value: 1 },
      },
      { blending: NoBlending },
    );
  }

  dispose(): void {
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  resize(width: number, height: number): void {
    if (this.target?.width === width && this.target.height === height) return;
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.stage.resize(width, height);
    this.target?.dispose();
    const nLayers = Math.min(
      MAX_TERMS,
      Math.max(MIN_LAYERS, Math.floor(LAYER_BYTES / (16 * width * height))),
    );
    this.target = new WebGLArrayRenderTarget(width, height, nLayers, {
      type: FloatType,
      format: RGBAFormat,
      minFilter: NearestFilter,
      magFilter: NearestFilter,
      depthBuffer: false,
    });
    this.composite.uniforms.uBasis!.value = this.target.texture;
    this.layers.clear();
    this.shown = { recipe: [], other: [], names: [] };
    this.buffered = -1;
  }

  get hasSize(): boolean {
    return this.target !== null;
  }

  /** Look from elsewhere, at something else or in another light (none: the three points): all samples start over. */
  look(shape: Shape, orbit: Orbit, mesh: BufferGeometry | null, environment: Environment | null): void {
    this.stage.look(shape, orbit, mesh);
    this.pass = environment === null ? this.points : this.environment;
    const { occluder } = this.stage;
    this.pass.uniforms.uBoxes!.value = occluder?.boxes ?? null;
    this.pass.uniforms.uTriangles!.value = occluder?.triangles ?? null;
    this.pass.uniforms.uBoxCount!.value = occluder?.nBoxes ?? 0;
    if (environment !== null) {
      this.environment.uniforms.uEnv!.value = environment.picture;
      this.environment.uniforms.uEnvRows!.value = environment.rows;
      this.environment.uniforms.uEnvChances!.value = environment.chances;
    }
    this.buffered = -1;
    for (const layer of this.layers.values()) layer.samples = 0;
  }

  /** The fewest samples that any of these materials has. */
  samples(names: readonly string[]): number {
    return Math.min(...names.map((name) => this.layers.get(name)?.samples ?? 0));
  }

  /** Whether the light is the three points, and not an environment: another shader. */
  get underPoints(): boolean {
    return this.pass === this.points;
  }

  get targetSamples(): number {
    return TARGET_SAMPLES[this.underPoints ? 1 : 0];
  }

  /** Add up to so many samples, each to the layer that has the fewest; how many were added before all had enough. */
  improve(names: readonly string[], passes: number, target = this.targetSamples): number {
    for (let pass = 0; pass < passes; pass++) {
      const next = this.neediest(names, target);
      if (next === undefined) return pass;
      this.addSamples(next.layer, next.table);
    }
    return passes;
  }

  /** Have the card compile what this light needs, drawing one pixel of a white table; the page is not kept waiting. */
  async warmUp(): Promise<void> {
    const passes = [this.stage.sphere, this.pass, this.composite];
    await Promise.all(passes.map((pass) => pass.compile(this.renderer)));
    // Some cards leave the better part to the first drawing, and do it for each way of blending anew.
    const target = this.target!;
    target.scissor.set(0, 0, 1, 1);
    target.scissorTest = true;
    const layer = this.scratch();
    for (let sample = 0; sample < 2; sample++) this.addSamples(layer, this.white);
    target.scissorTest = false;
    await finished(this.renderer.getContext() as WebGL2RenderingContext);
  }

  /** Milliseconds that one pass over a layer takes at the present size and in this light; the card is waited for. */
  measure(): number {
    const gl = this.renderer.getContext();
    const start = performance.now();
    this.addSamples(this.scratch(), this.white);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array(4));
    return performance.now() - start;
  }

  /** A layer to try things on: what is there of pictures starts over. */
  private scratch(): Layer {
    for (const layer of this.layers.values()) layer.samples = 0;
    this.buffered = -1;
    return { index: 0, samples: 0, used: 0 };
  }

  /** Show a recipe, and another one right of `split`; while a material has no picture yet, what was shown before stays. */
  show(recipe: readonly Ingredient[], other: readonly Ingredient[], split: number, exposure: number): void {
    const next = { recipe, other, names: [...recipe, ...other].map(({ name }) => name) };
    if (recipe.length > 0 && this.samples(next.names) > 0) this.shown = next;
    // All samples may just have started over: the last picture stays until each material has one again. Before the first
    // picture an empty one is drawn all the same, for a card begins with the samples when the canvas is drawn on.
    if (this.samples(this.shown.names) === 0) return;
    const { uniforms } = this.composite;
    uniforms.uCount!.value = this.fill(uniforms.uTerms!.value, this.shown.recipe);
    uniforms.uOtherCount!.value = this.fill(uniforms.uOtherTerms!.value, this.shown.other);
    uniforms.uSplit!.value = this.shown.other.length ? split * this.target!.width : this.target!.width;
    uniforms.uExposure!.value = exposure;
    this.composite.draw(this.renderer, null);
  }

  private fill(terms: readonly Vector4[], recipe: readonly Ingredient[]): number {
    recipe.slice(0, MAX_TERMS).forEach(({ name, weight: [r, g, b] }, i) => {
      terms[i]!.set(r, g, b, this.layers.get(name)!.index);
    });
    return Math.min(recipe.length, MAX_TERMS);
  }

  private neediest(
    names: readonly string[],
    target: number,
  ): { layer: Layer; table: TableOnCard } | undefined {
    let best: { layer: Layer; table: TableOnCard } | undefined;
    for (const name of names) {
      const table = this.tables.get(name);
      if (table === undefined) continue;
      const layer = this.layers.get(name) ?? this.newLayer(name, names);
      if (layer === undefined || layer.samples >= target) continue;
      if (best === undefined || layer.samples < best.layer.samples) best = { layer, table };
    }
    return best;
  }

  private newLayer(name: string, needed: readonly string[]): Layer | undefined {
    if (this.target === null) return undefined;
    let index = this.layers.size;
    if (index >= this.target.depth) {
      const spare = [...this.layers].filter(([other]) => !needed.includes(other) && !this.isShown(other));
      const oldest = spare.sort(([, a], [, b]) => a.used - b.used)[0];
      if (oldest === undefined) return undefined;
      this.layers.delete(oldest[0]);
      index = oldest[1].index;
    }
    const layer = { index, samples: 0, used: this.clock++ };
    this.layers.set(name, layer);
    return layer;
  }

  private isShown(name: string): boolean {
    return this.shown.names.includes(name);
  }

  private addSamples(layer: Layer, { texture, scale, lobe }: TableOnCard): void {
    if (this.buffered !== layer.samples) {
      this.buffered = layer.samples;
      // The middle of the pixel first: the picture while orbiting does not shake.
      this.stage.draw(this.renderer, jitter(layer.samples, 0), jitter(layer.samples, 1));
    }
    const { pass } = this;
    pass.uniforms.uTable!.value = texture;
    (pass.uniforms.uScale!.value as Vector3).copy(scale);
    if (!this.underPoints) {
      pass.uniforms.uLobe!.value = lobe;
      pass.uniforms.uFirst!.value = layer.samples;
    }
    pass.material.blending = layer.samples === 0 ? NoBlending : CustomBlending;
    pass.material.blendAlpha = 1 / (layer.samples + 1);
    pass.draw(this.renderer, this.target as never, layer.index);
    layer.samples++;
    layer.used = this.clock++;
  }
}

/** 2^32 times the fractions of the square roots of 2 and 3: independent of the steps that the shaders take (STEPS). */
const JITTER = [0x6a09e667, 0xbb67ae85] as const;

/** The i-th point of a two-dimensional additive recurrence, shifted to start in the middle. */
function jitter(i: number, dimension: 0 | 1): number {
  return ((Math.imul(i, JITTER[dimension]) + 0x80000000) >>> 0) / 4294967296;
}

/** Until the card has done what it was told. */
function finished(gl: WebGL2RenderingContext): Promise<void> {
  const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  return new Promise((resolve) => {
    const look = () => {
      // Of a lost context there is nothing to wait for.
      if (sync && gl.clientWaitSync(sync, 0, 0) === gl.TIMEOUT_EXPIRED) setTimeout(look, 4);
      else resolve();
    };
    look();
  });
}
