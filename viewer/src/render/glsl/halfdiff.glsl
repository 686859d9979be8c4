// Half and difference angles, as halfway.halfdiff defines them, in world coordinates about the normal n, from the tangent t.
// S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", 1998, section 3.

const float PI = 3.14159265358979;

// The direction that is to the other side of the half vector h.
vec3 reflected(vec3 w, vec3 h) {
  return 2.0 * dot(w, h) * h - w;
}

// (theta_h, phi_h, theta_d, phi_d); phi_h is 0 where tables do not depend on it.
vec4 toHalfDiff(vec3 n, vec3 t, vec3 wi, vec3 wo) {
  vec3 h = normalize(wi + wo);
  vec3 across = cross(n, h);
  float sine = length(across);
  // Where h = n its azimuth counts as 0.
  bool isOff = sine > 1e-7;
  vec3 y = isOff ? across / sine : cross(n, t);
  vec3 x = cross(y, h);
  vec3 d = vec3(dot(wi, x), dot(wi, y), dot(wi, h));
  float phiD = abs(d.x) + abs(d.y) > 0.0 ? atan(d.y, d.x) : 0.0;
  // atan, never acos: a float32 acos cannot resolve the first cells of theta_h (0.011 degrees).
  float phiH = 0.0;
#ifdef TURNS
  if (isOff) phiH = atan(dot(h, cross(n, t)), dot(h, t));
#endif
  return vec4(atan(sine, dot(n, h)), phiH, atan(length(d.xy), d.z), phiD);
}
