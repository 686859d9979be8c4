// The picture of one material, some samples more: direct light on what the geometry buffer shows.

uniform highp sampler2D uNormal; // xyz, coverage
uniform highp sampler2D uPosition;
uniform vec3 uEye;
out vec4 colour;

#ifdef POINTS
uniform vec3 uLights[3];
uniform float uIntensities[3];

vec3 shade(vec3 n, vec3 at, vec3 wo) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 3; i++) {
    vec3 way = uLights[i] - at;
    float distance2 = dot(way, way);
    vec3 wi = way * inversesqrt(distance2);
    sum += evalBrdf(n, wi, wo) * max(dot(n, wi), 0.0) * uIntensities[i] / distance2;
  }
  return sum;
}
#else
uniform uint uFirst;
uniform int uSamples;

vec3 sampleCosine(vec3 n, vec2 u) {
  float phi = 2.0 * PI * u.y;
  vec3 x = perpendicular(n);
  return sqrt(u.x) * (cos(phi) * x + sin(phi) * cross(n, x)) + sqrt(1.0 - u.x) * n;
}

// One sample of the multi-sample estimator with the balance heuristic: E. Veach, L. Guibas, "Optimally Combining
// Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995, section 3.
vec3 contribution(vec3 n, vec3 wi, vec3 wo) {
  float cosine = dot(n, wi);
  if (cosine <= 0.0) return vec3(0.0);
  float pdf = pdfEnv(wi) + pdfLobe(n, wi, wo) + cosine / PI;
  return evalBrdf(n, wi, wo) * radiance(wi) * cosine / pdf;
}

vec3 shade(vec3 n, vec3 at, vec3 wo) {
  uint pixel = uint(gl_FragCoord.x) + (uint(gl_FragCoord.y) << 16u);
  vec3 sum = vec3(0.0);
  for (int s = 0; s < uSamples; s++) {
    uint i = uFirst + uint(s);
    vec2 u = vec2(random(i, 0, pixel), random(i, 1, pixel));
    vec2 v = vec2(random(i, 2, pixel), random(i, 3, pixel));
    vec2 w = vec2(random(i, 4, pixel), random(i, 5, pixel));
    sum += contribution(n, sampleEnv(u), wo);
    sum += contribution(n, normalize(sampleLobe(n, wo, v)), wo);
    sum += contribution(n, normalize(sampleCosine(n, w)), wo);
  }
  return sum / float(uSamples);
}
#endif

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(uNormal, here, 0);
  if (surface.a == 0.0) {
    colour = vec4(0.0);
    return;
  }
  vec3 n = normalize(surface.xyz);
  vec3 at = texelFetch(uPosition, here, 0).xyz;
  vec3 wo = normalize(uEye - at);
  vec3 light = dot(n, wo) > 0.0 ? shade(n, at, wo) : vec3(0.0);
  // One bad number would stay in the mean for ever.
  colour = vec4(any(isnan(light)) || any(isinf(light)) ? vec3(0.0) : light, 1.0);
}
