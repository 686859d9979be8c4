// Light from all around, as a latitude-longitude picture: z is up, the top row looks up, the middle column looks to +y.
//
// Sampled by a coarse table of its radiance: row i of uEnvCdf holds the cumulative distribution along the row, its last
// column that over the rows.

uniform highp sampler2D uEnv;
uniform highp sampler2D uEnvCdf;

vec3 radiance(vec3 w) {
  vec2 uv = vec2(atan(w.x, w.y) / (2.0 * PI) + 0.5, acos(clamp(w.z, -1.0, 1.0)) / PI);
  return textureLod(uEnv, uv, 0.0).rgb;
}

ivec2 envCells() {
  return textureSize(uEnvCdf, 0) - ivec2(1, 0);
}

float cdfAlong(int row, int i) {
  return i < 0 ? 0.0 : texelFetch(uEnvCdf, ivec2(i, row), 0).r;
}

float cdfOver(int row) {
  return row < 0 ? 0.0 : texelFetch(uEnvCdf, ivec2(envCells().x, row), 0).r;
}

// The cell that u falls into, and how far.
vec2 findRow(float u) {
  int low = 0;
  int high = envCells().y - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (cdfOver(middle) > u) high = middle;
    else low = middle + 1;
  }
  float before = cdfOver(low - 1);
  return vec2(float(low), (u - before) / max(cdfOver(low) - before, 1e-9));
}

vec2 findColumn(int row, float u) {
  int low = 0;
  int high = envCells().x - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (cdfAlong(row, middle) > u) high = middle;
    else low = middle + 1;
  }
  float before = cdfAlong(row, low - 1);
  return vec2(float(low), (u - before) / max(cdfAlong(row, low) - before, 1e-9));
}

vec3 sampleEnv(vec2 u) {
  vec2 row = findRow(u.y);
  vec2 column = findColumn(int(row.x), u.x);
  vec2 uv = vec2(column.x + clamp(column.y, 0.0, 1.0), row.x + clamp(row.y, 0.0, 1.0)) / vec2(envCells());
  float turn = 2.0 * PI * (uv.x - 0.5);
  float theta = PI * uv.y;
  return vec3(sin(theta) * sin(turn), sin(theta) * cos(turn), cos(theta));
}

float pdfEnv(vec3 w) {
  ivec2 cells = envCells();
  vec2 uv = vec2(atan(w.x, w.y) / (2.0 * PI) + 0.5, acos(clamp(w.z, -1.0, 1.0)) / PI);
  ivec2 cell = min(ivec2(uv * vec2(cells)), cells - 1);
  float along = cdfAlong(cell.y, cell.x) - cdfAlong(cell.y, cell.x - 1);
  float over = cdfOver(cell.y) - cdfOver(cell.y - 1);
  float sine = sqrt(max(1.0 - w.z * w.z, 1e-12));
  return along * over * float(cells.x * cells.y) / (2.0 * PI * PI * sine);
}
