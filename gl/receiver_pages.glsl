// Maps on receivers, for light that the light's own map cannot hold. PAGES: some light has any.
#ifdef PAGES
struct Page {
  vec4 plane;   // the receiver's: dot(plane.xyz, p) = plane.w
  vec4 to_x, to_y;  // from a place to the layer's texels: dot(to_x.xyz, p) + to_x.w
  vec4 rect;    // the page's texels: left, bottom, right, top
  vec4 info;    // parallelogram, or -1: no page; layer; area of a texel, m2; half thickness, m
};
layout(std140, binding = 8) uniform Pages { Page pages[LIGHT_ROOM * MOST_PAGES]; };

// Of a landing's path: it lies on a page. Its place is then texels of the layer and the page.
const uint ON_A_PAGE = 0x40000000u;

vec2 texels_on(Page page, vec3 p) {
  return vec2(dot(page.to_x.xyz, p) + page.to_x.w, dot(page.to_y.xyz, p) + page.to_y.w);
}

bool is_within(vec4 rect, vec2 at) {
  return all(greaterThanEqual(at, rect.xy)) && all(lessThan(at, rect.zw));
}
#endif
