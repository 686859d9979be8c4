// A material's thumbnail, cut to a disc; a ring around a stop and around what the pointer is on. Edges are a pixel wide.
precision highp float;
uniform sampler2D uAtlas;
uniform float uColumns;
uniform vec3 uStop;
uniform vec3 uHovered;
uniform vec3 uGround;
flat in float vTile;
flat in vec2 vLook;
flat in vec4 vTint;
flat in float vSize;
out vec4 colour;

// Share of a pixel that is inside a radius.
float within(float radius, float r) {
  return clamp(0.5 * vSize * (radius - r), 0.0, 1.0);
}

void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  float r = length(p);
  bool ringed = vLook.x > 0.0;
  float radius = ringed ? 0.74 : 1.0;
  float disc = within(radius, r);
  float ring = ringed ? within(1.0, r) * (1.0 - within(radius + 0.12, r)) : 0.0;
  float coverage = disc + ring;
  if (coverage == 0.0) discard;
  // The outermost pixels of a thumbnail are partly beside the sphere.
  vec2 inside = 0.5 + 0.485 * p * min(1.0 / radius, 1.0 / max(r, 1e-6));
  vec2 tile = vec2(mod(vTile, uColumns), floor(vTile / uColumns));
  vec3 picture = textureLod(uAtlas, (tile + inside) / uColumns, 0.0).rgb;
  // A little darker at the rim, so that they are told apart.
  picture = mix(picture, vTint.rgb * (1.0 - 0.3 * r * r), vTint.a);
  picture = mix(picture, uGround, vLook.y * 0.82);
  vec3 around = vLook.x > 1.5 ? uHovered : uStop;
  colour = vec4(disc * picture + ring * around, coverage);
}
