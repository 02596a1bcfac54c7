// The part of a light's near view through which light reaches refractors: the least and greatest
// column and row of a lattice of rays that do.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
#define COPIES_TABLES
#include "refractor.glsl"
#include "receiver.glsl"

#include "pass_light.glsl"
#include "photon_start.glsl"

uniform int side;  // rays
uniform ivec2 first, count;
uniform int spacing;
layout(std430, binding = BINDING_FOUND_BOX) buffer Box { uint box[4]; };  // left, right, bottom, top

void main() {
  copy_tables();
  copy_surroundings();
  copy_light();
  uvec2 number = texel_number();
  if (number.x >= uint(count.x) || number.y >= uint(count.y)) return;
  uvec2 at = uvec2(first) + number * uint(spacing);
  vec3 o, d;
  Hit front;
  float flux;
  if (!photon_start((vec2(at) + 0.5) / float(side), o, d, front, flux)) return;
  atomicMin(box[0], at.x);
  atomicMax(box[1], at.x);
  atomicMin(box[2], at.y);
  atomicMax(box[3], at.y);
}
