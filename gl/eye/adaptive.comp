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
layout(rgba32f, binding = 0) uniform image2D radiance;  // w: distance from the camera, of the first sample
#ifdef AOVS
layout(rgba32f, binding = 1) writeonly uniform image2D direct;
layout(rgba32f, binding = 2) writeonly uniform image2D caustic;
#endif
uniform int side;

// So many times their mean may be what one of the rays shows.
const float MOST_PEAK = 4.0;

// The mean of rays x rays; peaked: it is of too few.
Shading mean_light(ivec2 at, int rays, out bool peaked) {
  vec2 area = 1.0 / (float(rays) * own_samples);
  Shading sum = Shading(vec3(0), vec3(0), vec3(0));
  vec3 most = vec3(0);
  for (int i = 0; i < rays * rays; i++) {
    ivec2 ray = ivec2(i % rays, i / rays);
    bool met;
    float t;
    Shading s = ray_light((vec2(at * rays + ray) + 0.5) * area, area, met, t);
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
