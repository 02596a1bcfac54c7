// The listed samples of receivers once more, each as the mean of side x side rays spread over its area, or
// of twice as many a side where one of these shows far more than the others.
layout(local_size_x = 256) in;
#include "thread.glsl"
#define COPIES_TABLES
#define SEEN_BY_AREAS
#include "refractor.glsl"
#include "receiver.glsl"
#include "receiver_sight.glsl"
layout(std430, binding = BINDING_ADAPTIVE_SAMPLES) readonly buffer SampleList {
  uint sample_count, sample_groups[3];
  uint samples[];  // x | y << 16
};
layout(rgba32f, binding = 0) uniform image2D radiance;  // w: distance from the eye, of the first sample
#ifdef AOVS
layout(rgba32f, binding = 1) writeonly uniform image2D direct;
layout(rgba32f, binding = 2) writeonly uniform image2D caustic;
#endif
uniform vec4 eye_view[6];
uniform vec2 receiver_samples;  // across and up
uniform int side;

View own_eye_view;
vec2 own_samples;

void copy_all() {
  copy_tables();
  copy_surroundings();
  own_samples = read_now(receiver_samples);
  own_eye_view = View(read_now(eye_view[0]), read_now(eye_view[1]), read_now(eye_view[2]), read_now(eye_view[3]),
                      read_now(eye_view[4]), read_now(eye_view[5]));
}

vec3 on_plane(vec3 p, vec3 n, vec2 uv) {
  vec3 o, d;
  view_ray(own_eye_view, uv, o, d);
  return o + dot(p - o, n) / dot(d, n) * d;
}

// What a ray shows that stands for `area` of the window.
Shading ray_light(vec2 uv, vec2 area) {
  vec3 o, d;
  float t;
  Sighting at;
  view_ray(own_eye_view, uv, o, d);
  if (!receiver_seen(o, d, 0.0, 1e30, t, at)) return Shading(vec3(0), vec3(0), surroundings(d));
#ifdef RECEIVER_HIERARCHY
  vec3 n = face_n;
#else
  vec3 n = at.n;
#endif
  area_right = on_plane(at.p, n, uv + vec2(area.x, 0)) - at.p;
  area_above = on_plane(at.p, n, uv + vec2(0, area.y)) - at.p;
  return shade(at.p, at.n, at.surface, at.uv, at.side);
}

// So many times their mean may be what one of the rays shows.
const float MOST_PEAK = 4.0;

// The mean of rays x rays; peaked: it is of too few.
Shading mean_light(ivec2 at, int rays, out bool peaked) {
  vec2 area = 1.0 / (float(rays) * own_samples);
  Shading sum = Shading(vec3(0), vec3(0), vec3(0));
  vec3 most = vec3(0);
  for (int i = 0; i < rays * rays; i++) {
    ivec2 ray = ivec2(i % rays, i / rays);
    Shading s = ray_light((vec2(at * rays + ray) + 0.5) * area, area);
    sum.direct += s.direct;
    sum.caustic += s.caustic;
    sum.fill += s.fill;
    most = max(most, s.direct + s.caustic + s.fill);
  }
  float share = 1.0 / float(rays * rays);
  peaked = any(greaterThan(most, MOST_PEAK * share * (sum.direct + sum.caustic + sum.fill)));
  return Shading(share * sum.direct, share * sum.caustic, share * sum.fill);
}

void main() {
  copy_all();
  uint listed = thread_number();
  if (listed >= sample_count) return;
  ivec2 at = ivec2(samples[listed] & 0xffffu, samples[listed] >> 16);
  Shading s;
  bool peaked = true;
  for (int rays = side; peaked && rays <= 2 * side; rays *= 2) s = mean_light(at, rays, peaked);
  imageStore(radiance, at, vec4(s.direct + s.caustic + s.fill, imageLoad(radiance, at).w));
#ifdef AOVS
  imageStore(direct, at, vec4(s.direct, 1));
  imageStore(caustic, at, vec4(s.caustic, 1));
#endif
}
