// What the card draws for the picture: one sample of a material under either light, and a recipe from its materials' pictures.

import * as THREE from "three";

import type { PointLight } from "../api/schema";
import { compositeShader, environmentShader, MAX_TERMS, Pass, pointsShader, type Uniforms } from "./shaders";
import type { Stage } from "./stage";

/** Samples are added as a running mean: the new one counts `blendAlpha`. */
const RUNNING_MEAN = {
  blending: THREE.CustomBlending,
  blendSrc: THREE.ConstantAlphaFactor,
  blendDst: THREE.OneMinusConstantAlphaFactor,
  transparent: true,
} as const;

export function pointsPass(stage: Stage, lights: readonly PointLight[]): Pass {
  const uniforms = {
    ...surface(stage),
    uLights: { value: lights.map(({ at: [x, y, z] }) => new THREE.Vector3(x, y, z)) },
    uIntensities: { value: lights.map(({ intensity }) => intensity) },
  };
  return new Pass(pointsShader, uniforms, RUNNING_MEAN);
}

export function environmentPass(stage: Stage): Pass {
  const uniforms = {
    ...surface(stage),
    uEnv: { value: null },
    uEnvRows: { value: null },
    uEnvChances: { value: null },
    uLobe: { value: null },
    uSample: { value: 0 },
  };
  return new Pass(environmentShader, uniforms, RUNNING_MEAN);
}

export function compositePass(): Pass {
  const terms = () => Array.from({ length: MAX_TERMS }, () => new THREE.Vector4());
  const uniforms = {
    uBasis: { value: null },
    uTerms: { value: terms() },
    uOtherTerms: { value: terms() },
    uCount: { value: 0 },
    uOtherCount: { value: 0 },
    uSplit: { value: 0 },
    uExposure: { value: 1 },
  };
  return new Pass(compositeShader, uniforms, { blending: THREE.NoBlending });
}

function surface({
  target,
  camera,
}: {
  target: { textures: THREE.Texture[] };
  camera: THREE.Camera;
}): Uniforms {
  return {
    uTable: { value: null },
    uScale: { value: new THREE.Vector3() },
    uNormal: { value: target.textures[0] },
    uPosition: { value: target.textures[1] },
    uEye: { value: camera.position },
    uBoxes: { value: null },
    uTriangles: { value: null },
    uBoxCount: { value: 0 },
  };
}
