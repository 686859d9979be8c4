// From linear light to the screen: the sRGB transfer curve of IEC 61966-2-1 (colour.ts).

vec3 toSrgb(vec3 linear) {
  vec3 x = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}
