// The picture: refractors over receivers, samples averaged to pixels.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
layout(binding = 0) uniform sampler2DArray receivers;
layout(binding = 1) uniform sampler2D refraction;
layout(rgba32f, binding = 0) writeonly uniform image2D picture;
uniform int samples;  // a pixel side
uniform ivec2 size;   // pixels

void main() {
  ivec2 pixel = ivec2(texel_number());
  if (any(greaterThanEqual(pixel, size))) return;
  vec3 sum = vec3(0);
  float nearest = 0.0;
  for (int y = 0; y < samples; y++)
    for (int x = 0; x < samples; x++) {
      ivec2 at = pixel * samples + ivec2(x, y);
      vec4 glass = texelFetch(refraction, at, 0);
      vec4 seen = glass.w > 0.0 ? glass : texelFetch(receivers, ivec3(at, 0), 0);
      sum += seen.rgb;
      if (seen.w > 0.0 && (nearest == 0.0 || seen.w < nearest)) nearest = seen.w;
    }
  imageStore(picture, pixel, vec4(sum / float(samples * samples), nearest));
}
