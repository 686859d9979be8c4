// The picture of a recipe is the weighted sum of its materials' pictures, channel by channel: exact, because direct light is
// linear in the BRDF. Then exposure and the sRGB curve of IEC 61966-2-1.

uniform highp sampler2DArray uBasis;
uniform vec4 uTerms[@TERMS@]; // weights of r, g, b; layer
uniform int uCount;
uniform float uExposure;
out vec4 colour;

vec3 toSrgb(vec3 linear) {
  vec3 x = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
  float coverage = 0.0;
  for (int i = 0; i < uCount; i++) {
    vec4 basis = texelFetch(uBasis, ivec3(here, int(uTerms[i].w)), 0);
    if (basis.a > 0.0) sum += uTerms[i].rgb * basis.rgb / basis.a;
    coverage = max(coverage, basis.a);
  }
  colour = vec4(toSrgb(uExposure * sum) * coverage, coverage);
}
