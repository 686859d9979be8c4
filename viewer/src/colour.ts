// From linear light to the screen: the sRGB transfer curve of IEC 61966-2-1.

export function toSrgb(linear: number): number {
  const x = Math.min(Math.max(linear, 0), 1);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}

/** The inverse of `toSrgb`. */
export function fromSrgb(coded: number): number {
  return coded <= 0.04045 ? coded / 12.92 : ((coded + 0.055) / 1.055) ** 2.4;
}

/** #rrggbb of linear RGB, as a colour input takes it. */
export function toHex(rgb: readonly number[]): string {
  return `#${rgb.map((x) => toByte(x).toString(16).padStart(2, "0")).join("")}`;
}

/** Linear RGB of #rrggbb. */
export function fromHex(hex: string): number[] {
  return [1, 3, 5].map((i) => fromSrgb(Number.parseInt(hex.slice(i, i + 2), 16) / 255));
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

/** CIELAB under D65, of linear RGB (IEC 61966-2-1, CIE 15). */
export function toLab([r = 0, g = 0, b = 0]: readonly number[]): [number, number, number] {
  const [x, y, z] = [
    (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
    0.2126 * r + 0.7152 * g + 0.0722 * b,
    (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
  ].map((value) => (value > 216 / 24389 ? Math.cbrt(value) : ((24389 / 27) * value + 16) / 116)) as [
    number,
    number,
    number,
  ];
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
