// The tangent of a surface, known by its angle about the normal n from the level one.

// Around the vertical, counter-clockwise seen from above; along x where the surface lies level.
vec3 level(vec3 n) {
  float sine = length(n.xy);
  return sine > 1e-6 ? vec3(-n.y, n.x, 0.0) / sine : vec3(1.0, 0.0, 0.0);
}

// Of a vector, in radians; of none 0.
float fromLevel(vec3 n, vec3 v) {
  vec3 x = level(n);
  vec2 at = vec2(dot(v, x), dot(v, cross(n, x)));
  return at == vec2(0.0) ? 0.0 : atan(at.y, at.x);
}

vec3 tangent(vec3 n, float angle) {
  vec3 x = level(n);
#ifdef TURNS
  return cos(angle) * x + sin(angle) * cross(n, x);
#else
  return x;
#endif
}
