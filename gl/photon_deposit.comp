// From landings to flux in the spectral map. Between two neighbouring wavelengths that take the
// same way the light is laid along the line that joins their landings, each piece with the colour
// of its own part of the band; where the ways differ each keeps its half of the band to itself.
// A piece is spread by a tent as wide as the distance to the neighbouring photons' landings, with
// weights that add up to one: nothing is invented, nothing lost.
layout(local_size_x = 64) in;
#include "common.glsl"
#include "photon_list.glsl"
#include "wide_sum.glsl"

layout(std430, binding = 8) readonly buffer Slots { uint slot[]; };
layout(std430, binding = 9) readonly buffer Landings { vec4 landing[]; };
layout(std430, binding = 10) readonly buffer Signatures { uint signature[]; };
layout(std430, binding = 13) buffer MapSums { uint map_sum[]; };  // X lo, hi, Y lo, hi, Z lo, hi
// Interval i lies between nodes i - 1 and i. [(light * REFRACTORS + refractor) * (WAVELENGTHS + 1)
// + i] * (STEPS + 1) + k: XYZ of the interval up to step k, and how far along (0 to 1) that is.
layout(std430, binding = 14) readonly buffer Intervals { vec4 interval_sum[]; };

uniform int light;
uniform int grid;
uniform int map_size;
uniform int lane_first;
uniform int lane_count;
uniform int interval_first;

const float MAX_SPREAD = 12.0;  // texels

vec2 map_position(vec3 p) {
  vec3 uvz;
  project(lights[light].map_view, p, uvz);
  return uvz.xy * float(map_size);
}

void add(ivec2 texel, vec3 flux) {
  uvec3 v = uvec3(flux / lights[light].misc.y + 0.5);
  uint at = uint(texel.y * map_size + texel.x) * 6u;
  WIDE_ADD(map_sum, at, at + 1u, v.x)
  WIDE_ADD(map_sum, at + 2u, at + 3u, v.y)
  WIDE_ADD(map_sum, at + 4u, at + 5u, v.z)
}

float tent_sum(float c, float h) {
  float sum = 0.0;
  for (float x = ceil(c - 0.5 - h); x <= c - 0.5 + h; x += 1.0)
    sum += max(1.0 - abs(x + 0.5 - c) / h, 0.0);
  return sum;
}

void splat(vec2 c, vec2 h, vec3 flux) {
  vec2 norm = 1.0 / vec2(tent_sum(c.x, h.x), tent_sum(c.y, h.y));
  for (float y = ceil(c.y - 0.5 - h.y); y <= c.y - 0.5 + h.y; y += 1.0) {
    float wy = max(1.0 - abs(y + 0.5 - c.y) / h.y, 0.0) * norm.y;
    for (float x = ceil(c.x - 0.5 - h.x); x <= c.x - 0.5 + h.x; x += 1.0) {
      float w = max(1.0 - abs(x + 0.5 - c.x) / h.x, 0.0) * norm.x * wy;
      if (w > 0.0) add(clamp(ivec2(x, y), ivec2(0), ivec2(map_size - 1)), w * flux);
    }
  }
}

uint index_of(uint photon, int order, int i) {
  return (photon * ORDERS + order) * LANES + (i - lane_first);
}

// Landing of the neighbouring photon on the same path, as a step in texels; zero if none.
vec2 neighbour_step(ivec2 cell, ivec2 offset, int order, int i, uint path, vec2 here) {
  ivec2 c = cell + offset;
  if (any(lessThan(c, ivec2(0))) || any(greaterThanEqual(c, ivec2(grid)))) return vec2(0);
  uint at = slot[c.y * grid + c.x];
  if (at == 0u) return vec2(0);
  uint index = index_of(at - 1u, order, i);
  if (landing[index].w <= 0.0 || signature[index] != path) return vec2(0);
  return abs(map_position(landing[index].xyz) - here);
}

vec2 spread(ivec2 cell, int order, int i, uint path, vec2 here) {
  vec2 a = neighbour_step(cell, ivec2(1, 0), order, i, path, here);
  if (a == vec2(0)) a = neighbour_step(cell, ivec2(-1, 0), order, i, path, here);
  vec2 b = neighbour_step(cell, ivec2(0, 1), order, i, path, here);
  if (b == vec2(0)) b = neighbour_step(cell, ivec2(0, -1), order, i, path, here);
  return clamp(max(a, b), vec2(1), vec2(MAX_SPREAD));
}

// The refractor's own table: how far along the line a wavelength falls depends on its dispersion.
vec4 step_sum(uint path, int interval, int k) {
  int refractor = int(path & 255u);
  int row = (light * REFRACTORS + refractor) * (WAVELENGTHS + 1) + interval;
  return interval_sum[row * (STEPS + 1) + k];
}

void main() {
  uint photon = gl_GlobalInvocationID.x;
  int row = int(gl_GlobalInvocationID.y);
  if (photon >= photon_count) return;
  int order = row % ORDERS, interval = interval_first + row / ORDERS;
  int a = interval - 1, b = interval;
  vec4 from = vec4(0), to = vec4(0);
  uint path_a = 0u, path_b = 1u;
  if (a >= 0) {
    from = landing[index_of(photon, order, a)];
    path_a = signature[index_of(photon, order, a)];
  }
  if (b < WAVELENGTHS) {
    to = landing[index_of(photon, order, b)];
    path_b = signature[index_of(photon, order, b)];
  }
  if (from.w <= 0.0 && to.w <= 0.0) return;
  ivec2 cell = ivec2(photon_cell[photon] & 0xffffu, photon_cell[photon] >> 16);
  vec2 pa = map_position(from.xyz), pb = map_position(to.xyz);
  uint path = from.w > 0.0 ? path_a : path_b;
  vec3 middle = step_sum(path, interval, STEPS / 2).xyz, all = step_sum(path, interval, STEPS).xyz;
  bool bridge = false;
#ifdef BRIDGE
  float way = max(abs(pb.x - pa.x), abs(pb.y - pa.y));
  bridge = from.w > 0.0 && to.w > 0.0 && path_a == path_b && way < MAX_BRIDGE;
#endif
  if (!bridge) {
    if (from.w > 0.0 && middle != vec3(0))
      splat(pa, spread(cell, order, a, path_a, pa), from.w * middle);
    if (to.w > 0.0 && all != middle)
      splat(pb, spread(cell, order, b, path_b, pb), to.w * (all - middle));
    return;
  }
#ifdef BRIDGE
  vec2 h = spread(cell, order, a, path_a, pa);
  if (way < 1.0) {
    splat(mix(pa, pb, step_sum(path, interval, STEPS / 2).w), h,
          from.w * middle + to.w * (all - middle));
    return;
  }
  int pieces = 2;
  while (pieces < STEPS && float(pieces) < way) pieces *= 2;
  h = max(h, abs(pb - pa) / float(pieces));
  vec4 before = vec4(0);
  for (int k = 1; k <= pieces; k++) {
    vec4 upto = step_sum(path, interval, k * STEPS / pieces);
    float share = 2 * k <= pieces ? from.w : to.w;
    splat(mix(pa, pb, 0.5 * (before.w + upto.w)), h, share * (upto.xyz - before.xyz));
    before = upto;
  }
#endif
}
