// Shaders put together from their files, and the pass that draws one over a whole picture.

import * as THREE from "three";

import type { DrawableGrid } from "../brdf/grid";
import { addressing } from "./addressing";
import brdf from "./glsl/brdf.glsl?raw";
import composite from "./glsl/composite.frag.glsl?raw";
import environment from "./glsl/environment.glsl?raw";
import halfdiff from "./glsl/halfdiff.glsl?raw";
import inversion from "./glsl/inversion.glsl?raw";
import lobe from "./glsl/lobe.glsl?raw";
import meshFragment from "./glsl/mesh.frag.glsl?raw";
import meshVertex from "./glsl/mesh.vert.glsl?raw";
import random from "./glsl/random.glsl?raw";
import screen from "./glsl/screen.vert.glsl?raw";
import shade from "./glsl/shade.frag.glsl?raw";
import shadow from "./glsl/shadow.glsl?raw";
import sphere from "./glsl/sphere.frag.glsl?raw";
import srgb from "./glsl/srgb.glsl?raw";
import tangent from "./glsl/tangent.glsl?raw";
import { OCCLUDER_BITS } from "./occluder";

export const MAX_TERMS = 32;
/** 2^32 / g and 2^32 / g^2 with g^3 = g + 1, for the light, and again for the half vector. */
const STEPS = [0xc13fa9a9, 0x91e10da5, 0xc13fa9a9, 0x91e10da5] as const;

const HEAD = "precision highp float;\nprecision highp int;\n";
const shadows = shadow.replace("@BITS@", String(OCCLUDER_BITS));

/** Of materials on a grid: each light has its own. */
export function pointsShader(grid: DrawableGrid): string {
  return `${HEAD}#define POINTS\n${surface(grid)}${shade}`;
}

export function environmentShader(grid: DrawableGrid): string {
  return HEAD + surface(grid) + sampling + shade;
}

function surface(grid: DrawableGrid): string {
  return addressing(grid) + tangent + halfdiff + brdf + shadows;
}

const sampling =
  random.replace("@STEPS@", STEPS.map((step) => `${step}u`).join(", ")) + inversion + environment + lobe;
export const sphereShader = HEAD + sphere;
export const compositeShader =
  HEAD +
  THREE.ShaderChunk.tonemapping_pars_fragment +
  srgb +
  composite.replaceAll("@TERMS@", String(MAX_TERMS));

export function meshMaterial(): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: HEAD + meshVertex,
    fragmentShader: HEAD + tangent + meshFragment,
    side: 2,
  });
}

/** A fragment shader over the whole picture; what its uniforms are is in its text. */
export class Pass {
  readonly material: THREE.RawShaderMaterial;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.Camera();

  constructor(fragmentShader: string, options: THREE.ShaderMaterialParameters = {}) {
    const uniforms = [...fragmentShader.matchAll(/^uniform .*?(\w+)(\[\d+\])?;/gm)].map(([, name]) => name!);
    this.material = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: HEAD + screen,
      fragmentShader,
      uniforms: Object.fromEntries(uniforms.map((name) => [name, { value: null }])),
      depthTest: false,
      depthWrite: false,
      ...options,
    });
    const triangle = new THREE.BufferGeometry();
    triangle.setAttribute(
      "position",
      new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3),
    );
    const mesh = new THREE.Mesh(triangle, this.material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  set(values: Readonly<Record<string, unknown>>): this {
    for (const [name, value] of Object.entries(values)) this.material.uniforms[name]!.value = value;
    return this;
  }

  /** Beside the page's work, where the browser can. */
  async compile(renderer: THREE.WebGLRenderer): Promise<void> {
    // three warns on the console where it cannot.
    if (renderer.extensions.has("KHR_parallel_shader_compile"))
      await renderer.compileAsync(this.scene, this.camera);
    else renderer.compile(this.scene, this.camera);
  }

  draw(renderer: THREE.WebGLRenderer, target: THREE.WebGLRenderTarget | null, layer = 0): void {
    renderer.setRenderTarget(target, layer);
    renderer.render(this.scene, this.camera);
  }
}
