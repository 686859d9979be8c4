// The picture of one material, some samples more: direct light on what the geometry buffer shows.

uniform highp sampler2D uNormal; // xyz, coverage
uniform highp sampler2D uPosition; // xyz, the angle of the tangent from the level one
uniform float uGrain; // by which the material is turned against the tangent, in radians
uniform vec3 uEye;
out vec4 colour;

#ifdef POINTS
uniform vec3 uLights[3];
uniform float uIntensities[3];

vec3 shade(vec3 n, vec3 t, vec3 at, vec3 wo) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 3; i++) {
    vec3 way = uLights[i] - at;
    float far = length(way);
    vec3 wi = way / far;
    float cosine = dot(n, wi);
    if (cosine > 0.0 && !occluded(at, wi, far))
      sum += evalTable(toHalfDiff(n, t, wi, wo)) * cosine * uIntensities[i] / (far * far);
  }
  return sum;
}
#else
uniform uint uSample; // the number of this sample

// One sample of the multi-sample estimator with the balance heuristic: E. Veach, L. Guibas, "Optimally Combining
// Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995, section 3.
vec3 contribution(vec3 n, vec3 t, vec3 at, vec3 wi, vec3 wo) {
  float cosine = dot(n, wi);
  if (cosine <= 0.0 || occluded(at, wi, FAR)) return vec3(0.0);
  vec4 angles = toHalfDiff(n, t, wi, wo);
  vec2 uv = toPicture(wi);
  float pdf = pdfEnv(wi, uv) + pdfLobe(angles);
  return evalTable(angles) * radiance(uv) * cosine / pdf;
}

vec3 shade(vec3 n, vec3 t, vec3 at, vec3 wo) {
  uint pixel = uint(gl_FragCoord.x) + (uint(gl_FragCoord.y) << 16u);
  vec3 byLight = sampleEnv(vec2(random(uSample, 0, pixel), random(uSample, 1, pixel)));
  vec3 byMaterial = sampleLobe(n, t, wo, vec2(random(uSample, 2, pixel), random(uSample, 3, pixel)));
  return contribution(n, t, at, byLight, wo) + contribution(n, t, at, byMaterial, wo);
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
  vec4 point = texelFetch(uPosition, here, 0);
  vec3 at = point.xyz;
  vec3 t = tangent(n, point.w + uGrain);
  vec3 wo = normalize(uEye - at);
  vec3 light = dot(n, wo) > 0.0 ? shade(n, t, at, wo) : vec3(0.0);
  // One bad number would stay in the mean for ever.
  colour = vec4(any(isnan(light)) || any(isinf(light)) ? vec3(0.0) : light, 1.0);
}
