// A mesh for the geometry buffer, in world coordinates.
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
in vec3 normal;
in vec2 uv; // the same everywhere where the mesh has none
out vec3 vNormal;
out vec3 vPosition;
out vec2 vUv;

void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vNormal = mat3(modelMatrix) * normal;
  vPosition = world.xyz;
  vUv = uv;
  gl_Position = projectionMatrix * viewMatrix * world;
}
