// Lists the samples of receivers in which light may vary more than one sample can tell: it bends there, from
// one side over the sample to the other. A sample next to one that shows a refractor is left alone; where
// one stands for PIXEL_SIDE x PIXEL_SIDE of refractors, one before which these all show some.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
layout(std430, binding = BINDING_ADAPTIVE_SAMPLES) buffer SampleList {
  uint sample_count, sample_groups[3];
  uint samples[];  // x | y << 16
};
uniform sampler2DArray eye_receivers;  // distance in w; 0: nothing
#ifdef REFRACTORS_SEEN
uniform usampler2D eye_owner;
uniform sampler2DArray eye_layers;
#endif
uniform float bend_share;  // of the light around it that the bend must be above
uniform float least_bend;  // radiance; and above this

bool shows_refractor(ivec2 at, float behind) {
#ifdef REFRACTORS_SEEN
  bool all = true;
  for (int k = 0; k < PIXEL_SIDE * PIXEL_SIDE; k++) {
    ivec2 place = PIXEL_SIDE * at + ivec2(k % PIXEL_SIDE, k / PIXEL_SIDE);
    float front = texelFetch(eye_layers, ivec3(place, 0), 0).w;
    all = all && texelFetch(eye_owner, place, 0).x != 0u && !(behind > 0.0 && behind < front);
  }
  return all;
#else
  return false;
#endif
}

void main() {
  ivec2 at = ivec2(texel_number()), size = textureSize(eye_receivers, 0).xy;
  if (any(greaterThanEqual(at, size))) return;
  vec3 around[9], sum = vec3(0), bend = vec3(0);
  bool refractor = false;
  for (int k = 0; k < 9; k++) {
    ivec2 near = clamp(at + ivec2(k % 3, k / 3) - 1, ivec2(0), size - 1);
    vec4 seen = texelFetch(eye_receivers, ivec3(near, 0), 0);
    around[k] = seen.rgb;
    sum += max(seen.rgb, vec3(0));
#if !defined(REFRACTORS_SEEN) || PIXEL_SIDE == 1
    refractor = shows_refractor(near, seen.w) || refractor;
#endif
  }
  for (int k = 0; k < 4; k++) bend = max(bend, abs(around[k] + around[8 - k] - 2.0 * around[4]));
#if defined(REFRACTORS_SEEN) && PIXEL_SIDE > 1
  refractor = shows_refractor(at, texelFetch(eye_receivers, ivec3(at, 0), 0).w);
#endif
  bool wanted = any(greaterThan(bend, bend_share / 9.0 * sum + least_bend));
  if (wanted && !refractor) samples[atomicAdd(sample_count, 1u)] = uint(at.x) | uint(at.y) << 16;
}
