// Where a place lies, in texels of the light's map or of the layer of its pages (page: -1, or which).
// Who includes this gives `light` and `map_size`.
#include "receiver_pages.glsl"

vec2 map_position(vec3 at, int page) {
#ifdef PAGES
  if (page >= 0) return place_on_page(light, page, at);
#endif
  vec3 uvz;
  project(lights[light].map_view, at, uvz);
  return warp(light, uvz.xy) * float(map_size);
}
