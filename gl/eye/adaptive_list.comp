// Lists the samples of receivers in which light may vary more than one sample resolves: it bends there, from
// one side over the sample to the other. A sample next to one that shows a refractor is left alone; where
// one stands for PIXEL_SIDE x PIXEL_SIDE of refractors, one before which these all show some.
// PIXEL_SIDE is 0 where the camera sees no refractor.
// A thread has a column of ROWS, of which it keeps what it has read.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
layout(std430, binding = BINDING_ADAPTIVE_SAMPLES) buffer SampleList {
  uint sample_count, sample_groups[3];
  uint samples[];  // x | y << 16
};
uniform sampler2DArray eye_receivers;  // distance in w; 0: nothing
uniform vec2 receiver_samples;         // across and up
#if PIXEL_SIDE > 0
uniform usampler2D eye_owner;
uniform sampler2DArray eye_layers;
#endif
uniform float bend_share;  // share of the light around it that the bend must exceed
uniform float least_bend;  // radiance; and above this

struct Row {  // three samples side by side
  vec3 left, middle, right;
  float behind;  // the middle one's distance
  bool refractor;
};

#if PIXEL_SIDE > 0
bool shows_refractor(ivec2 at, float behind) {
  float front = texelFetch(eye_layers, ivec3(at, 0), 0).w;
  return texelFetch(eye_owner, at, 0).x != 0u && !(behind > 0.0 && behind < front);
}
#endif

Row read_row(ivec2 at, ivec2 size) {
  int y = clamp(at.y, 0, size.y - 1), left = max(at.x - 1, 0), right = min(at.x + 1, size.x - 1);
  vec4 a = texelFetch(eye_receivers, ivec3(left, y, 0), 0), b = texelFetch(eye_receivers, ivec3(at.x, y, 0), 0),
       c = texelFetch(eye_receivers, ivec3(right, y, 0), 0);
  Row row = Row(a.rgb, b.rgb, c.rgb, b.w, false);
#if PIXEL_SIDE == 1
  row.refractor = shows_refractor(ivec2(left, y), a.w) || shows_refractor(ivec2(at.x, y), b.w) ||
                  shows_refractor(ivec2(right, y), c.w);
#endif
  return row;
}

vec3 row_sum(Row r) { return max(r.left, vec3(0)) + max(r.middle, vec3(0)) + max(r.right, vec3(0)); }

void main() {
  const int ROWS = 4;
  ivec2 size = ivec2(receiver_samples), first = ivec2(texel_number()) * ivec2(1, ROWS);
  if (any(greaterThanEqual(first, size))) return;
  Row below = read_row(first - ivec2(0, 1), size), row = read_row(first, size);
  for (int y = first.y; y < first.y + ROWS; y++) {
    Row above = read_row(ivec2(first.x, y + 1), size);
    vec3 twice = 2.0 * row.middle, sum = row_sum(below) + row_sum(row) + row_sum(above);
    vec3 bend = max(max(abs(below.left + above.right - twice), abs(below.middle + above.middle - twice)),
                    max(abs(below.right + above.left - twice), abs(row.left + row.right - twice)));
    bool wanted = y < size.y && any(greaterThan(bend, bend_share / 9.0 * sum + least_bend));
#if PIXEL_SIDE > 1
    bool all = wanted;
    // Few need it: a loop whose length is not known is not unrolled, and ends where none does.
    for (int k = wanted ? 0 : PIXEL_SIDE * PIXEL_SIDE; all && k < PIXEL_SIDE * PIXEL_SIDE; k++)
      all = shows_refractor(PIXEL_SIDE * ivec2(first.x, y) + ivec2(k % PIXEL_SIDE, k / PIXEL_SIDE), row.behind);
    wanted = wanted && !all;
#else
    wanted = wanted && !(below.refractor || row.refractor || above.refractor);
#endif
    if (wanted) samples[atomicAdd(sample_count, 1u)] = uint(first.x) | uint(y) << 16;
    below = row;
    row = above;
  }
}
