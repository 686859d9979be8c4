// Pictures of four bytes a pixel: R, G, B, and an exponent e that they share, value = R 2^(e - 136); e is 0 beside the picture.
// A byte each holds what a screen shows, and the exponent the highlights that a mix needs. See halfway.server.blocks.

import { toByte } from "./colour";

const SCALE = Float32Array.from({ length: 256 }, (_, e) => (e === 0 ? 0 : 2 ** (e - 136)));

/** For the screen, by exponent and byte. */
let coded: Uint8Array | null = null;

/** Adds a picture to a sum of linear RGBA, each channel with its weight. */
export function addTo(
  sum: Float32Array,
  picture: Uint8Array,
  [r, g, b]: readonly [number, number, number],
): void {
  for (let i = 0; i < sum.length; i += 4) {
    const e = picture[i + 3]!;
    const scale = SCALE[e]!;
    sum[i]! += r * scale * picture[i]!;
    sum[i + 1]! += g * scale * picture[i + 1]!;
    sum[i + 2]! += b * scale * picture[i + 2]!;
    sum[i + 3] = e > 0 ? 1 : 0;
  }
}

/** One of a pixel's values, linear. */
export function valueAt(picture: Uint8Array, pixel: number, channel: number): number {
  return SCALE[picture[4 * pixel + 3]!]! * picture[4 * pixel + channel]!;
}

/** A picture as a screen shows it, opaque where there is one: from a table, for thousands are. */
export function toScreen(picture: Uint8Array): Uint8ClampedArray<ArrayBuffer> {
  coded ??= Uint8Array.from({ length: 65536 }, (_, i) => toByte(SCALE[i >> 8]! * (i & 255)));
  const bytes = new Uint8ClampedArray(picture.length);
  for (let i = 0; i < bytes.length; i += 4) {
    const e = picture[i + 3]! << 8;
    bytes[i] = coded[e | picture[i]!]!;
    bytes[i + 1] = coded[e | picture[i + 1]!]!;
    bytes[i + 2] = coded[e | picture[i + 2]!]!;
    bytes[i + 3] = e > 0 ? 255 : 0;
  }
  return bytes;
}
