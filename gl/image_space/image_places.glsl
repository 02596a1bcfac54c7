// What a view sees, as places: of receivers, and of refractors and mirrors in front and behind.
#include "common.glsl"
uniform vec4 seen_from[6];
uniform sampler2D receiver_places;
uniform sampler2DArray object_places, object_normals;  // layers: front, back

View places_view() {
  return View(seen_from[0], seen_from[1], seen_from[2], seen_from[3], seen_from[4], seen_from[5]);
}

// The place on a receiver that the view sees in the direction of `at`.
bool look_up(vec3 at, out vec3 seen) {
  vec3 uvz;
  seen = at;
  if (!project(places_view(), at, uvz) || !inside(uvz.xy)) return false;
  vec4 place = textureLod(receiver_places, uvz.xy, 0.0);
  seen = place.xyz / max(place.w, 1e-6);  // of neighbours, where they are interpolated
  return place.w > 0.5;
}

vec3 seen_direction(vec3 at) {
  View v = places_view();
  return v.origin.w > 0.5 ? normalize(at - v.origin.xyz) : v.forward.xyz;
}
