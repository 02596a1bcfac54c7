// Receivers as the camera sees them, by a ray a sample: of what moves, where their triangles are far more than
// samples. Where there is none the picture stays.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
#define COPIES_TABLES
#define SEEN_BY_AREAS
#include "refractor.glsl"
#include "receiver.glsl"
#include "receiver_sight.glsl"
layout(rgba32f, binding = 0) writeonly uniform image2D radiance;  // w: distance from the camera
#ifdef AOVS
layout(rgba32f, binding = 1) writeonly uniform image2D direct;
layout(rgba32f, binding = 2) writeonly uniform image2D caustic;
#endif

void main() {
  copy_all();
  ivec2 at = ivec2(texel_number());
  if (any(greaterThanEqual(vec2(at), own_samples))) return;
  bool met;
  float t;
  Shading s = ray_light((vec2(at) + 0.5) / own_samples, 1.0 / own_samples, met, t);
  if (!met) return;
  imageStore(radiance, at, vec4(s.direct + s.caustic + s.fill, t));
#ifdef AOVS
  imageStore(direct, at, vec4(s.direct, 1));
  imageStore(caustic, at, vec4(s.caustic, 1));
#endif
}
