// Whether a mesh stands between a point and the light: the first triangle that a ray meets decides (occluder.ts).

uniform highp sampler2D uBoxes;
uniform highp sampler2D uTriangles;
uniform int uBoxCount; // 0: nothing casts a shadow

const int BITS = @BITS@; // of the texels in a row
// On its own triangle a ray begins, give or take the rounding of float32. The objects are some units wide.
const float NEAR = 5e-4;
const float FAR = 1e9;

vec4 texel(highp sampler2D list, int i) {
  return texelFetch(list, ivec2(i & ((1 << BITS) - 1), i >> BITS), 0);
}

// T. Moller, B. Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection", Journal of Graphics Tools 2(1), 1997.
bool crosses(int triangle, vec3 from, vec3 way, float far) {
  vec3 s = from - texel(uTriangles, 3 * triangle).xyz;
  vec3 a = texel(uTriangles, 3 * triangle + 1).xyz;
  vec3 b = texel(uTriangles, 3 * triangle + 2).xyz;
  vec3 p = cross(way, b);
  vec3 q = cross(s, a);
  // Where the ray is parallel to the triangle these are no numbers, and no comparison holds.
  vec3 uvt = vec3(dot(s, p), dot(way, q), dot(b, q)) / dot(a, p);
  return uvt.x >= 0.0 && uvt.y >= 0.0 && uvt.x + uvt.y <= 1.0 && uvt.z > NEAR && uvt.z < far;
}

// Of a unit way; what is farther than `far` casts no shadow.
bool occluded(vec3 from, vec3 way, float far) {
  vec3 steps = 1.0 / mix(way, vec3(1e-20), equal(way, vec3(0.0)));
  int i = 0;
  while (i < uBoxCount) {
    vec4 low = texel(uBoxes, 2 * i);
    vec4 high = texel(uBoxes, 2 * i + 1);
    vec3 a = (low.xyz - from) * steps;
    vec3 b = (high.xyz - from) * steps;
    vec3 enter = min(a, b);
    vec3 leave = max(a, b);
    bool met = max(max(enter.x, enter.y), max(enter.z, NEAR)) <= min(min(leave.x, leave.y), min(leave.z, far));
    int count = int(high.w);
    if (met) {
      for (int k = 0; k < count; k++) {
        if (crosses(int(low.w) + k, from, way, far)) return true;
      }
    }
    i = met || count > 0 ? i + 1 : int(low.w);
  }
  return false;
}
