// Lists the samples in which a refractor is seen before anything opaque. PIXEL_SIDE: receivers have one
// sample for so many of a pixel side, so that rays decide which is in front; the pixels are listed too.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
#ifdef PIXEL_SIDE
#define COPIES_TABLES
#include "refractor.glsl"
#include "receiver.glsl"
#endif
layout(std430, binding = BINDING_PIXELS) buffer PixelList {
  uint pixel_count, pixel_groups[3];
  uint pixel[];  // x | y << 16
};
uniform usampler2D eye_owner;
uniform vec2 eye_samples;  // across and up
uniform sampler2DArray eye_layers;

#ifdef PIXEL_SIDE
layout(std430, binding = BINDING_MERGED_PIXELS) buffer MergedList {
  uint merged_count, merged_groups[3];
  uint merged[];
};
layout(rgba32f, binding = 0) writeonly uniform image2D colour;  // image of samples
uniform vec4 eye_view[6];

vec2 own_eye_samples;

bool shows_refractor(View eye, ivec2 at) {
  if (texelFetch(eye_owner, at, 0).x == 0u) return false;
  vec3 o, d;
  view_ray(eye, (vec2(at) + 0.5) / own_eye_samples, o, d);
  float front = texelFetch(eye_layers, ivec3(at, 0), 0).w;
  float limit = front - touch * refractor_bounds.w;
  return !receiver_between(o, d, 0.0, limit) && !area_light_between(o, d, 0.0, limit, -1);
}

void main() {
  copy_tables();
  copy_surroundings();
  own_eye_samples = read_now(eye_samples);
  View eye = View(eye_view[0], eye_view[1], eye_view[2], eye_view[3], eye_view[4], eye_view[5]);
  ivec2 at = ivec2(texel_number());
  if (any(greaterThanEqual(vec2(PIXEL_SIDE * at), own_eye_samples))) return;
  bool some = false;
  for (int k = 0; k < PIXEL_SIDE * PIXEL_SIDE; k++) {
    ivec2 place = PIXEL_SIDE * at + ivec2(k % PIXEL_SIDE, k / PIXEL_SIDE);
    bool shows = shows_refractor(eye, place);
    if (shows) pixel[atomicAdd(pixel_count, 1u)] = uint(place.x) | uint(place.y) << 16;
    some = some || shows;
  }
  if (!some) return;
  merged[atomicAdd(merged_count, 1u)] = uint(at.x) | uint(at.y) << 16;
  for (int k = 0; k < PIXEL_SIDE * PIXEL_SIDE; k++)
    imageStore(colour, PIXEL_SIDE * at + ivec2(k % PIXEL_SIDE, k / PIXEL_SIDE), vec4(0));
}
#else
uniform sampler2DArray eye_receivers;  // distance in w; 0: nothing

void main() {
  ivec2 at = ivec2(texel_number());
  if (any(greaterThanEqual(vec2(at), eye_samples))) return;
  float behind = texelFetch(eye_receivers, ivec3(at, 0), 0).w;
  float front = texelFetch(eye_layers, ivec3(at, 0), 0).w;
  if (texelFetch(eye_owner, at, 0).x == 0u || (behind > 0.0 && behind < front)) return;
  pixel[atomicAdd(pixel_count, 1u)] = uint(at.x) | uint(at.y) << 16;
}
#endif
