// Lists the pixels in which a refractor is seen before anything opaque.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
layout(std430, binding = BINDING_PIXELS) buffer PixelList {
  uint pixel_count, pixel_groups[3];
  uint pixel[];  // x | y << 16
};
uniform usampler2D eye_owner;
uniform sampler2DArray eye_layers;
uniform sampler2DArray eye_receivers;  // distance in w; 0: nothing

void main() {
  ivec2 at = ivec2(texel_number());
  if (any(greaterThanEqual(at, textureSize(eye_owner, 0)))) return;
  float behind = texelFetch(eye_receivers, ivec3(at, 0), 0).w;
  float front = texelFetch(eye_layers, ivec3(at, 0), 0).w;
  if (texelFetch(eye_owner, at, 0).x == 0u || (behind > 0.0 && behind < front)) return;
  pixel[atomicAdd(pixel_count, 1u)] = uint(at.x) | uint(at.y) << 16;
}
