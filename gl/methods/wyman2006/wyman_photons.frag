// A photon a pixel of the light's grid, at a wavelength: where it meets its first diffuse surface, from which
// direction, how much of it is left, and its solid angle by the window's area.
#include "image_places.glsl"
#if ESTIMATOR == ESTIMATOR_EXACT
#if defined(HIERARCHY) || defined(RECEIVER_HIERARCHY)
#include "hierarchy.glsl"
#endif
uniform vec4 refractor_bounds;
#include "receiver_hit.glsl"
#endif
#include "image_search.glsl"
#include "image_path.glsl"
uniform int wavelength;
uniform vec4 spot;  // direction, cosine of the cone
uniform float spot_inner;
uniform float object_bias;  // m
uniform vec4 mirror_plane;   // what mirrors send light to, as printed: n . x = w
layout(location = 0) out vec4 place;     // m; w: share of its light, 0: none
layout(location = 1) out vec4 incident;  // unit; w: solid angle by window area

float beam_of(vec3 d) {
  float c = dot(d, spot.xyz);
  return spot_inner > spot.w ? smoothstep(spot.w, spot_inner, c) : step(spot.w, c);
}

bool land(ivec2 pixel, Ray ray, out vec3 at) {
#if defined(AS_PRINTED) && defined(MIRRORS)
  if (refractors[int(texelFetch(object_normals, ivec3(pixel, 2 * object_face), 0).w + 0.5) - 1].info.z == -1) {
    float towards = dot(mirror_plane.xyz, ray.r), d = (mirror_plane.w - dot(mirror_plane.xyz, ray.o)) / towards;
    at = ray.o + d * ray.r;
    return towards != 0.0 && d > 0.0;
  }
#endif
  return find_receiver(ray.o, ray.r, at);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  Ray ray;
  vec3 at;
  place = vec4(0);
  incident = vec4(0);
  if (!leave_object(pixel, wavelength, ray) || ray.total || !land(pixel, ray, at)) return;
  vec3 front = texelFetch(object_places, ivec3(pixel, 2 * object_face), 0).xyz, d = seen_direction(front);
  float light = ray.share * beam_of(d);
  if (ray.inside > 0.0) light *= exp(-ray.inside * distance(ray.o, at));
#ifndef AS_PRINTED
  vec3 seen;
  if (look_up(front, seen) && dot(seen - front, places_axis(front)) < -object_bias) light = 0.0;
#endif
  place = vec4(at, light);
  incident = vec4(normalize(ray.r), window_measure(object_view(object_face), d));
}
