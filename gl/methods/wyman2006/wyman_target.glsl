// The image that photons are drawn into: the light's or the camera's, and what of receivers it sees.
#include "view.glsl"
uniform vec4 drawn_from[6];
uniform sampler2D drawn_places;
const float HIDDEN = 0.01;  // share of the distance
#ifdef CORNERS  // light varies over a polygon
#define OF_POLYGON
#else
#define OF_POLYGON flat
#endif

View drawn_view() {
  return View(drawn_from[0], drawn_from[1], drawn_from[2], drawn_from[3], drawn_from[4], drawn_from[5]);
}

float seen_distance(ivec2 pixel) {
  vec4 seen = texelFetch(drawn_places, clamp(pixel, ivec2(0), textureSize(drawn_places, 0) - 1), 0);
  return seen.w > 0.5 ? distance(drawn_from[0].xyz, seen.xyz) : 1e30;
}

// How far the distance changes from a pixel to the next, on the side where it changes less.
float slope(ivec2 pixel, ivec2 step, float here) {
  return min(abs(seen_distance(pixel + step) - here), abs(seen_distance(pixel - step) - here));
}

// Whether a place on a receiver is not behind, nor before, what the image shows at a pixel.
bool shows(vec3 at, ivec2 pixel) {
  float here = seen_distance(pixel), off = abs(distance(drawn_from[0].xyz, at) - here);
  if (here > 1e29) return false;
  if (off < HIDDEN * here) return true;
  return off < HIDDEN * here + slope(pixel, ivec2(1, 0), here) + slope(pixel, ivec2(0, 1), here);
}
