// The exact table of one material: hardware filtering of half floats, in a texture as stack.ts makes it.
//
// Texture coordinate = position / n, because the filter is centred at (i + 1/2) / n, where the samples stand. Alpha is 1
// where a sample is measured, so rgb / a is the interpolation renormalised over the measured corners.

uniform highp sampler3D uTable;
uniform vec3 uScale;
uniform ivec2 uTurns; // blocks of phi_h, and how many of them are above each other

#ifdef TURNS
// Of the i-th block, `at` shares of phi_d, theta_d and theta_h.
vec4 inBlock(int i, vec3 at) {
  ivec2 size = textureSize(uTable, 0).yz;
  ivec2 each = size / ivec2(uTurns.y, (uTurns.x + uTurns.y - 1) / uTurns.y);
  vec2 first = vec2(each * ivec2(i % uTurns.y, i / uTurns.y));
  vec2 cells = vec2(each);
  // Beyond a block's own outermost samples is its neighbour.
  return texture(uTable, vec3(at.x, (first + clamp(at.yz * cells, vec2(0.5), cells - 0.5)) / vec2(size)));
}

vec4 lookUp(float phiH, vec3 at) {
  float position = float(uTurns.x) * fract(phiHShare(phiH)) - 0.5;
  float lower = floor(position);
  ivec2 blocks = (ivec2(int(lower)) + ivec2(uTurns.x, uTurns.x + 1)) % uTurns.x;
  return mix(inBlock(blocks.x, at), inBlock(blocks.y, at), position - lower);
}
#else
vec4 lookUp(float phiH, vec3 at) {
  return texture(uTable, at);
}
#endif

// f_r in 1/sr at (theta_h, phi_h, theta_d, phi_d); both directions are above the horizon.
vec3 evalTable(vec4 angles) {
  vec4 sum = lookUp(angles.y, vec3(phiDShare(angles.w), thetaDShare(angles.z), thetaHShare(angles.x)));
  return sum.a > 0.0 ? uScale * sum.rgb / sum.a : vec3(0.0);
}
