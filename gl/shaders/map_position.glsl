// Where a place lies, in texels of the light's map or of the layer of its tiles (tile: -1, or which).
// Who includes this gives `light`, `pass_light` and `map_size`.
#include "receiver_atlas.glsl"

vec2 map_position(vec3 at, int tile) {
#ifdef TILES
  if (tile >= 0) return place_on_tile(light, tile, at);
#endif
  vec3 uvz;
  project(pass_light.map_view, at, uvz);
  return warp(light, uvz.xy) * float(map_size);
}
