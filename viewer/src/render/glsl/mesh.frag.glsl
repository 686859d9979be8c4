in vec3 vNormal;
in vec3 vPosition;
in vec2 vUv;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 position;

// Where u grows and v does not, of the triangle: both are linear on it, and so are their differences from pixel to pixel.
vec3 alongU() {
  vec2 a = dFdx(vUv);
  vec2 b = dFdy(vUv);
  return sign(a.x * b.y - b.x * a.y) * (b.y * dFdx(vPosition) - a.y * dFdy(vPosition));
}

void main() {
  vec3 n = normalize(gl_FrontFacing ? vNormal : -vNormal);
  normal = vec4(n, 1.0);
  position = vec4(vPosition, fromLevel(n, alongU()));
}
