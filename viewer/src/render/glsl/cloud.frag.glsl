// A material's thumbnail, cut to a disc; a ring around a stop and around what the pointer is on.
precision highp float;
uniform sampler2D uAtlas;
uniform float uColumns;
uniform vec3 uStop;
uniform vec3 uHovered;
uniform vec3 uGround;
flat in float vTile;
flat in vec2 vLook;
flat in float vSize;
out vec4 colour;

void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  float r = length(p);
  float disc = vLook.x > 0.0 ? 0.74 : 1.0;
  if (r > disc) {
    if (vLook.x == 0.0 || r > 1.0 || r < disc + 0.08) discard;
    colour = vec4(vLook.x > 1.5 ? uHovered : uStop, 1.0);
    return;
  }
  // The outermost pixels of a thumbnail are partly beside the sphere.
  vec2 inside = 0.5 + 0.485 * p / disc;
  vec2 tile = vec2(mod(vTile, uColumns), floor(vTile / uColumns));
  vec3 picture = textureLod(uAtlas, (tile + inside) / uColumns, 0.0).rgb;
  colour = vec4(mix(picture, uGround, vLook.y * 0.82), 1.0);
}
