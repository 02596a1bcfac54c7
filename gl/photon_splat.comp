// Adds listed pieces to their level of the map, part by part and each bilinearly over four texels,
// which together get all of it, to the last unit.
layout(local_size_x = 256) in;
#include "splat_list.glsl"
#include "wide_sum.glsl"
#include "receiver_pages.glsl"
// Levels one after another, each texel X, Y, Z; WIDE: lo, hi of each. PAGES: then the same of their
// layer.
layout(std430, binding = 13) buffer MapSums { uint map_sum[]; };
uniform int light;
uniform int map_size;
uniform uint most;
uniform uint map_texels;  // of all levels

uint level_offset(int level) {
  // side^2 (1 + 1/4 + ...), level terms.
  uint texels = uint(map_size) * uint(map_size);
  return (texels - (texels >> (2 * level))) / 3u * 4u;
}

void add(uint texel, int channel, uint v) {
#ifdef WIDE
  uint at = texel * 6u + 2u * uint(channel);
  WIDE_ADD(map_sum, at, at + 1u, v)
#else
  atomicAdd(map_sum[texel * 3u + uint(channel)], v);
#endif
}

void main() {
  uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
         gl_LocalInvocationID.x;
  if (i >= min(splat_count, most)) return;
  uint word = i * SPLAT_WORDS, x_parts = splat[word], y_level = splat[word + 1u];
  vec2 across = unpackHalf2x16(splat[word + 2u]);
  uvec3 units = uvec3(splat[word + 3u], splat[word + 4u], splat[word + 5u]);
  vec2 to_x = unpackHalf2x16(splat[word + 6u]), to_z = unpackHalf2x16(splat[word + 7u]);
  int level = int(y_level & 7u), side = map_size >> level, parts = int(x_parts & 15u);
  float size = exp2(float(level));
  uint first = level_offset(level);
  vec2 low = vec2(0), high = vec2(float(map_size) - 0.01);
#ifdef PAGES
  vec2 centre = vec2(x_parts >> 4, y_level >> 10) * vec2(1.0 / 65536.0, 1.0 / 1024.0);
  uint page = y_level >> 3 & 127u;  // and one more; 0: the map
  vec4 rect = page_rect(light, max(int(page), 1) - 1);
  first += page > 0u ? map_texels : 0u;
  low = page > 0u ? rect.xy + 0.5 * size : low;
  high = page > 0u ? rect.zw - 0.5 * size : high;
#else
  vec2 centre = vec2(x_parts >> 4, y_level >> 3) * vec2(1.0 / 65536.0, 1.0 / 131072.0);
#endif
  for (int n = 0; n < parts; n++) {
    vec2 middle = centre + across * ((float(n) + 0.5) / float(parts) - 0.5);
    for (int c = 0; c < 3; c++) {
      vec2 p = middle + (c == 0 ? to_x : c == 1 ? vec2(0) : to_z);
#ifdef PAGES
      // What would lie beyond a page's edge, where the receiver ends, is folded back.
      p = page > 0u ? min(max(p, 2.0 * rect.xy - p), max(2.0 * rect.zw - p, rect.xy)) : p;
#endif
      vec2 at = clamp(p, low, high) / size - 0.5;
      ivec2 base = ivec2(floor(at));
      vec2 f = at - vec2(base);
      ivec2 lo = clamp(base, ivec2(0), ivec2(side - 1)), hi = clamp(base + 1, ivec2(0), ivec2(side - 1));
      uint row_lo = first + uint(lo.y * side), row_hi = first + uint(hi.y * side);
      float whole = float(units[c]);
      uint part_0 = min(uint(whole * ((1.0 - f.x) * (1.0 - f.y))), units[c]);
      uint part_1 = min(uint(whole * (f.x * (1.0 - f.y))), units[c] - part_0);
      uint part_2 = min(uint(whole * ((1.0 - f.x) * f.y)), units[c] - part_0 - part_1);
      add(row_lo + uint(lo.x), c, part_0);
      add(row_lo + uint(hi.x), c, part_1);
      add(row_hi + uint(lo.x), c, part_2);
      add(row_hi + uint(hi.x), c, units[c] - part_0 - part_1 - part_2);
    }
  }
}
