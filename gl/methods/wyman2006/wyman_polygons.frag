// In the light's image as what points are summed to: a ratio by what a texel's window area is in solid angle.
#include "wyman_target.glsl"
OF_POLYGON in vec3 ratio;
OF_POLYGON in vec3 direction;
in vec3 world;
layout(location = 0) out vec4 sum;  // w: how many polygons lie there
layout(location = 1) out vec4 directions;

void main() {
#ifdef IN_CAMERA
  if (!shows(world, ivec2(gl_FragCoord.xy))) discard;
  float scale = 1.0;
#else
  View v = drawn_view();
  float scale = window_measure(v, normalize(world - v.origin.xyz));
#endif
  sum = vec4(scale * ratio, 1);
  directions = vec4(scale * direction, 0);
}
