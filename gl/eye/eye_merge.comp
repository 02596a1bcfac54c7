// Pixels of which some samples show a refractor: their mean with what receivers show in the pixel.
layout(local_size_x = 256) in;
#include "thread.glsl"
layout(std430, binding = BINDING_MERGED_PIXELS) readonly buffer MergedList {
  uint merged_count, merged_groups[3];
  uint merged[];  // x | y << 16
};
layout(binding = 1) uniform sampler2D refraction;
layout(rgba32f, binding = 0) uniform image2D picture;  // w: distance
uniform int samples;  // a pixel side

void main() {
  uint listed = thread_number();
  if (listed >= merged_count) return;
  ivec2 pixel = ivec2(merged[listed] & 0xffffu, merged[listed] >> 16);
  vec4 behind = imageLoad(picture, pixel);
  vec3 sum = vec3(0);
  float nearest = 0.0;
  for (int y = 0; y < samples; y++)
    for (int x = 0; x < samples; x++) {
      vec4 glass = texelFetch(refraction, pixel * samples + ivec2(x, y), 0);
      vec4 seen = glass.w > 0.0 ? glass : behind;
      sum += seen.rgb;
      if (seen.w > 0.0 && (nearest == 0.0 || seen.w < nearest)) nearest = seen.w;
    }
  imageStore(picture, pixel, vec4(sum / float(samples * samples), nearest));
}
