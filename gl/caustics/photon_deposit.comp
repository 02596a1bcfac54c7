// From landings to pieces of light for the spectral map. Between two neighbouring wavelengths of one
// path the light is laid where the index between theirs sends it (exit_wall.glsl), each piece with the
// colour of its own part of the band. Where the paths differ each wavelength keeps its half of the band.
// Intervals go from long waves to short ones: in short waves the index changes fastest, and there two
// intervals before tell the curve. Pieces closer together than photons are added first; X, Y and Z have
// each a place of their own, or dispersion narrower than that would be lost. A piece is spread over the
// parallelogram that the neighbouring photons' landings span: where that is wide, in a coarser level of
// the map. REFINED: the intervals on the list, by all their wavelengths; else those of the coarse set
// that are not on it. No branch saves time on a software rasteriser, so there are few.
layout(local_size_x = 256) in;
#include "common.glsl"
#include "photon_nodes.glsl"
#include "splat_list.glsl"
#include "optics.glsl"
#include "wide_sum.glsl"
#define FOLLOWS_EXITS
#include "exit_wall.glsl"

struct Photon {  // as in photon_start.glsl
  uint cell;
  float flux;
  uint offset, extent;
};
layout(std430, binding = BINDING_PHOTONS) readonly buffer Photons {
  uint photon_count, groups_x, groups_y, groups_z;
  uint draw[4];
  Photon photon_at[];
};
layout(std430, binding = BINDING_PHOTON_OF_CELL) readonly buffer Slots { uint slot[]; };
// As textures: a software rasteriser fetches a texel in one load, and storage number by number.
uniform samplerBuffer landings;     // LANDING_TEXELS each
uniform usamplerBuffer signatures;  // 0: none; TINTING: and the length of the way inside
layout(std430, binding = BINDING_PATHS) readonly buffer PathList {
  uint path_count, path_groups[3];
  uint path_list[];
};
#ifdef REFINED
layout(std430, binding = BINDING_PAIRS) readonly buffer PairList {
  uint pair_count, pair_groups[3];
  uint pair_at[];
};
uniform samplerBuffer fine_landings;
uniform usamplerBuffer fine_signatures;
#else
layout(std430, binding = BINDING_WANTS) readonly buffer Wants { uint want[]; };  // a bit a refined interval
#endif
// Interval i lies between nodes i and i - 1. [table_first + (light * REFRACTORS + refractor) *
// (nodes + 1) + i] * (STEPS + 1) + k, INTERVAL_TEXELS each: XYZ of the interval from node i up to step
// k, and how far along (0 to 1) that is; then those three times how far along their light is, and the
// index there; TINTING: then X, Y and Z times their attenuation, 1/m.
uniform samplerBuffer interval_sums;
#ifdef TINTING
const int INTERVAL_TEXELS = 3;
#else
const int INTERVAL_TEXELS = 2;
#endif
// lo and hi of each, as in photon_path.glsl and behind them what is interpolated.
layout(std430, binding = BINDING_LEDGER) buffer Ledger { uint ledger[]; };
uniform float ledger_unit;  // W
shared uint more_sum[3], less_sum[3];
const uint ABSORBED = 2u, MISSED = 4u, INTERPOLATED = 5u;
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
#else
#define NODE_LANDINGS landings
#define NODE_SIGNATURES signatures
#endif

const int MAX_PIECES = 12;  // of one footprint
const float SEGMENT = 2.0;  // of a piece's way, at the most, in texels of its level

#include "landing_place.glsl"

// From a landing to that of the neighbouring photon on the same path, in texels, as far as if the
// two started a cell apart; zero if there is none.
vec2 neighbour_step(ivec2 c, ivec2 to, vec2 start, int order, int lane, uint path, int page, vec2 here) {
  c += to;
  bool there = all(greaterThanEqual(c, ivec2(0))) && all(lessThan(c, grid));
  uint at = slot[there ? c.y * grid.x + c.x : 0];
  there = there && at != 0u;
  uint other = there ? at - 1u : 0u;
  uint index = (other * SLOTS + order) * LANES + lane;
  there = there && path != 0u && texelFetch(signatures, int(index)).x == path;
  vec4 landed = texelFetch(landings, LANDING_TEXELS * int(index));
  vec2 way = vec2(to) + unpackSnorm2x16(photon_at[other].offset) - start;
  float apart = max(dot(way, vec2(to)), 0.25);
  return there ? (map_position(landed.xyz, page) - here) / apart : vec2(0);
}

const int NO_PAGE = -1;

// The first two words of a piece (splat_list.glsl).
uvec2 packed_place(vec2 at, int page, int level) {
  vec4 rect = vec4(0, 0, vec2(map_size));
#ifdef PAGES
  if (page != NO_PAGE) rect = page_rect(light, page);
#endif
  uvec2 place = uvec2(clamp(at, rect.xy, rect.zw - 0.01) * 32768.0) << 5;
  uint number = uint(page + 1);
  return uvec2(place.x | number >> 2, place.y | (number & 3u) << 3 | uint(level));
}

// A cell's image along one axis, from the steps to both neighbours: their mean where both are. skew: by
// how much more the half towards the next is, and the other less.
vec2 image_of_side(vec2 to_next, vec2 to_last, out vec2 skew) {
  skew = vec2(0);
  if (to_next == vec2(0)) return -to_last;
  if (to_last == vec2(0)) return to_next;
  skew = 0.5 * (to_next + to_last);
  return 0.5 * (to_next - to_last);
}

#ifdef TINTING
// A half of a band is laid in parts where the logarithm of what is left of it varies by more.
const float EVEN = 0.25;

bool is_even(vec4 taken, vec4 left) {
  float least = min(min(taken.x, taken.y), min(taken.z, taken.w));
  float most = max(max(taken.x, taken.y), max(taken.z, taken.w));
  return most - least < EVEN || max(max(left.x, left.y), max(left.z, left.w)) < 1e-4;
}
#endif

// Where a photon's light is spread, in texels: along its longer axis, in the level of the map whose
// texels are about as wide as its shorter one; of coarser levels, as that grows, more and more of it in
// the next, or edges between the two would show.
struct Footprint {
  vec2 across, skew;
  float narrow, wide;
  int level;
  float next_share;
};

Footprint footprint_of(Photon photon, ivec2 cell, int order, int lane, uint path, int page, vec2 here) {
  vec2 start = unpackSnorm2x16(photon.offset), extent = unpackUnorm2x16(photon.extent);
  vec2 skew_a, skew_b;
  vec2 a =
      extent.x * image_of_side(neighbour_step(cell, ivec2(1, 0), start, order, lane, path, page, here),
                               neighbour_step(cell, ivec2(-1, 0), start, order, lane, path, page, here),
                               skew_a);
  vec2 b =
      extent.y * image_of_side(neighbour_step(cell, ivec2(0, 1), start, order, lane, path, page, here),
                               neighbour_step(cell, ivec2(0, -1), start, order, lane, path, page, here),
                               skew_b);
  // Principal axes of the cell's image: a fold makes it thin, whatever way the cell's sides point.
  float xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y;
  float half_trace = 0.5 * (xx + yy), root = length(vec2(0.5 * (xx - yy), xy));
  float wide = sqrt(half_trace + root), narrow = sqrt(max(half_trace - root, 0.0));
  vec2 axis = xx > yy ? vec2(0.5 * (xx - yy) + root, xy) : vec2(xy, 0.5 * (yy - xx) + root);
  Footprint f;
  f.across = wide * axis / max(length(axis), 1e-20);
  bool by_a = dot(a, a) > dot(b, b);
  f.skew = by_a ? extent.x * skew_a : extent.y * skew_b;
  if (dot(f.across, by_a ? a : b) < 0.0) f.across = -f.across;
  f.skew *= min(1.0, wide / max(length(f.skew), 1e-20));
  float least = max(max(narrow, wide / float(MAX_PIECES)), 0.5);
  float fine = max(log2(least) + 1.25, 0.0), whole = min(floor(fine), float(MAP_LEVELS - 1));
  f.level = int(whole);
  bool shares = f.level > 0 && f.level + 1 < MAP_LEVELS;
  f.next_share = shares ? clamp(2.0 * (fine - whole) - 1.0, 0.0, 1.0) : 0.0;
  // A tear between neighbours is not a footprint: no farther than the pieces can cover.
  float most_wide = 2.0 * exp2(whole) * float(MAX_PIECES);
  f.wide = min(wide, most_wide);
  f.narrow = narrow;
  f.across *= f.wide / max(wide, 1e-20);
  f.skew *= f.wide / max(wide, 1e-20);
  return f;
}

// Light that lies close together or along a line, before it is listed.
struct Piece {
  vec3 flux, x, y;  // X, Y and Z; and times how far they lie from there
  vec2 from, way;   // way: that its colours lead along, from back to front
  vec2 middle;      // of that way, from there
  int page;
  float weight;
};

void list_piece(Piece p, Footprint f) {
  vec3 x = p.x / max(p.flux, vec3(1e-30)) - p.middle.x, y = p.y / max(p.flux, vec3(1e-30)) - p.middle.y;
  uvec2 place = packed_place(p.from + p.middle, p.page, f.level);
  uvec3 units = uvec3(p.flux / lights[light].misc.y + 0.5);
  uint word = min(atomicAdd(splat_count, 1u), most) * SPLAT_WORDS;
  splat[word] = place.x;
  splat[word + 1u] = place.y;
  splat[word + 2u] = packHalf2x16(f.across);
  splat[word + 3u] = units.x;
  splat[word + 4u] = units.y;
  splat[word + 5u] = units.z;
  splat[word + 6u] = packHalf2x16(vec2(x.x, y.x));
  splat[word + 7u] = packHalf2x16(vec2(x.y, y.y));
  splat[word + 8u] = packHalf2x16(vec2(x.z, y.z));
  splat[word + 9u] = packHalf2x16(p.way);
  splat[word + 10u] = packHalf2x16(f.skew);
  splat[word + 11u] = packHalf2x16(vec2(f.narrow, f.next_share));
}

// What is known of a path at one wavelength.
struct Node {
  uint path;  // 0: no landing
  float index, flux;
  vec2 at;
  int page;
  Exit left;
  float way;  // TINTING: inside, m
};

Node node_at(int at, bool there, float index, vec2 elsewhere) {
  Node n;
  vec4 to = texelFetch(NODE_LANDINGS, LANDING_TEXELS * at);
  vec4 wall = texelFetch(NODE_LANDINGS, LANDING_TEXELS * at + 1);
  n.path = there ? texelFetch(NODE_SIGNATURES, at).x : 0u;
  n.index = index;
  n.left = exit_of(to, wall, index);
  n.page = n.path != 0u ? wall_page(wall.w) : NO_PAGE;
  n.at = n.path != 0u ? map_position(to.xyz, n.page) : elsewhere;
  n.flux = n.path != 0u ? to.w : 0.0;
  n.way = 0.0;
#ifdef TINTING
  n.way = there ? uintBitsToFloat(texelFetch(NODE_SIGNATURES, at).y) : 0.0;
#endif
  return n;
}

// What varies so evenly with the index that three nodes tell it.
vec4 smooth_of(Node n) { return vec4(n.left.along, n.left.arrives); }

bool on_the_map(vec2 at, int page) {
  vec4 rect = vec4(0, 0, vec2(map_size));
#ifdef PAGES
  if (page >= 0) rect = page_rect(light, page);
#endif
  return all(greaterThanEqual(at, rect.xy)) && all(lessThan(at, rect.zw));
}

// A power of two, so that pieces end at steps of the interval.
int pieces_of(float way, float size, int least, int most_pieces) {
  int needed = int(ceil(log2(max(way / (SEGMENT * size), 1.0))));
  return min(max(1 << needed, least), most_pieces);
}

// Returns by how much more light leaves the last walls than the nodes' own, by how much more is absorbed
// than at the nodes (both may be below 0), and what would lie beyond the map; W.
vec3 deposit() {
  uint listed = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
         gl_LocalInvocationID.x;
  vec3 entry = vec3(0);
  if (listed >= path_count) return entry;
  uint photon_path = path_list[listed];
  int order = int(photon_path % SLOTS);
#ifdef REFINED
  uint pair = pair_at[photon_path / SLOTS];
  uint photon = pair / PAIR_INTERVALS, coarse_interval = pair % PAIR_INTERVALS;
  int node_first = coarse_node(int(coarse_interval)), node_last = coarse_node(int(coarse_interval) + 1);
  int interval_last = node_last, turns = node_last - node_first,
      twice_middle = 2 * int(coarse_interval) + 1;
  int from_node = int(photon_path) * FINE_NODES - node_first;
  uint first = (photon * SLOTS + uint(order)) * LANES;
#else
  uint photon = photon_path / SLOTS, first = photon_path * LANES;
  int node_first = lane_first, node_last = lane_first + lane_count - 1;
  int interval_last = interval_end - 1, turns = interval_end - interval_first, twice_middle = lane_count;
  int from_node = int(first) - lane_first;
  uint refined = want[photon] << 1;
#endif
  Photon from_cell = photon_at[photon];
  uint packed_cell = from_cell.cell;
  if (packed_cell * 2654435761u % chunks != chunk) return entry;
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
  int reference_at = LANDING_TEXELS * int(first + uint(reference));
  int page = path != 0u ? wall_page(texelFetch(landings, reference_at + 1).w) : NO_PAGE;
  vec2 here = map_position(texelFetch(landings, reference_at).xyz, page);
  Footprint footprint = footprint_of(from_cell, cell, order, reference, path, page, here);
  float size = exp2(float(footprint.level));
#ifdef REFINED
  for (int i = 0; i < FINE_NODES; i++)
    path = max(path, texelFetch(fine_signatures, from_node + node_first + i).x);
#endif
  int owner_row = light * REFRACTORS + int(path & 255u);
  int row = table_first + owner_row * (nodes + 1);
#ifdef TINTING
  int band_row = band_first + owner_row * nodes;
#endif

  Piece piece;
  piece.flux = piece.x = piece.y = vec3(0);
  piece.weight = 0.0;
  piece.page = NO_PAGE;
  int first_row = INTERVAL_TEXELS * (row + interval_last) * (STEPS + 1);
  float first_index = texelFetch(interval_sums, first_row + 1).w;
  Node a = node_at(from_node + interval_last, true, first_index, here), z = a;  // the last two
  vec4 curve_before = vec4(0);  // second differences
  bool followed = false;  // z and a are of one path
  bool owes = false;  // a's half of the interval before is not laid yet: on that row, with so much left
  int owed_row = first_row;
  float owed_left = 1.0, way_before = 0.0;
#ifdef DOUBTS_BRIDGES
  vec2 step_before = vec2(0);
#endif
  // The last turn lists what is gathered.
  for (int turn = 0; turn <= turns; turn++) {
    bool last = turn == turns;
    int interval = interval_last - turn, node_b = interval - 1;
    bool has_b = node_b >= node_first && node_b <= node_last && !last;
    int index_b = from_node + (has_b ? node_b : node_first);
#ifdef REFINED
    bool taken = !last;
#else
    bool taken = !last && (refined >> uint(max(interval, 0)) & 1u) == 0u;
#endif
    int interval_row = INTERVAL_TEXELS * ((row + clamp(interval, 0, nodes)) * (STEPS + 1));
    int interval_end_at = interval_row + INTERVAL_TEXELS * STEPS;
    float index_there = texelFetch(interval_sums, interval_end_at + 1).w;
    Node b = node_at(index_b, has_b, index_there, a.at);
    int least = 1;
    float mean_a = 1.0, mean_b = 1.0;  // what is left at the nodes
#ifdef TINTING
    // In eight parts of the interval, four to each node.
    int half_a = 4 * (band_row + clamp(interval, 0, nodes - 1)),
        half_b = 4 * (band_row + max(node_b, 0)) + 2;
    vec4 taken_a = a.way * texelFetch(band_attenuation, half_a), left_a = exp(-taken_a);
    vec4 taken_b = b.way * texelFetch(band_attenuation, half_b), left_b = exp(-taken_b);
    bool even =
        (a.flux == 0.0 || is_even(taken_a, left_a)) && (b.flux == 0.0 || is_even(taken_b, left_b));
    mean_a = dot(left_a, texelFetch(band_attenuation, half_a + 1));
    mean_b = dot(left_b, texelFetch(band_attenuation, half_b + 1));
    least = even ? 1 : 8;
#endif
    float way = max(abs(b.at.x - a.at.x), abs(b.at.y - a.at.y));
    bool one_path = false;
#ifdef BRIDGE
    one_path = a.path != 0u && a.path == b.path;
#ifdef DOUBTS_BRIDGES
    // Paths through a mesh may be alike and yet part: a long way is a spectrum's where the light
    // moves on likewise in the interval before or after it.
    bool has_c = has_b && node_b > node_first;
    int index_c = has_c ? index_b - 1 : index_b;
    uint path_c = has_c ? texelFetch(NODE_SIGNATURES, index_c).x : 0u;
    vec2 at_c = map_position(texelFetch(NODE_LANDINGS, LANDING_TEXELS * index_c).xyz, b.page);
    vec2 on = b.at - a.at, after = path_c != 0u && path_c == b.path ? at_c - b.at : vec2(0);
    bool likewise = min(distance(on, step_before), distance(on, after)) < 0.75 * length(on);
    step_before = one_path ? on : vec2(0);
    one_path = one_path && (way < float(map_size) / 16.0 || likewise);
#endif
#endif
    // Light is laid from a to b where they are of one path, else a's half of it goes on from z and a; and
    // before that the half that a is owed.
    bool bridge = taken && one_path, follows = bridge || (taken && followed);
    Node from = z, to = a;
    if (bridge) {
      from = a;
      to = b;
    }
    float span = to.index - from.index, per_index = span != 0.0 ? 1.0 / span : 0.0;
    float back = (z.index - a.index) * per_index;  // where z lies, below 0
    vec4 bend = smooth_of(z) - smooth_of(a) - back * (smooth_of(b) - smooth_of(a));
    vec4 curve = !bridge                    ? curve_before
                 : followed && back < -0.05 ? bend / (back * (back - 1.0))
                                            : vec4(0);
    Fan fan = fan_between(from.left, to.left, curve.xyz);
    // Where the wall reflects all before b, the path ends there, and not halfway.
    float cosine = cosine_between(from.left, to.left, fan, (index_there - from.index) * per_index);
    bool ends = follows && !bridge && to.left.transmits && cosine == 0.0;
    int steps = bridge || ends ? STEPS : STEPS / 2;
    int pieces = taken && a.flux > 0.0 ? pieces_of(bridge    ? way
                                                   : follows ? way_before
                                                             : 0.0,
                                                   size, least, steps)
                                       : 0;
    int owed = owes ? pieces_of(bridge ? way : 0.0, size, least, STEPS / 2) : 0,
        all = owed + pieces + (last ? 1 : 0);
    vec2 at_before = a.at;
    vec3 middle = texelFetch(interval_sums, interval_row + INTERVAL_TEXELS * (STEPS / 2)).xyz;
    int owed_at = owed_row + INTERVAL_TEXELS * STEPS;
    vec4 before = texelFetch(interval_sums, owed_at);
    vec3 moment_before = texelFetch(interval_sums, owed_at + 1).xyz;
    vec3 taken_before = vec3(0);
#ifdef TINTING
    taken_before = texelFetch(interval_sums, owed_at + 2).xyz;
#endif
    for (int k = 0; k < all; k++) {
      bool is_owed = k < owed;
      if (k == owed) {  // the row's first step has nothing before it
        before = vec4(0);
        moment_before = vec3(0);
        taken_before = vec3(0);
        at_before = a.at;
      }
      int upto_step = is_owed ? STEPS - (k + 1) * (STEPS / 2) / max(owed, 1)
                              : (k + 1 - owed) * steps / max(pieces, 1);
      int upto_at = (is_owed ? owed_row : interval_row) + INTERVAL_TEXELS * min(upto_step, STEPS);
      vec4 upto = texelFetch(interval_sums, upto_at), moment = texelFetch(interval_sums, upto_at + 1);
      vec3 xyz = abs(upto.xyz - before.xyz), first_half = min(upto.xyz, middle) - min(before.xyz, middle);
      // What the nodes say of it.
      float share_a = is_owed ? xyz.y : first_half.y;
      vec2 said = vec2(a.flux * share_a, bridge ? b.flux * (xyz.y - share_a) : 0.0);
      float said_left = dot(said, vec2(is_owed ? owed_left : mean_a, mean_b));
      // X, Y and Z have each a middle of its own, along the row.
      vec3 middles = abs(moment.xyz - moment_before) / max(xyz, vec3(1e-20));
      middles = clamp(middles, vec3(min(before.w, upto.w)), vec3(max(before.w, upto.w)));
      float row_middle = dot(middles, xyz) / max(xyz.x + xyz.y + xyz.z, 1e-20);
      float row_index = is_owed ? z.index : a.index,
            row_span = (is_owed ? a.index : index_there) - row_index;
      float index_middle = row_index + row_middle * row_span;
      float s = (index_middle - from.index) * per_index;
      // Where the path changes somewhere between two nodes, its light changes evenly in the mean.
      Exit first = a.left, second = b.left;
      if (is_owed) {
        first = z.left;
        second = a.left;
      }
      bool both = (is_owed ? z.flux : a.flux) > 0.0 && (is_owed ? a.flux : b.flux) > 0.0;
      vec3 arrives =
          both ? first.arrives + middles * (second.arrives - first.arrives) : vec3(a.left.arrives);
      vec3 flux = a.left.passes * arrives * xyz;
      vec2 at = a.at, way_here = vec2(0);
      if (follows && (bridge || !is_owed)) {
        vec2 at_upto = map_position(
            place_between(from.left, to.left, fan, (moment.w - from.index) * per_index), a.page);
        if (bridge && !is_owed) arrives += middles * (middles - 1.0) * curve.w;
        float passes =
            transmission(to.left.transmits, cosine_between(from.left, to.left, fan, s), index_middle);
        vec3 passes_each = passes + (middles - row_middle) * (both ? second.passes - first.passes : 0.0);
        flux = max(passes_each * arrives, 0.0) * xyz;
        at = 0.5 * (at_before + at_upto);
        way_here = at_upto - at_before;
        at_before = at_upto;
      }
      vec3 along = (middles - before.w) / (upto.w - before.w == 0.0 ? 1.0 : upto.w - before.w) - 0.5;
      vec3 left_here = vec3(1);
#ifdef TINTING
      // As the mean over the piece attenuates each of the three.
      vec3 taken_upto = texelFetch(interval_sums, upto_at + 2).xyz;
      vec3 per_m = abs(taken_upto - taken_before) / max(xyz, vec3(1e-30));
      taken_before = taken_upto;
      left_here = exp(-(bridge ? mix(from.way, to.way, clamp(s, 0.0, 1.0)) : a.way) * per_m);
#endif
      before = upto;
      moment_before = moment.xyz;
      bool lands = (s >= 0.0 && s <= 1.0) || on_the_map(at, a.page), ending = last && k == owed;
      if (!ending) {
        float all_said = said.x + said.y;
        entry.x += flux.y * (all_said > 0.0 ? said_left / all_said : 1.0) - said_left;
        entry.y += flux.y * ((all_said > 0.0 ? said_left / all_said : 1.0) - left_here.y);
        entry.z += lands ? 0.0 : flux.y * left_here.y;
      }
      flux *= left_here;
      float weight = ending || !lands ? 0.0 : flux.x + flux.y + flux.z;
      vec2 off = abs(at - piece.from);
      bool elsewhere = max(off.x, off.y) > 0.75 * size || a.page != piece.page;
      if (piece.weight > 0.0 && (ending || (weight > 0.0 && elsewhere))) {
        list_piece(piece, footprint);
        piece.flux = piece.x = piece.y = vec3(0);
        piece.weight = 0.0;
      }
      if (weight > 0.0) {
        if (piece.weight == 0.0) {
          piece.from = at;
          piece.way = piece.middle = vec2(0);
          piece.page = a.page;
        }
        vec2 off_here = at - piece.from;
        piece.flux += flux;
        piece.x += flux * (off_here.x + along * way_here.x);
        piece.y += flux * (off_here.y + along * way_here.y);
        piece.way += way_here;
        piece.middle += piece.weight == 0.0 ? vec2(0) : 0.5 * way_here;
        piece.weight += weight;
      }
    }
    owes = taken && !bridge && b.path != 0u;
    owed_row = interval_row;
    owed_left = mean_b;
    followed = one_path;
    curve_before = curve;
    way_before = way;
    z = a;
    a = b;
  }
  return entry;
}

void main() {
  if (gl_LocalInvocationID.x < 3u) {
    more_sum[gl_LocalInvocationID.x] = 0u;
    less_sum[gl_LocalInvocationID.x] = 0u;
  }
  barrier();
  vec3 entry = deposit() / ledger_unit;
  for (int k = 0; k < 3; k++) {
    if (entry[k] > 0.0) atomicAdd(more_sum[k], uint(entry[k] + 0.5));
    if (entry[k] < 0.0) atomicAdd(less_sum[k], uint(0.5 - entry[k]));
  }
  barrier();
  if (gl_LocalInvocationID.x < 3u) {
    uint k = gl_LocalInvocationID.x, at = 2u * uvec3(INTERPOLATED, ABSORBED, MISSED)[k];
    WIDE_ADD(ledger, at, at + 1u, more_sum[k])
    WIDE_SUBTRACT(ledger, at, at + 1u, less_sum[k])
  }
}
