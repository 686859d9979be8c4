// Half vectors drawn by the material's own distribution over theta_h, and over phi_h at it (lobe.ts), evenly in solid angle
// within a cell.

uniform highp sampler2D uLobe; // density per solid angle of the half vector, whatever its phi_h
uniform highp sampler2D uLobeTurns; // a row for each theta_h

float sineHalfSquared(int i, int n) {
  float s = sin(0.5 * thetaHAngle(float(i) / float(n)));
  return s * s;
}

// An azimuth by a number u in [0, 1), where theta_h is in this cell.
float sampleTurn(int cell, float u) {
#ifdef TURNS
  // All periods are alike.
  float periods = round(phiHShare(2.0 * PI));
  float within;
  int turn = invert(uLobeTurns, cell, fract(periods * u), within);
  return phiHAngle(floor(periods * u) + (float(turn) + within) / float(textureSize(uLobeTurns, 0).x));
#else
  return 2.0 * PI * u;
#endif
}

// A direction to the light: wo reflected about a half vector around n.
vec3 sampleLobe(vec3 n, vec3 t, vec3 wo, vec2 u) {
  int size = textureSize(uLobe, 0).x;
  float share;
  int cell = invert(uLobe, 0, u.x, share);
  // sin^2(theta/2) is even in solid angle and exact near the pole, where cos(theta) is not.
  float m = mix(sineHalfSquared(cell, size), sineHalfSquared(cell + 1, size), share);
  float sine = 2.0 * sqrt(m * (1.0 - m));
  float phi = sampleTurn(cell, u.y);
  vec3 h = sine * (cos(phi) * t + sin(phi) * cross(n, t)) + (1.0 - 2.0 * m) * n;
  return normalize(reflected(wo, h));
}

// Of a direction with these half and difference angles: the half vector's density over 4 (wo . h).
float pdfLobe(vec4 angles) {
  int size = textureSize(uLobe, 0).x;
  int cell = min(int(float(size) * thetaHShare(angles.x)), size - 1);
  float density = texelFetch(uLobe, ivec2(cell, 0), 0).b;
#ifdef TURNS
  int turns = textureSize(uLobeTurns, 0).x;
  int turn = min(int(float(turns) * fract(phiHShare(angles.y))), turns - 1);
  density *= float(turns) * texelFetch(uLobeTurns, ivec2(turn, cell), 0).a;
#endif
  return density / (4.0 * max(cos(angles.z), 1e-4));
}
