// The exact table of one material: hardware trilinear filtering of half floats.
//
// Texture coordinate = position / n, because the filter is centred at (i + 1/2) / n, where the samples stand. Alpha is 1
// where a sample is measured, so rgb / a is the interpolation renormalised over the measured corners.

uniform highp sampler3D uTable; // width phi_d (repeats: its period is pi), height theta_d, depth theta_h
uniform vec3 uScale;

// f_r in 1/sr at (theta_h, theta_d, phi_d); both directions are above the horizon.
vec3 evalTable(vec3 angles) {
  vec4 sum = texture(uTable, vec3(angles.z / PI, angles.y / (0.5 * PI), sqrt(angles.x / (0.5 * PI))));
  return sum.a > 0.0 ? uScale * sum.rgb / sum.a : vec3(0.0);
}
