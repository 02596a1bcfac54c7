// A tile's texels, and those of them that are still to be filled.
// rgb; the next node of the tree that a texel takes, 0: it has not begun, DONE: none.
layout(rgba32f, binding = 0) uniform image2DArray pages;
const float DONE = -1.0;
uniform int page;
layout(std430, binding = BINDING_UNFINISHED) buffer Unfinished {
  uint unfinished_count, unfinished_groups[3];
  uint unfinished[];  // x | y << 16
};

#ifdef PINHOLE_CHARTS
// Texels of meshes' charts: place (w: 1, 0: there is none), normal.
uniform samplerBuffer page_places;

int chart_row(ivec2 at) {
  ivec2 size = imageSize(pages).xy;
  return 2 * (((page / 2 - RECEIVERS) * size.y + at.y) * size.x + at.x);
}

bool is_place(ivec2 at) { return page / 2 < RECEIVERS || texelFetch(page_places, chart_row(at)).w > 0.0; }
#else
bool is_place(ivec2 at) { return true; }
#endif
