// A table of chances on the card: red the probability to keep a cell, green its alias, blue the density.

import { DataTexture, FloatType, NearestFilter, RGBAFormat } from "three";

import { alias } from "../brdf/alias";

export function chances(mass: ArrayLike<number>, density: ArrayLike<number>, width: number): DataTexture {
  const { keep, other } = alias(mass);
  const texels = new Float32Array(4 * keep.length);
  for (let i = 0; i < keep.length; i++) texels.set([keep[i]!, other[i]!, density[i]!, 0], 4 * i);
  const texture = new DataTexture(texels, width, keep.length / width, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}
