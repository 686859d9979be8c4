// Cameras: turned about what they look at, and as wide as what must be seen.

import type { PerspectiveCamera, Vector3 } from "three";

import { clamp } from "../numbers";

/** How far above or below a camera may stand, radians. */
const STEEPEST = 1.5;

/** Turn the way from what is looked at to the camera by radians, about the vertical z axis and upwards. */
export function turnArm(arm: Vector3, azimuth: number, elevation: number): Vector3 {
  const length = arm.length();
  const up = clamp(Math.asin(arm.z / length) + elevation, -STEEPEST, STEEPEST);
  const around = Math.atan2(arm.y, arm.x) + azimuth;
  arm.set(Math.cos(up) * Math.cos(around), Math.cos(up) * Math.sin(around), Math.sin(up));
  return arm.multiplyScalar(length);
}

/** See `fov` degrees of the width of what must be seen, which is `seen` times as wide as high, in a picture of `aspect`. */
export function widen(camera: PerspectiveCamera, aspect: number, fov: number, seen = 1): void {
  const half = Math.tan((fov * Math.PI) / 360) / Math.min(seen, aspect);
  camera.aspect = aspect;
  camera.fov = (360 / Math.PI) * Math.atan(half);
  camera.updateProjectionMatrix();
}
