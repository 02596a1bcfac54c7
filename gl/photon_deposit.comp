// From landings to pieces of light for the spectral map. Between two neighbouring wavelengths that
// take the same way the light is laid along the line that joins their landings, each piece with
// the colour of its own part of the band; where the ways differ each keeps its half of the band to
// itself. Pieces that fall closer together than the photons do are added first; X, Y and Z have each a
// place of their own, or dispersion narrower than that would be lost. A piece is spread
// over the parallelogram that the neighbouring photons' landings span: where that is wide, in a
// coarser level of the map. REFINED: the intervals on the list, by all their wavelengths; else those
// of the coarse set that are not on it. No branch saves time on a software rasteriser, so there are few.
layout(local_size_x = 256) in;
#include "common.glsl"
#include "photon_nodes.glsl"
#include "splat_list.glsl"

struct Photon {  // as in photon_start.glsl
  uint cell;
  float flux;
  uint offset, extent;
};
layout(std430, binding = 6) readonly buffer Photons {
  uint photon_count, groups_x, groups_y, groups_z;
  uint draw[4];
  Photon photon_at[];
};
layout(std430, binding = 8) readonly buffer Slots { uint slot[]; };
// As textures: a software rasteriser fetches a texel in one load, and storage number by number.
uniform samplerBuffer landings;
uniform usamplerBuffer signatures;  // 0: none; TINTING: and the length of the way inside
layout(std430, binding = 13) readonly buffer PathList {
  uint path_count, path_groups[3];
  uint path_list[];
};
#ifdef REFINED
layout(std430, binding = 7) readonly buffer PairList {
  uint pair_count, pair_groups[3];
  uint pair_at[];
};
uniform samplerBuffer fine_landings;
uniform usamplerBuffer fine_signatures;
#else
layout(std430, binding = 7) readonly buffer Wants { uint want[]; };  // a bit a refined interval
#endif
// Interval i lies between nodes i - 1 and i. [table_first + (light * REFRACTORS + refractor) *
// (nodes + 1) + i] * (STEPS + 1) + k, two each: XYZ of the interval up to step k, and how far along (0
// to 1) that is; then those three times how far along their light is.
uniform samplerBuffer interval_sums;
#ifdef TINTING
// As in photon_absorption.glsl; band_first: where the set of these landings begins.
uniform samplerBuffer band_attenuation;
uniform int band_first;
#endif

uniform int light;
uniform ivec2 grid;
uniform int map_size;
uniform int lane_first;
uniform int lane_count;
uniform int interval_first;
uniform int interval_end;
uniform int nodes;  // of the set whose landings these are
uniform int table_first;
uniform uint chunks, chunk;  // only paths of this chunk
uniform uint most;           // pieces that the list has room for

#ifdef REFINED
#define NODE_LANDINGS fine_landings
#define NODE_SIGNATURES fine_signatures
#define NODES_HERE (node_end + 1)
#else
#define NODE_LANDINGS landings
#define NODE_SIGNATURES signatures
#define NODES_HERE (lane_first + lane_count)
#endif

const int MAX_PIECES = 12;  // of one footprint

#include "landing_place.glsl"

// From a landing to that of the neighbouring photon on the same path, in texels, as far as if the
// two started a cell apart; zero if there is none.
vec2 neighbour_step(ivec2 c, ivec2 to, vec2 start, int order, int lane, uint path, vec2 here) {
  c += to;
  bool there = all(greaterThanEqual(c, ivec2(0))) && all(lessThan(c, grid));
  uint at = slot[there ? c.y * grid.x + c.x : 0];
  there = there && at != 0u;
  uint other = there ? at - 1u : 0u;
  uint index = (other * SLOTS + order) * LANES + lane;
  there = there && path != 0u && texelFetch(signatures, int(index)).x == path;
  vec2 way = vec2(to) + unpackSnorm2x16(photon_at[other].offset) - start;
  float apart = max(dot(way, vec2(to)), 0.25);
  return there ? (map_position(texelFetch(landings, int(index)).xyz, path) - here) / apart : vec2(0);
}

const int NO_PAGE = -1;

int page_of(vec4 landed, uint path) {
#ifdef PAGES
  if ((path & ON_A_PAGE) != 0u) return int(landed.z);
#endif
  return NO_PAGE;
}

// The first two words of a piece (splat_list.glsl).
uvec2 packed_place(vec2 at, int page, int parts, int level) {
#ifdef PAGES
  vec4 rect = page == NO_PAGE ? vec4(0, 0, vec2(map_size)) : page_rect(light, max(page, 0));
  at = clamp(at, rect.xy, rect.zw - 0.01);
  return uvec2(uint(at.x * 65536.0) << 4 | uint(parts),
               uint(at.y * 1024.0) << 10 | uint(page + 1) << 3 | uint(level));
#else
  uvec2 fixed_point = uvec2(clamp(at, vec2(0), vec2(float(map_size) - 0.01)) * vec2(65536.0, 131072.0));
  return uvec2(fixed_point.x << 4 | uint(parts), fixed_point.y << 3 | uint(level));
#endif
}

// A cell's image along one axis, from the steps to both neighbours: their mean where both are.
vec2 image_of_side(vec2 to_next, vec2 to_last) {
  if (to_next == vec2(0)) return -to_last;
  return to_last == vec2(0) ? to_next : 0.5 * (to_next - to_last);
}

#ifdef TINTING
// Parts of a half of a band are laid as one where what is left of them differs by less.
const float EVEN = 0.05;

float spread(vec4 v) {
  return max(max(v.x, v.y), max(v.z, v.w)) - min(min(v.x, v.y), min(v.z, v.w));
}

float part_of(vec4 v, int k) {
  vec2 two = k < 2 ? v.xy : v.zw;
  return (k & 1) == 0 ? two.x : two.y;
}
#endif

void main() {
  uint listed = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
         gl_LocalInvocationID.x;
  if (listed >= path_count) return;
  uint photon_path = path_list[listed];
  int order = int(photon_path % SLOTS);
#ifdef REFINED
  uint pair = pair_at[photon_path / SLOTS];
  uint photon = pair / PAIR_INTERVALS, coarse_interval = pair % PAIR_INTERVALS;
  int node_a = coarse_node(int(coarse_interval)), node_end = coarse_node(int(coarse_interval) + 1);
  int turns = FINE_NODES - 1, twice_middle = 2 * int(coarse_interval) + 1;
  uint fine_first = photon_path * FINE_NODES;
#else
  uint photon = photon_path / SLOTS;
  int node_a = interval_first - 1;
  int turns = interval_end - interval_first, twice_middle = lane_count;
  uint refined = want[photon] << 1;
#endif
  uint first = (photon * SLOTS + uint(order)) * LANES;
  Photon from_cell = photon_at[photon];
  uint packed_cell = from_cell.cell;
  if (packed_cell * 2654435761u % chunks != chunk) return;
  ivec2 cell = ivec2(packed_cell & 0xffffu, packed_cell >> 16);

  // The footprint, at the wavelength nearest the middle of those that land. (A loop that ended
  // early would do less, but Mesa 22's llvmpipe clobbers a load that is repeated after one.)
  int reference = 0;
  uint path = 0u;
  for (int i = 0; i < lane_count; i++) {
    uint found = texelFetch(signatures, int(first + i)).x;
    bool nearer = path == 0u || abs(2 * i - twice_middle) < abs(2 * reference - twice_middle);
    if (found != 0u && nearer) {
      path = found;
      reference = i;
    }
  }
  vec2 here = map_position(texelFetch(landings, int(first + reference)).xyz, path);
  vec2 start = unpackSnorm2x16(from_cell.offset), extent = unpackUnorm2x16(from_cell.extent);
  vec2 a = extent.x * image_of_side(neighbour_step(cell, ivec2(1, 0), start, order, reference, path, here),
                                    neighbour_step(cell, ivec2(-1, 0), start, order, reference, path, here));
  vec2 b = extent.y * image_of_side(neighbour_step(cell, ivec2(0, 1), start, order, reference, path, here),
                                    neighbour_step(cell, ivec2(0, -1), start, order, reference, path, here));
  // Principal axes of the cell's image: a fold makes it thin, whatever way the cell's sides point.
  float xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y;
  float half_trace = 0.5 * (xx + yy), root = length(vec2(0.5 * (xx - yy), xy));
  float wide = sqrt(half_trace + root), narrow = sqrt(max(half_trace - root, 0.0));
  vec2 axis = xx > yy ? vec2(0.5 * (xx - yy) + root, xy) : vec2(xy, 0.5 * (yy - xx) + root);
  vec2 across = wide * axis / max(length(axis), 1e-20);
  float least = max(max(narrow, wide / float(MAX_PIECES)), 0.5);
  int level = clamp(int(ceil(log2(least) + 0.4)), 0, MAP_LEVELS - 1);
  float size = exp2(float(level));
  int across_pieces = clamp(int(ceil(wide / size)), 1, MAX_PIECES);
  // A tear between neighbours is not a footprint: no farther than the pieces can cover.
  across *= min(1.0, 2.0 * size * float(MAX_PIECES) / max(wide, 1e-20));

  uint packed_across = packHalf2x16(across);
  vec3 gathered = vec3(0);
  vec2 gathered_from = vec2(0);
  vec3 gathered_x = vec3(0), gathered_y = vec3(0);  // X, Y and Z times how far they lie from there
  float gathered_weight = 0.0;
  float to_units = 1.0 / (lights[light].misc.y * float(across_pieces));
  uint path_a = 0u;
  vec4 from = vec4(0);
#ifdef TINTING
  float way_a = 0.0;
#endif
#ifdef REFINED
  path_a = texelFetch(fine_signatures, int(fine_first)).x;
  from = texelFetch(fine_landings, int(fine_first));
#ifdef TINTING
  way_a = uintBitsToFloat(texelFetch(fine_signatures, int(fine_first)).y);
#endif
  for (int i = 0; i < FINE_NODES; i++) path = max(path, texelFetch(fine_signatures, int(fine_first + uint(i))).x);
#else
  if (interval_first > 0) {
    uint index_a = first + uint(interval_first - 1 - lane_first);
    path_a = texelFetch(signatures, int(index_a)).x;
#ifdef TINTING
    way_a = uintBitsToFloat(texelFetch(signatures, int(index_a)).y);
#endif
    from = texelFetch(landings, int(index_a));
  }
#endif
  int owner_row = light * REFRACTORS + int(path & 255u);
  int row = table_first + owner_row * (nodes + 1);
#ifdef TINTING
  int band_row = band_first + owner_row * nodes;
#endif
  vec2 pa = path_a != 0u ? map_position(from.xyz, path_a) : here;
  int page_a = page_of(from, path_a), gathered_page = NO_PAGE;
#ifdef DOUBTS_BRIDGES
  vec2 way_before = vec2(0);
#endif
  for (int turn = 0; turn <= turns; turn++) {
    bool last = turn == turns;  // one more turn, to write what is gathered
    int interval = node_a + 1 + turn;
#ifdef REFINED
    bool has_b = interval <= node_end && !last, taken = has_b;
    uint index_b = fine_first + uint(has_b ? turn + 1 : 0);
    uint path_b = has_b ? texelFetch(fine_signatures, int(index_b)).x : 0u;
    vec4 to = texelFetch(fine_landings, int(index_b));
#else
    bool has_b = interval < nodes && !last, taken = (refined >> uint(min(interval, 31)) & 1u) == 0u;
    uint index_b = first + uint(has_b ? interval - lane_first : 0);
    uint path_b = has_b ? texelFetch(signatures, int(index_b)).x : 0u;
    vec4 to = texelFetch(landings, int(index_b));
#endif
    vec2 pb = path_b != 0u ? map_position(to.xyz, path_b) : pa;
    int page_b = page_of(to, path_b);
    float share_a = path_a != 0u && taken ? from.w : 0.0, share_b = path_b != 0u && taken ? to.w : 0.0;
#ifdef TINTING
    // What is left of the interval's light in eight parts, four to each node, after their ways inside.
    float way_b = has_b ? uintBitsToFloat(texelFetch(NODE_SIGNATURES, int(index_b)).y) : 0.0;
    int half_a = 4 * (band_row + max(interval - 1, 0)) + 2, half_b = 4 * (band_row + min(interval, nodes - 1));
    vec4 left_a = exp(-way_a * texelFetch(band_attenuation, half_a));
    vec4 left_b = exp(-way_b * texelFetch(band_attenuation, half_b));
    bool even = (share_a == 0.0 || spread(left_a) < EVEN) && (share_b == 0.0 || spread(left_b) < EVEN);
    left_a = even ? vec4(dot(left_a, texelFetch(band_attenuation, half_a + 1))) : left_a;
    left_b = even ? vec4(dot(left_b, texelFetch(band_attenuation, half_b + 1))) : left_b;
    int least = even ? 1 : 8;
#else
    const int least = 1;
#endif
    bool bridge = false;
    // Halves whose landings fall together are one piece.
    bool apart = pa != pb || page_a != page_b;
    int pieces = share_a > 0.0 && share_b > 0.0 && apart ? 2 : 1;
    pieces = max(pieces, least);
#ifdef BRIDGE
    float way = max(abs(pb.x - pa.x), abs(pb.y - pa.y));
    bool one_path = path_a != 0u && path_a == path_b;
#ifdef DOUBTS_BRIDGES
    // Paths through a mesh may be alike and yet part: a long way is a spectrum's where the light
    // moves on likewise in the interval before or after it.
    bool has_c = has_b && interval + 1 < NODES_HERE;
    uint path_c = has_c ? texelFetch(NODE_SIGNATURES, int(index_b) + 1).x : 0u;
    vec4 beyond = texelFetch(NODE_LANDINGS, int(index_b) + (has_c ? 1 : 0));
    vec2 pc = path_c != 0u ? map_position(beyond.xyz, path_c) : pb;
    vec2 on = pb - pa, after = path_c == path_b ? pc - pb : vec2(0);
    bool likewise = min(distance(on, way_before), distance(on, after)) < 0.75 * length(on);
    way_before = one_path ? on : vec2(0);
    bridge = taken && one_path && (way < float(map_size) / 16.0 || likewise);
#else
    bridge = taken && one_path;
#endif
    if (bridge) pieces = least;
    while (bridge && pieces < STEPS && float(pieces) * size < way) pieces *= 2;
#endif
    pieces = last ? 1 : pieces;
    int intervals_row = (row + min(interval, nodes)) * (STEPS + 1);
    vec3 middle = texelFetch(interval_sums, 2 * (intervals_row + STEPS / 2)).xyz;
    vec4 before = vec4(0);
    vec3 moment_before = vec3(0);
    for (int k = 1; k <= pieces; k++) {
      int upto_at = 2 * (intervals_row + k * STEPS / pieces);
      vec4 upto = texelFetch(interval_sums, upto_at);
      vec3 moment = texelFetch(interval_sums, upto_at + 1).xyz;
      vec3 lower = min(upto.xyz, middle) - min(before.xyz, middle);
#ifdef TINTING
      int part = (k - 1) * 8 / pieces;
      vec3 upper = upto.xyz - before.xyz - lower;
      vec3 flux = share_a * part_of(left_a, min(part, 3)) * lower + share_b * part_of(left_b, max(part - 4, 0)) * upper;
#else
      vec3 flux = share_a * lower + share_b * (upto.xyz - before.xyz - lower);
#endif
      float half_along = 0.5 * (before.w + upto.w);
      float half_way = share_b > 0.0 ? share_a > 0.0 ? (2 * k <= pieces ? 0.0 : 1.0) : 1.0 : 0.0;
      // What does not land has no place: no share of it may come into the sum.
      vec2 at = bridge ? pa + half_along * (pb - pa) : half_way > 0.0 ? pb : pa;
      int page = half_way > 0.0 ? page_b : page_a;
      // Along the bridge X, Y and Z lie each where its own light is.
      vec3 part_xyz = upto.xyz - before.xyz, part_moment = moment - moment_before;
      vec3 along = clamp(part_moment / max(part_xyz, vec3(1e-20)), min(before.w, upto.w), max(before.w, upto.w));
      before = upto;
      moment_before = moment;
      float weight = last ? 0.0 : flux.x + flux.y + flux.z;
      vec2 off = abs(at - gathered_from);
      bool elsewhere = max(off.x, off.y) > 0.75 * size || page != gathered_page;
      bool write = gathered_weight > 0.0 && (last || (weight > 0.0 && elsewhere));
      if (write) {
        vec3 x = gathered_x / max(gathered, vec3(1e-30)), y = gathered_y / max(gathered, vec3(1e-30));
        uvec2 place = packed_place(gathered_from + vec2(x.y, y.y), gathered_page, across_pieces, level);
        uvec3 units = uvec3(gathered * to_units + 0.5);
        uint word = min(atomicAdd(splat_count, 1u), most) * SPLAT_WORDS;
        splat[word] = place.x;
        splat[word + 1u] = place.y;
        splat[word + 2u] = packed_across;
        splat[word + 3u] = units.x;
        splat[word + 4u] = units.y;
        splat[word + 5u] = units.z;
        splat[word + 6u] = packHalf2x16(vec2(x.x - x.y, y.x - y.y));
        splat[word + 7u] = packHalf2x16(vec2(x.z - x.y, y.z - y.y));
      }
      if (write) {
        gathered = vec3(0);
        gathered_x = vec3(0);
        gathered_y = vec3(0);
        gathered_weight = 0.0;
      }
      if (weight > 0.0) {
        if (gathered_weight == 0.0) {
          gathered_from = at;
          gathered_page = page;
        }
        vec2 off_here = at - gathered_from, way_here = bridge ? pb - pa : vec2(0);
        gathered += flux;
        gathered_x += flux * (off_here.x + (along - half_along) * way_here.x);
        gathered_y += flux * (off_here.y + (along - half_along) * way_here.y);
        gathered_weight += weight;
      }
    }
    path_a = path_b;
    from = to;
#ifdef TINTING
    way_a = way_b;
#endif
    pa = pb;
    page_a = page_b;
  }
}
