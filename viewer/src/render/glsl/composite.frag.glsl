// The picture of a recipe is the weighted sum of its materials' pictures, channel by channel: exact, because direct light is
// linear in the BRDF. Then exposure, tone mapping (three's, where one is chosen) and the curve of the screen.

uniform highp sampler2DArray uBasis;
uniform vec4 uTerms[@TERMS@]; // weights of r, g, b; layer
uniform vec4 uOtherTerms[@TERMS@];
uniform int uCount;
uniform int uOtherCount;
uniform float uSplit; // pixels from the left; the other recipe is to its right
uniform int uTone; // 0 none, 1 AgX, 2 filmic
out vec4 colour;

vec3 toned(vec3 linear) {
  if (uTone == 1) return AgXToneMapping(linear);
  if (uTone == 2) return ACESFilmicToneMapping(linear);
  return toneMappingExposure * linear;
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
  float coverage = 0.0;
  bool other = gl_FragCoord.x > uSplit;
  int count = other ? uOtherCount : uCount;
  for (int i = 0; i < count; i++) {
    vec4 term = other ? uOtherTerms[i] : uTerms[i];
    vec4 basis = texelFetch(uBasis, ivec3(here, int(term.w)), 0);
    if (basis.a > 0.0) sum += term.rgb * basis.rgb / basis.a;
    coverage = max(coverage, basis.a);
  }
  colour = vec4(toSrgb(toned(sum)) * coverage, coverage);
}
