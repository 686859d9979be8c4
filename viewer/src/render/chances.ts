// Tables of chances on the card, one a row: red the chance of a cell and all before it, green where to begin to look, blue
// the density, alpha the chance (inversion.glsl).

import { DataTexture, FloatType, NearestFilter, RGBAFormat } from "three";

import { inversion } from "../brdf/inversion";

export function chances(mass: Float64Array, density: ArrayLike<number>, width: number): DataTexture {
  const height = mass.length / width;
  const texels = new Float32Array(4 * mass.length);
  for (let row = 0; row < height; row++) {
    const { chance, upTo, first } = inversion(mass.subarray(row * width, (row + 1) * width));
    for (let i = 0; i < width; i++) {
      const at = row * width + i;
      texels.set([upTo[i]!, first[i]!, density[at]!, chance[i]!], 4 * at);
    }
  }
  const texture = new DataTexture(texels, width, height, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}
