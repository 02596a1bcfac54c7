// A vertex a pixel of what the light sees of its objects, brought to where its light lands.
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
uniform int grid, wavelength;
uniform vec3 colour[WAVELENGTHS];
uniform float strength;    // strength of a vertex, in a splat's peak
uniform float splat_size;  // texels
uniform vec4 spot;         // direction, cosine of the cone
uniform float spot_inner;
uniform float object_bias;  // m
#ifdef PLACES_CUBE
out vec3 landed;        // m
out vec4 landed_light;  // w: 0 where none lands
#else
flat out vec2 centre;  // on the map, 0 to 1
flat out vec3 peak;
#endif

// Light of a pixel, of what a unit of it is.
float pixel_light(vec3 at, ivec2 pixel) {
  vec3 d = seen_direction(at);
  float c = dot(d, spot.xyz), beam = spot_inner > spot.w ? smoothstep(spot.w, spot_inner, c) : step(spot.w, c);
#ifdef AS_PRINTED
  return beam * abs(dot(texelFetch(object_normals, ivec3(pixel, 2 * object_face), 0).xyz, d));
#else
  vec3 seen;
  bool hidden = look_up(at, seen) && dot(seen - at, places_axis(at)) < -object_bias;
  return hidden ? 0.0 : beam * window_measure(object_view(object_face), d);
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_VertexID % grid, gl_VertexID / grid);
  Ray ray;
  vec3 at, uvz;
#ifdef PLACES_CUBE
  landed = vec3(0);
  landed_light = vec4(0);
#else
  centre = vec2(-1);
  peak = vec3(0);
#endif
  gl_PointSize = 1.0;
  gl_Position = vec4(2, 2, 2, 1);  // outside
  if (!leave_object(pixel, wavelength, ray) || ray.total) return;
  if (!find_receiver(ray.o, ray.r, at)) return;
#ifndef PLACES_CUBE
  if (!project(places_view(), at, uvz) || !inside(uvz.xy)) return;
#endif
  vec3 front = texelFetch(object_places, ivec3(pixel, 2 * object_face), 0).xyz;
  float light = strength * pixel_light(front, pixel) * ray.share;
  if (ray.inside > 0.0) light *= exp(-ray.inside * distance(ray.o, at));
#ifdef PLACES_CUBE
  landed = at;
  landed_light = vec4(light * colour[wavelength], 1);
#else
  centre = uvz.xy;
  peak = light * colour[wavelength];
  gl_PointSize = splat_size;
  gl_Position = vec4(2.0 * uvz.xy - 1.0, 0, 1);
#endif
}
