// What a beam of light brings to a pixel: of its length there what is scattered towards the eye, and of that what
// its light has there across.
#include "common.glsl"
#include "haze.glsl"
#include "beam.glsl"
uniform samplerBuffer beams;
flat in int beam;
uniform vec3 eye;
uniform vec4 eye_view[6];
uniform vec2 size;  // pixels
uniform bool eye_in_air;
layout(location = 0) out vec4 radiance;

void main() {
  vec4 places = texelFetch(beams, beam), depths = texelFetch(beams, beam + 1), across = texelFetch(beams, beam + 2);
  vec4 first = texelFetch(beams, beam + 3), last = texelFetch(beams, beam + 4), grows = texelFetch(beams, beam + 5);
  vec2 along = places.zw - places.xy, from_first = gl_FragCoord.xy - places.xy;
  float pixels = length(along), q = clamp(dot(from_first, along) / (pixels * pixels), 0.0, 1.0);
  vec3 widths = mix(vec3(depths.z, across.xz), vec3(depths.w, across.yw), q);
  float share = beam_share(widths, (along.x * from_first.y - along.y * from_first.x) / pixels);
  // Depth is even along the segment, its inverse along the picture.
  float z = 1.0 / mix(1.0 / depths.x, 1.0 / depths.y, q), length_m = distance(first.xyz, last.xyz);
  vec3 at = mix(first.xyz, last.xyz, q * z / depths.y), way = (last.xyz - first.xyz) / length_m, from = at - eye;
  float distance_m = length(from), unused;
  vec3 d = from / distance_m;
  float metres = min(length_m / pixels * z * z / (depths.x * depths.y), distance_m);  // a pixel
  float seen_way = eye_in_air ? haze_way(eye, d, 0.0, distance_m, unused) : distance_m;
  vec2 per_tangent = size / (eye_view[4].yw - eye_view[4].xz);
  float cosine = z / distance_m, measure = cosine * cosine * cosine / (per_tangent.x * per_tangent.y);
  float scattered = share * metres * haze_phase(haze_g, -dot(way, d)) / (distance_m * distance_m * measure);
  vec3 light_there = vec3(first.w, last.w, grows.w) * exp(grows.xyz * (distance(at, last.xyz) - seen_way));
  radiance = vec4(light_there * scattered, 0);
}
