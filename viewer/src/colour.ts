// From linear light to the screen: the sRGB transfer curve of IEC 61966-2-1.

export function toSrgb(linear: number): number {
  const x = Math.min(Math.max(linear, 0), 1);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}

/** A colour for style sheets, from linear RGB. */
export function toCss(rgb: readonly [number, number, number]): string {
  return `rgb(${rgb.map((x) => Math.round(255 * toSrgb(x))).join(" ")})`;
}

const STEPS = 4095;
const CURVE = Uint8ClampedArray.from({ length: STEPS + 1 }, (_, i) => Math.round(255 * toSrgb(i / STEPS)));

/** `toSrgb` in 8 bits from a table, for pictures. */
export function toByte(linear: number): number {
  return CURVE[linear >= 1 ? STEPS : linear <= 0 ? 0 : (linear * STEPS + 0.5) | 0]!;
}
