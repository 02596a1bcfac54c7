// One coarser picture of a finished map, for cameras that see many texels at once: the flux of four over
// their window area; where texels are alike, as those of a tile are, their mean.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
uniform sampler2DArray map_levels;
layout(rgba32f, binding = 0) writeonly uniform image2DArray map;  // this level
uniform int light;
uniform int layer;  // another than the light's: of its tiles
uniform int map_size;
uniform int level;
#include "texel_sizes.glsl"

void main() {
  ivec2 texel = ivec2(texel_number());
  if (max(texel.x, texel.y) >= map_size >> level) return;
  vec4 sum = vec4(0);
  float area = 0.0;
  for (int k = 0; k < 4; k++) {
    ivec2 from = 2 * texel + ivec2(k & 1, k >> 1);
    float part = layer == light ? size_of(0, level - 1, from.x) * size_of(1, level - 1, from.y) : 1.0;
    sum += part * texelFetch(map_levels, ivec3(from, layer), level - 1);
    area += part;
  }
  imageStore(map, ivec3(texel, layer), sum / area);
}
