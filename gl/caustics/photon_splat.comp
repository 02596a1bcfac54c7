// Adds listed pieces to their level of the map, part by part and each over four texels, which together get
// all of it, to the last unit. Y goes by what a box of the part's extent covers of them, so that parts
// which lie side by side make an even light, whatever their distance; X and Z beside it by how far they lie
// from it, however little.
layout(local_size_x = 256) in;
#include "splat_list.glsl"
#include "wide_sum.glsl"
#include "receiver_pages.glsl"
// Levels one after another, each texel X, Y, Z; WIDE: lo, hi of each. PAGES: then the same of their
// layer.
layout(std430, binding = BINDING_MAP_SUMS) buffer MapSums { uint map_sum[]; };
uniform int light;
uniform int map_size;
uniform uint most;
uniform uint map_texels;  // of all levels

uint level_offset(int level) {
  // side^2 (1 + 1/4 + ...), level terms.
  uint texels = uint(map_size) * uint(map_size);
  return (texels - (texels >> (2 * level))) / 3u * 4u;
}

const float LEAST_EXTENT = 0.25;  // of a texel
const int MOST_ACROSS = 15, MOST_ALONG = 15;

void add(uint texel, int channel, uint v) {
#ifdef WIDE
  uint at = texel * 6u + 2u * uint(channel);
  WIDE_ADD(map_sum, at, at + 1u, v)
#else
  if (v > 0u) atomicAdd(map_sum[texel * 3u + uint(channel)], v);
#endif
}

// Of a piece in one level.
struct Grid {
  int level, across, along;
  float size;
};

Grid grid_of(int level, float wide, float way) {
  Grid g;
  g.level = level;
  g.size = exp2(float(level));
  g.across = clamp(int(ceil(wide / g.size)), 1, MOST_ACROSS);
  g.along = clamp(int(ceil(way / g.size - 0.25)), 1, MOST_ALONG);
  return g;
}

void main() {
  uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
         gl_LocalInvocationID.x;
  if (i >= min(splat_count, most)) return;
  uint word = i * SPLAT_WORDS, y_level = splat[word + 1u];
  uvec3 units = uvec3(splat[word + 3u], splat[word + 4u], splat[word + 5u]), given = uvec3(0);
  vec2 across = unpackHalf2x16(splat[word + 2u]), way = unpackHalf2x16(splat[word + 9u]);
  vec2 skew = unpackHalf2x16(splat[word + 10u]), rest = unpackHalf2x16(splat[word + 11u]);
  vec2 to_x = unpackHalf2x16(splat[word + 6u]), to_y = unpackHalf2x16(splat[word + 7u]);
  vec2 to_z = unpackHalf2x16(splat[word + 8u]);
  float next_share = rest.y;
  int level = int(y_level & 7u);
  vec2 centre = vec2(splat[word] >> 5, y_level >> 5) / 32768.0, whole_high = vec2(float(map_size) - 0.01);
#ifdef PAGES
  uint page = (splat[word] & 31u) << 2 | y_level >> 3 & 3u;  // and one more; 0: the map
  vec4 rect = page_rect(light, max(int(page), 1) - 1);
  uint layer_first = page > 0u ? map_texels : 0u;
#else
  const uint layer_first = 0u;
#endif
  float wide = length(across) + length(skew), way_length = max(abs(way.x), abs(way.y));
  vec2 aside = rest.x * abs(across.yx) / max(length(across), 1e-20);
  Grid fine = grid_of(level, wide, way_length), next = grid_of(level + 1, wide, way_length);
  int fine_count = fine.across * fine.along;
  int count = fine_count + (next_share > 0.0 ? next.across * next.along : 0);
  // Along the way X, Y and Z grow or fall evenly, as their means tell.
  vec3 slope = clamp(vec3(dot(to_x, way), dot(to_y, way), dot(to_z, way)) / max(dot(way, way), 1e-20),
                     -1.0 / 6.0, 1.0 / 6.0);
  for (int n = 0; n < count; n++) {
    bool coarse = n >= fine_count;
    Grid g = fine;
    if (coarse) g = next;
    int k = n - (coarse ? fine_count : 0);
    float row = floor((float(k) + 0.5) / float(g.across)), column = float(k) - row * float(g.across);
    float at_part = (column + 0.5) / float(g.across) - 0.5, per_row = 1.0 / float(g.along);
    vec2 middle = centre + across * at_part + skew * abs(at_part) + way * ((row + 0.5) * per_row - 0.5);
    vec2 part = (across + sign(at_part) * skew) / float(g.across);
    vec2 extent = clamp((aside + abs(part) + abs(way) * per_row) / g.size, LEAST_EXTENT, 1.0);
    // So much of each has been given when this part is.
    float t = row * per_row;
    vec3 upto = t + 6.0 * slope * t * (t - 1.0);
    upto += (column + 1.0) / float(g.across) * per_row * (1.0 + 6.0 * slope * (2.0 * t + per_row - 1.0));
    if (g.along == 1) upto = vec3((column + 1.0) / float(g.across));
    upto = coarse ? 1.0 - next_share * (1.0 - upto) : (1.0 - next_share) * upto;
    uvec3 upto_units = n + 1 == count ? units : clamp(uvec3(vec3(units) * upto), given, units);
    uvec3 here = upto_units - given;
    given = upto_units;
    uint first = level_offset(g.level) + layer_first;
    int side = map_size >> g.level;
    vec2 low = vec2(0), high = whole_high;
#ifdef PAGES
    low = page > 0u ? rect.xy + 0.5 * g.size : low;
    high = page > 0u ? rect.zw - 0.5 * g.size : high;
#endif
    // Y's parts share among texels what they cover of them; X and Z lie beside it.
    vec2 off[3] = vec2[3](to_x, to_y, to_z);
    for (int c = 0; c < 3; c++) off[c] -= (1.0 - per_row * per_row) * slope[c] * way;
    middle += off[1];
    vec2 exact = middle / g.size - 0.5, whole_texels = floor(exact);
    middle = (whole_texels + clamp((exact - whole_texels - 0.5) / extent + 0.5, 0.0, 1.0) + 0.5) * g.size;
    for (int c = 0; c < 3; c++) {
      vec2 p = middle + (off[c] - off[1]);
#ifdef PAGES
      // What would lie beyond a page's edge, where the receiver ends, is folded back.
      p = page > 0u ? min(max(p, 2.0 * rect.xy - p), max(2.0 * rect.zw - p, rect.xy)) : p;
#endif
      vec2 at = clamp(p, low, high) / g.size - 0.5;
      ivec2 base = ivec2(floor(at));
      vec2 f = at - vec2(base);
      ivec2 lo = clamp(base, ivec2(0), ivec2(side - 1)), hi = clamp(base + 1, ivec2(0), ivec2(side - 1));
      uint row_lo = first + uint(lo.y * side), row_hi = first + uint(hi.y * side);
      float whole = float(here[c]);
      uint part_0 = min(uint(whole * ((1.0 - f.x) * (1.0 - f.y))), here[c]);
      uint part_1 = min(uint(whole * (f.x * (1.0 - f.y))), here[c] - part_0);
      uint part_2 = min(uint(whole * ((1.0 - f.x) * f.y)), here[c] - part_0 - part_1);
      add(row_lo + uint(lo.x), c, part_0);
      add(row_lo + uint(hi.x), c, part_1);
      add(row_hi + uint(lo.x), c, part_2);
      add(row_hi + uint(hi.x), c, here[c] - part_0 - part_1 - part_2);
    }
  }
}
