// Half vectors drawn by the material's own distribution over theta_h (see lobe.ts), evenly in solid angle within a cell.

uniform highp sampler2D uLobe; // row 0: cumulative distribution at the end of each cell; row 1: density, 1/sr

float sineHalfSquared(float i, float n) {
  float position = i / n;
  float s = sin(0.25 * PI * position * position);
  return s * s;
}

// A direction to the light; reflected about a half vector around n.
vec3 sampleLobe(vec3 n, vec3 wo, vec2 u) {
  int size = textureSize(uLobe, 0).x;
  int low = 0;
  int high = size - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (texelFetch(uLobe, ivec2(middle, 0), 0).r > u.x) high = middle;
    else low = middle + 1;
  }
  float before = low == 0 ? 0.0 : texelFetch(uLobe, ivec2(low - 1, 0), 0).r;
  float share = clamp((u.x - before) / max(texelFetch(uLobe, ivec2(low, 0), 0).r - before, 1e-9), 0.0, 1.0);
  // sin^2(theta/2) is even in solid angle and exact near the pole, where cos(theta) is not.
  float m = mix(sineHalfSquared(float(low), float(size)), sineHalfSquared(float(low + 1), float(size)), share);
  float sine = 2.0 * sqrt(m * (1.0 - m));
  vec3 x = perpendicular(n);
  vec3 y = cross(n, x);
  float phi = 2.0 * PI * u.y;
  vec3 h = sine * (cos(phi) * x + sin(phi) * y) + (1.0 - 2.0 * m) * n;
  return 2.0 * dot(wo, h) * h - wo;
}

float pdfLobe(vec3 n, vec3 wi, vec3 wo) {
  vec3 h = normalize(wi + wo);
  float theta = atan(length(cross(n, h)), dot(n, h));
  int size = textureSize(uLobe, 0).x;
  int cell = int(float(size) * sqrt(clamp(theta / (0.5 * PI), 0.0, 1.0)));
  return texelFetch(uLobe, ivec2(min(cell, size - 1), 1), 0).r / (4.0 * max(dot(wo, h), 1e-4));
}
