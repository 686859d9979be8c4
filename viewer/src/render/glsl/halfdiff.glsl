// Half and difference angles, as halfway.halfdiff defines them, in world coordinates about the normal n.
// S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", 1998, section 3.

const float PI = 3.14159265358979;

vec3 perpendicular(vec3 v) {
  return normalize(abs(v.x) > 0.5 ? vec3(-v.y, v.x, 0.0) : vec3(0.0, -v.z, v.y));
}

// The direction that is to the other side of the half vector h.
vec3 reflected(vec3 w, vec3 h) {
  return 2.0 * dot(w, h) * h - w;
}

// Of an isotropic material: (theta_h, theta_d, phi_d).
vec3 toHalfDiff(vec3 n, vec3 wi, vec3 wo) {
  vec3 h = normalize(wi + wo);
  vec3 across = cross(n, h);
  float sine = length(across);
  // Where h = n its azimuth is free, and so is phi_d.
  vec3 y = sine > 1e-7 ? across / sine : perpendicular(h);
  vec3 x = cross(y, h);
  vec3 d = vec3(dot(wi, x), dot(wi, y), dot(wi, h));
  float phiD = abs(d.x) + abs(d.y) > 0.0 ? atan(d.y, d.x) : 0.0;
  // atan, never acos: a float32 acos cannot resolve the first cells of theta_h (0.011 degrees).
  return vec3(atan(sine, dot(n, h)), atan(length(d.xy), d.z), phiD);
}
