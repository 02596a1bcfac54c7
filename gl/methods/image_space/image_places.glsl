// What a view sees, as places: of receivers, and of refractors and mirrors in front and behind. PLACES_CUBE: of
// receivers the six views of a cube around the light; OBJECT_FACES: so many of objects.
#include "common.glsl"
#ifndef OBJECT_FACES
#define OBJECT_FACES 1
#endif
#ifdef PLACES_CUBE
const int PLACE_FACES = 6;
uniform sampler2DArray receiver_places;
#else
const int PLACE_FACES = 1;
uniform sampler2D receiver_places;
#endif
uniform vec4 seen_from[6 * PLACE_FACES], objects_from[6 * OBJECT_FACES];
uniform sampler2DArray object_places, object_normals;  // layers: front, back of each view

View places_face(int face) {
  int k = 6 * face;
  return View(seen_from[k], seen_from[k + 1], seen_from[k + 2], seen_from[k + 3], seen_from[k + 4], seen_from[k + 5]);
}

// The first: where the light is, and how far it sees.
View places_view() { return places_face(0); }

View object_view(int face) {
  int k = 6 * face;
  return View(objects_from[k], objects_from[k + 1], objects_from[k + 2], objects_from[k + 3], objects_from[k + 4],
              objects_from[k + 5]);
}

int receiver_face(vec3 at) {
#ifdef PLACES_CUBE
  return cube_face(at - seen_from[0].xyz);
#else
  return 0;
#endif
}

// The axis of the view that shows a place.
vec3 places_axis(vec3 at) { return places_face(receiver_face(at)).forward.xyz; }

// The place on a receiver that the view sees in the direction of `at`.
bool look_up(vec3 at, out vec3 seen) {
  vec3 uvz;
  int face = receiver_face(at);
  seen = at;
  if (!project(places_face(face), at, uvz) || !inside(uvz.xy)) return false;
#ifdef PLACES_CUBE
  vec4 place = textureLod(receiver_places, vec3(uvz.xy, face), 0.0);
#else
  vec4 place = textureLod(receiver_places, uvz.xy, 0.0);
#endif
  seen = place.xyz / max(place.w, 1e-6);  // the mean of neighbours, where they are interpolated
  return place.w > 0.5;
}

vec3 seen_direction(vec3 at) {
  View v = places_view();
  return v.origin.w > 0.5 ? normalize(at - v.origin.xyz) : v.forward.xyz;
}
