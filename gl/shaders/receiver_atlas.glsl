// Maps on receivers, for light that the light's own map cannot hold. TILES: some light has any. Tables
// are textures: a software rasteriser fetches from those what differs from lane to lane.
#include "counts.glsl"
#ifdef TILES
layout(binding = UNIT_TILE_ROWS) uniform samplerBuffer tile_rows;    // TILE_ROWS a tile, MOST_TILES a light
layout(binding = UNIT_TILE_INDEX) uniform isamplerBuffer tile_index;  // words_of(1) a light, of the three parts below
const int TILE_ROWS = 4;

int tiles_word() { return counts.tile_blocks * counts.tile_blocks + 1; }
int words_of(int lights) { return lights * (tiles_word() + counts.chart_sides); }

// Flag of a hit's path: it lies on a tile. Its place is then texels of the layer and the tile.
const uint ON_A_TILE = 0x40000000u;

int tile_row(int light, int tile) { return TILE_ROWS * (light * MOST_TILES + tile); }

// The layer of the map that the light's tiles share.
int atlas_layer(int light) { return texelFetch(tile_index, words_of(light)).x; }

// The tile of a block of the layer's texels, so many a side; -1: of none.
int tile_of_block(int light, ivec2 block) {
  return texelFetch(tile_index, words_of(light) + 1 + block.y * counts.tile_blocks + block.x).x;
}

// The tile of one side of a chart: 2 * chart, + 1 behind; -1: it has none.
int tile_of_side(int light, int chart_side) {
  return texelFetch(tile_index, words_of(light) + tiles_word() + chart_side).x;
}

// In the layer's texels: left, bottom, right, top.
vec4 tile_rect(int light, int tile) { return texelFetch(tile_rows, tile_row(light, tile) + 2); }

// The chart's normal; area of a texel across it, m2.
vec4 tile_across(int light, int tile) { return texelFetch(tile_rows, tile_row(light, tile) + 3); }

// In the layer's texels.
vec2 place_on_tile(int light, int tile, vec3 p) {
  vec4 to_x = texelFetch(tile_rows, tile_row(light, tile));
  vec4 to_y = texelFetch(tile_rows, tile_row(light, tile) + 1);
  return vec2(dot(to_x.xyz, p) + to_x.w, dot(to_y.xyz, p) + to_y.w);
}

bool is_within(vec4 rect, vec2 at) {
  return all(greaterThanEqual(at, rect.xy)) && all(lessThan(at, rect.zw));
}
#endif
