// The grid's sums as light that is scattered in each cell, W/m3, in the layers of a texture; behind them its mean
// direction, by how much there is.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
layout(std430, binding = BINDING_MAP_SUMS) readonly buffer Sums { int sum[]; };
layout(rgba32f, binding = 0) writeonly uniform image2DArray light;
uniform vec3 cells;  // along each axis
uniform int first_layer;
uniform float unit;  // W/m3 that a unit comes to

void main() {
  ivec2 at = ivec2(texel_number());
  if (any(greaterThanEqual(at, ivec2(cells.xy)))) return;
  for (int z = 0; z < int(cells.z); z++) {
    int first = ((z * int(cells.y) + at.y) * int(cells.x) + at.x) * 6;
    imageStore(light, ivec3(at, first_layer + z), unit * vec4(sum[first], sum[first + 1], sum[first + 2], 0));
    imageStore(light, ivec3(at, first_layer + int(cells.z) + z), unit * vec4(sum[first + 3], sum[first + 4], sum[first + 5], 0));
  }
}
