// Fixed-point sums to flux over window area, XYZ, in the light's layer of the spectral map.
layout(local_size_x = 64) in;
#include "common.glsl"
layout(std430, binding = 13) readonly buffer MapSums { uint map_sum[]; };
layout(rgba32f, binding = 0) writeonly uniform image2DArray map;
uniform int light;
uniform int map_size;

float wide(uint at) { return float(map_sum[at + 1u]) * 4294967296.0 + float(map_sum[at]); }

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= map_size || texel.y >= map_size) return;
  uint at = uint(texel.y * map_size + texel.x) * 6u;
  vec3 flux = vec3(wide(at), wide(at + 2u), wide(at + 4u)) * lights[light].misc.y;
  imageStore(map, ivec3(texel, light), vec4(flux * lights[light].misc.w, 1));
}
