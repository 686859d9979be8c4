// Half vectors drawn by the material's own distribution over theta_h (lobe.ts), evenly in solid angle within a cell.

uniform highp sampler2D uLobe; // density per solid angle of the half vector

float sineHalfSquared(int i, int n) {
  float position = float(i) / float(n);
  float s = sin(0.25 * PI * position * position);
  return s * s;
}

// A direction to the light: wo reflected about a half vector around n.
vec3 sampleLobe(vec3 n, vec3 wo, vec2 u) {
  int size = textureSize(uLobe, 0).x;
  float share;
  int cell = invert(uLobe, 0, u.x, share);
  // sin^2(theta/2) is even in solid angle and exact near the pole, where cos(theta) is not.
  float m = mix(sineHalfSquared(cell, size), sineHalfSquared(cell + 1, size), share);
  float sine = 2.0 * sqrt(m * (1.0 - m));
  vec3 x = perpendicular(n);
  vec3 y = cross(n, x);
  float phi = 2.0 * PI * u.y;
  vec3 h = sine * (cos(phi) * x + sin(phi) * y) + (1.0 - 2.0 * m) * n;
  return normalize(reflected(wo, h));
}

// Of a direction whose half vector has this theta_h, at this theta_d: the half vector's density over 4 (wo . h).
float pdfLobe(float thetaH, float thetaD) {
  int size = textureSize(uLobe, 0).x;
  int cell = min(int(float(size) * sqrt(thetaH / (0.5 * PI))), size - 1);
  return texelFetch(uLobe, ivec2(cell, 0), 0).b / (4.0 * max(cos(thetaD), 1e-4));
}
