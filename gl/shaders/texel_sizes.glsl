// How wide the map's columns and how high its rows are, of all levels. Who includes this gives `light` and
// `map_size`.

// For a light: widths of columns, heights of rows, then of each 1
// (what it spreads over): 2 map_size each, a level after another.
layout(std430, binding = BINDING_TEXEL_SIZES) readonly buffer TexelSizes { float texel_size[]; };

int size_row(int axis, int level) {
  return 2 * (4 * light + axis) * map_size + 2 * (map_size - (map_size >> level));
}

float size_of(int axis, int level, int i) { return texel_size[size_row(axis, level) + i]; }

// By the bilinear weights of two levels, of the sizes of the finer texels that texel i lights.
float per_spread(int axis, int level, int i) { return texel_size[size_row(axis + 2, level) + i]; }
