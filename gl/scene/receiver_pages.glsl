// Maps on receivers, for light that the light's own map cannot hold. PAGES: some light has any. Tables
// are textures: a software rasteriser fetches from those what differs from lane to lane.
#ifdef PAGES
layout(binding = UNIT_PAGE_ROWS) uniform samplerBuffer page_rows;    // PAGE_ROWS a page, MOST_PAGES a light
layout(binding = UNIT_PAGE_INDEX) uniform isamplerBuffer page_index;  // PAGE_WORDS a light, of the three parts below
const int PAGE_ROWS = 4;
const int PAGE_WORDS = 1 + PAGE_BLOCKS * PAGE_BLOCKS + CHART_SIDES;

// Of a landing's path: it lies on a page. Its place is then texels of the layer and the page.
const uint ON_A_PAGE = 0x40000000u;

int page_row(int light, int page) { return PAGE_ROWS * (light * MOST_PAGES + page); }

// The layer of the map that the light's pages share.
int page_layer(int light) { return texelFetch(page_index, light * PAGE_WORDS).x; }

// The page of a block of the layer's texels, PAGE_BLOCKS a side; -1: of none.
int page_of_block(int light, ivec2 block) {
  return texelFetch(page_index, light * PAGE_WORDS + 1 + block.y * PAGE_BLOCKS + block.x).x;
}

// The page of one side of a chart: 2 * chart, + 1 behind; -1: it has none.
int page_of_side(int light, int chart_side) {
  return texelFetch(page_index, light * PAGE_WORDS + 1 + PAGE_BLOCKS * PAGE_BLOCKS + chart_side).x;
}

// In the layer's texels: left, bottom, right, top.
vec4 page_rect(int light, int page) { return texelFetch(page_rows, page_row(light, page) + 2); }

// The chart's normal; area of a texel across it, m2.
vec4 page_across(int light, int page) { return texelFetch(page_rows, page_row(light, page) + 3); }

// In the layer's texels.
vec2 place_on_page(int light, int page, vec3 p) {
  vec4 to_x = texelFetch(page_rows, page_row(light, page));
  vec4 to_y = texelFetch(page_rows, page_row(light, page) + 1);
  return vec2(dot(to_x.xyz, p) + to_x.w, dot(to_y.xyz, p) + to_y.w);
}

bool is_within(vec4 rect, vec2 at) {
  return all(greaterThanEqual(at, rect.xy)) && all(lessThan(at, rect.zw));
}
#endif
