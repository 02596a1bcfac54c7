// What pinholes change of the soft light on receivers: rgb irradiance, a tile for each side of each
// chart; PINHOLE_CHARTS: some are parts of meshes.
#include "pinhole_map.glsl"
uniform sampler2DArray pinhole_pages;
#ifndef ENVIRONMENT
uniform float environment_scale;
#endif

#ifdef PINHOLE_CHARTS
layout(binding = UNIT_CHART_ROWS) uniform samplerBuffer page_charts;  // two a chart: from a place to its u, and v

float chart_to_page(vec4 to_x, vec3 p) {
  float middle = dot(to_x.xyz, refractor_bounds.xyz) + to_x.w, wide = refractor_bounds.w * length(to_x.xyz);
  return to_page(vec2(middle, max(wide, 1e-4)), dot(to_x.xyz, p) + to_x.w);
}

vec3 pinhole_irradiance(vec3 p, vec3 n, int surface, int side) {
  vec4 to_u = texelFetch(page_charts, side >> 1 << 1), to_v = texelFetch(page_charts, side | 1);
  vec3 place = vec3(chart_to_page(to_u, p), chart_to_page(to_v, p), side);
  return environment_scale * textureLod(pinhole_pages, place, 0.0).rgb;
}
#else
// How far a place is from a parallelogram, in parts of its edges.
float off_receiver(Receiver r, vec3 p, out vec2 uv) {
  uv = receiver_uv(r, p);
  vec2 over = max(abs(uv - 0.5) - 0.5, vec2(0));
  return over.x + over.y + abs(dot(r.normal.xyz, p) - r.normal.w) * (length(r.du.xyz) + length(r.dv.xyz));
}

void nearer_page(int i, Receiver r, vec3 p, vec3 n, int surface, inout float least, inout vec3 place) {
  vec2 uv;
  float off = off_receiver(r, p, uv) + (int(r.anchor.w) == surface ? 0.0 : 1e20);
  vec2 at = vec2(to_page(page_axis(r.du, r.anchor.xyz), uv.x), to_page(page_axis(r.dv, r.anchor.xyz), uv.y));
  bool nearer = off < least;
  place = nearer ? vec3(at, 2 * i + (dot(n, r.normal.xyz) > 0.0 ? 0 : 1)) : place;
  least = nearer ? off : least;
}

vec3 pinhole_irradiance(vec3 p, vec3 n, int surface, int side) {
  vec3 place = vec3(0);
  float least = 1e30;
#define NEARER_PAGE(i) nearer_page(i, RECEIVER(i), p, n, surface, least, place);
  OF_RECEIVERS(NEARER_PAGE)
  return environment_scale * textureLod(pinhole_pages, place, 0.0).rgb;
}
#endif
