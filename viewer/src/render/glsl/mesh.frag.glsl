in vec3 vNormal;
in vec3 vPosition;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 position;

void main() {
  normal = vec4(normalize(gl_FrontFacing ? vNormal : -vNormal), 1.0);
  position = vec4(vPosition, 1.0);
}
