// What a beam of light brings to a pixel: of its length there what is scattered towards the camera, and of that what
// its light has there across.
#include "common.glsl"
#include "haze.glsl"
#include "beam.glsl"
flat in vec4 places, last_light, depth_length, first_widths, last_widths, way_light, grows_light;
uniform vec3 eye;
uniform bool eye_in_air;
layout(location = 0) out vec4 radiance;

void main() {
  float pixels = depth_length.z, length_m = depth_length.w;
  vec2 along = (places.zw - places.xy) / pixels, from_first = gl_FragCoord.xy - places.xy;
  float q = clamp(dot(from_first, along) / pixels, 0.0, 1.0);
  float share = beam_share(mix(first_widths.xyz, last_widths.xyz, q), along.x * from_first.y - along.y * from_first.x);
  // Depth is even along the segment, its inverse along the picture.
  float far = depth_length.x * depth_length.y, z = far / mix(depth_length.y, depth_length.x, q);
  float to_end_m = length_m * (1.0 - q * z / depth_length.y);
  vec3 from = last_light.xyz - to_end_m * way_light.xyz - eye;
  float distance_m = length(from), unused;
  vec3 d = from / distance_m;
  float metres = min(length_m / pixels * z * z / far, distance_m);  // a pixel
  float seen_way = distance_m;
  if (eye_in_air) seen_way = haze_way(eye, d, 0.0, distance_m, unused);
  // The solid angle of a pixel goes by its cosine to the axis, z / distance, cubed.
  float scattered = share * metres * haze_phase(haze_g, -dot(way_light.xyz, d)) * first_widths.w * distance_m / (z * z * z);
  vec3 light_there = vec3(last_light.w, way_light.w, grows_light.w) * exp(grows_light.xyz * (to_end_m - seen_way));
  radiance = vec4(light_there * scattered, 0);
}
