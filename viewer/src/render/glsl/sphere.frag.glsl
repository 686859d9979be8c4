// What a camera sees of a sphere, exactly: normal and position of each pixel. Its tangents are level.

uniform mat4 uToWorld; // from clip coordinates
uniform vec3 uEye;
uniform vec2 uSize;
uniform vec4 uSphere; // centre, radius
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 position;

void main() {
  vec2 clip = 2.0 * gl_FragCoord.xy / uSize - 1.0;
  vec4 far = uToWorld * vec4(clip, 1.0, 1.0);
  vec3 ray = normalize(far.xyz / far.w - uEye);
  vec3 centre = uSphere.xyz - uEye;
  float along = dot(ray, centre);
  // The squared distance of the ray to the centre, without the cancellation of |centre|^2 - along^2.
  vec3 miss = centre - along * ray;
  float inside = uSphere.w * uSphere.w - dot(miss, miss);
  if (inside <= 0.0) {
    normal = vec4(0.0);
    position = vec4(0.0);
    return;
  }
  vec3 at = ray * (along - sqrt(inside));
  normal = vec4((at - centre) / uSphere.w, 1.0);
  position = vec4(at + uEye, 0.0);
}
