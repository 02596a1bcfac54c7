// Fixed-point sums to XYZ flux over window area: one level of the map, with what the coarser levels hold laid
// over it. On those it is flux over the area that a texel lights through the bilinear filter, of finer texels
// by their own areas: which keeps the sum, and shows no texel to be narrower than the next. A layer of tiles
// comes to irradiance, each tile by itself.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
#include "common.glsl"
#include "receiver_atlas.glsl"
layout(std430, binding = BINDING_MAP_SUMS) readonly buffer MapSums { uint map_sum[]; };
uniform sampler2DArray coarser_map;  // the same texture: its next level is done
layout(rgba32f, binding = 0) writeonly uniform image2DArray map;  // this level
#include "light_number.glsl"
uniform int layer;  // LIGHTS or more: of the light's tiles
uniform uint map_texels;
uniform int map_size;
uniform int level;
uniform int levels;
#include "texel_sizes.glsl"

#ifdef WIDE
float wide(uint at) { return float(map_sum[at + 1u]) * 4294967296.0 + float(map_sum[at]); }

vec3 units_at(uint texel) {
  return vec3(wide(texel * 6u), wide(texel * 6u + 2u), wide(texel * 6u + 4u));
}
#else
vec3 units_at(uint texel) {
  return vec3(map_sum[texel * 3u], map_sum[texel * 3u + 1u], map_sum[texel * 3u + 2u]);
}
#endif

uint level_offset(int l) {
  // side^2 (1 + 1/4 + ...), l terms.
  uint texels = uint(map_size) * uint(map_size);
  return (texels - (texels >> (2 * l))) / 3u * 4u;
}

#ifdef TILES
void resolve_tile(ivec2 texel, vec3 flux) {
  int tile = tile_of_block(light, (texel << level) / (map_size / counts.tile_blocks));
  vec4 rect = tile_rect(light, max(tile, 0)) * exp2(-float(level));
  // At its edges a tile's coarser texels have no neighbours but themselves.
  vec2 at = clamp(0.5 * (vec2(texel) + 0.5), 0.5 * rect.xy + 0.5, 0.5 * rect.zw - 0.5);
  if (level + 1 < levels)
    flux += 0.25 * textureLod(coarser_map, vec3(at / float(map_size >> (level + 1)), layer),
                              float(level + 1)).xyz;
  if (level == 0) flux /= tile_across(light, max(tile, 0)).w;
  imageStore(map, ivec3(texel, layer), tile < 0 ? vec4(0) : vec4(flux, 1));
}
#endif

void main() {
  ivec2 texel = ivec2(texel_number());
  int side = map_size >> level;
  if (texel.x >= side || texel.y >= side) return;
  uint at = level_offset(level) + uint(texel.y * side + texel.x);
#ifdef TILES
  if (layer >= LIGHTS) {
    resolve_tile(texel, units_at(map_texels + at) * lights[light].misc.y);
    return;
  }
#endif
  vec3 flux = units_at(at) * lights[light].misc.y;
  float area = size_of(0, level, texel.x) * size_of(1, level, texel.y);
  vec2 uv = (vec2(texel) + 0.5) / float(side);
  vec3 above =
      level + 1 < levels ? textureLod(coarser_map, vec3(uv, light), float(level + 1)).xyz : vec3(0);
  float per_area = level > 0 ? per_spread(0, level, texel.x) * per_spread(1, level, texel.y) : 1.0 / area;
  imageStore(map, ivec3(texel, light), vec4((flux + area * above) * per_area, 1));
}
