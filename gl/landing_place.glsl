// Where a landing lies, in texels of the light's map or, by its path, of the layer of its pages. Who
// includes this gives `light` and `map_size`.
#include "receiver_pages.glsl"

vec2 map_position(vec3 at, uint path) {
#ifdef PAGES
  if ((path & ON_A_PAGE) != 0u) return at.xy;
#endif
  vec3 uvz;
  project(lights[light].map_view, at, uvz);
  return warp(light, uvz.xy) * float(map_size);
}
