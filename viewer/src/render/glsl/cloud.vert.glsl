precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float uPixels;
uniform float uDistance; // at which a sphere is uPixels wide
in vec3 position;
in float tile;
in vec4 tint; // sRGB, and whether it stands for the picture
in vec2 look; // ring: 0 none, 1 stop, 2 hovered; dimmed
flat out float vTile;
flat out vec2 vLook;
flat out vec4 vTint;
flat out float vSize;

void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * at;
  vTile = tile;
  vLook = look;
  vTint = tint;
  // Room for the ring.
  vSize = uPixels * uDistance / length(at.xyz) * (look.x > 0.0 ? 1.45 : 1.0);
  gl_PointSize = vSize;
}
