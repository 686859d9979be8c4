// Light from all around, as a latitude-longitude picture: z is up, the top row looks up, the middle column to +y.
//
// Sampled by a coarse table of its light, a row and then a cell of it, evenly within the cell.

uniform highp sampler2D uEnv;
uniform float uEnvTurn; // about the vertical, in turns
uniform highp sampler2D uEnvRows;
uniform highp sampler2D uEnvChances; // of the cells of a row; density per solid angle x sine

// Where a direction is on the picture.
vec2 toPicture(vec3 w) {
  return vec2(fract(atan(w.x, w.y) / (2.0 * PI) + 0.5 + uEnvTurn), acos(clamp(w.z, -1.0, 1.0)) / PI);
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
  vec2 share;
  int row = invert(uEnvRows, 0, u.y, share.y);
  int column = invert(uEnvChances, row, u.x, share.x);
  vec2 uv = (vec2(column, row) + share) / vec2(size);
  float turn = 2.0 * PI * (uv.x - 0.5 - uEnvTurn);
  float theta = PI * uv.y;
  return vec3(sin(theta) * sin(turn), sin(theta) * cos(turn), cos(theta));
}
