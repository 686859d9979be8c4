// One of unequal chances, in order (inversion.ts): a row of the table holds upTo, first, density, chance.

// The cell of u in [0, 1), and how far u is into it.
int invert(highp sampler2D chances, int row, float u, out float share) {
  int n = textureSize(chances, 0).x;
  int i = int(texelFetch(chances, ivec2(min(int(u * float(n)), n - 1), row), 0).g);
  vec4 cell = texelFetch(chances, ivec2(i, row), 0);
  while (cell.r <= u && i < n - 1) cell = texelFetch(chances, ivec2(++i, row), 0);
  share = clamp(1.0 - (cell.r - u) / max(cell.a, 1e-20), 0.0, 1.0);
  return i;
}
