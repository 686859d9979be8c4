// Light from all around, as a latitude-longitude picture: z is up, the top row looks up, the middle column to +y.
//
// Sampled cell by cell of a coarse table of its light, evenly within a cell (alias.ts).

uniform highp sampler2D uEnv;
uniform highp sampler2D uEnvChances; // keep, alias, density per solid angle x sine

// Where a direction is on the picture.
vec2 toPicture(vec3 w) {
  return vec2(atan(w.x, w.y) / (2.0 * PI) + 0.5, acos(clamp(w.z, -1.0, 1.0)) / PI);
}

vec3 radiance(vec2 uv) {
  return textureLod(uEnv, uv, 0.0).rgb;
}

float pdfEnv(vec3 w, vec2 uv) {
  ivec2 size = textureSize(uEnvChances, 0);
  float density = texelFetch(uEnvChances, min(ivec2(uv * vec2(size)), size - 1), 0).b;
  return density * inversesqrt(max(1.0 - w.z * w.z, 1e-8));
}

vec3 sampleEnv(vec2 u) {
  ivec2 size = textureSize(uEnvChances, 0);
  float scaled = u.x * float(size.x * size.y);
  int cell = int(scaled);
  float share = scaled - float(cell);
  vec4 chance = texelFetch(uEnvChances, ivec2(cell % size.x, cell / size.x), 0);
  if (share >= chance.r) {
    cell = int(chance.g);
    share = (share - chance.r) / (1.0 - chance.r);
  } else {
    share /= chance.r;
  }
  vec2 uv = vec2(float(cell % size.x) + share, float(cell / size.x) + u.y) / vec2(size);
  float turn = 2.0 * PI * (uv.x - 0.5);
  float theta = PI * uv.y;
  return vec3(sin(theta) * sin(turn), sin(theta) * cos(turn), cos(theta));
}
