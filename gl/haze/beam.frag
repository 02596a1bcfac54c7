// What a line of light brings to the pixels that it crosses: of its length there what is scattered towards
// the eye. A line covers one pixel of each column or row, whichever it has more of.
#include "common.glsl"
#include "haze.glsl"
in vec3 at;
flat in vec3 power, end, way;
uniform vec3 eye;
uniform vec4 eye_view[6];
uniform vec2 size;           // pixels
uniform vec3 haze_around;    // as haze_air, of the medium that the eye is in
uniform bool eye_in_air;
layout(location = 0) out vec4 radiance;

void main() {
  vec3 from = at - eye;
  float distance_m = length(from), first;
  vec3 d = from / distance_m;
  bool hazy = !eye_in_air || (all(greaterThan(at, haze_low)) && all(lessThan(at, haze_high)));
  float seen_way = eye_in_air ? haze_way(eye, d, 0.0, distance_m, first) : distance_m;
  float lost_way = distance(at, end);
  if (eye_in_air) lost_way = haze_way(at, way, 0.0, lost_way, first);
  vec3 forward = eye_view[3].xyz, right = eye_view[1].xyz, up = eye_view[2].xyz;
  vec4 window = eye_view[4];
  float z = dot(from, forward);
  vec2 xy = vec2(dot(from, right), dot(from, up));
  vec2 per_tangent = size / (window.yw - window.xz);
  vec2 slope = (vec2(dot(way, right), dot(way, up)) * z - xy * dot(way, forward)) / (z * z) * per_tangent;
  float length_m = 1.0 / max(max(abs(slope.x), abs(slope.y)), 1e-20);
  length_m = min(length_m, distance_m);  // of a line towards the eye no more than is near
  float cosine = z / distance_m, measure = cosine * cosine * cosine / (per_tangent.x * per_tangent.y);
  float share = haze_around.x * haze_phase(haze_around.z, -dot(way, d)) * length_m /
                (distance_m * distance_m * measure) * exp(haze_around.y * (lost_way - seen_way));
  radiance = hazy ? vec4(power * share, 0) : vec4(0);
}
