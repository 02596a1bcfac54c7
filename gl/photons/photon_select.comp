// Lists the intervals between coarse wavelengths that need all wavelengths in them: where light would
// be laid wrong by more than what the map resolves of the photon, since its path ends between them or
// bends more than the deposit follows, or where what it carries changes.
layout(local_size_x = 256) in;
#include "common.glsl"
#include "photon_nodes.glsl"
#include "thread.glsl"
#include "photons.glsl"
#include "path_list.glsl"
#define LISTS_PAIRS
#include "pair_list.glsl"

layout(std430, binding = BINDING_WANTS) buffer Wants { uint want[]; };  // a bit an interval
layout(std430, binding = BINDING_PHOTON_OF_CELL) readonly buffer Slots { uint slot[]; };
layout(std430, binding = BINDING_HITS) readonly buffer Hits { vec4 hits[]; };
#include "tints.glsl"
layout(std430, binding = BINDING_SIGNATURES) readonly buffer Signatures { Signature signature[]; };
#define SIGNATURE(i) signature[i].x

#include "pass_light.glsl"
uniform ivec2 grid;
uniform int map_size;
uniform uint most_pairs;  // capacity of the list

uniform float interval_weight[PAIR_INTERVALS];  // weight of the light, by the intervals' mean

// Share of the photon's light in an interval that may lie wrong by a footprint's width.
const float MOST_WRONG = 0.05;

// How far off the deposit's light is: of a node's distance from where its neighbours put it along a line,
// with and without the node before; and of the interval between two nodes of which no more is known.
const float OFF_CURVE = 0.1, OFF_LINE = 0.25, OFF_ALONE = 2e-3;

#include "optics.glsl"
#define FOLLOWS_SEGMENTS
#include "outgoing_segment.glsl"
#include "map_position.glsl"

// A photon's path at a coarse wavelength.
struct Sample {
  uint path;  // signature; 0: no hit
  vec2 at;
  float flux, index;
  int tile;
  Segment left;
#ifdef TINTS
  Tints tints;
  int node;
#endif
};

Sample sample_at(uint first, int node) {
  uint at = first + uint(node);
  vec4 to = hits[HIT_TEXELS * at], interface_at = hits[HIT_TEXELS * at + 1u];
  Sample s;
  s.path = SIGNATURE(at);
  vec2 spectrum = spectra[int(s.path & 255u) % REFRACTORS * counts.wavelengths + coarse_node(node)].xy;
  s.tile = s.path != 0u ? interface_tile(interface_at.w) : -1;
  s.at = s.path != 0u ? map_position(to.xyz, s.tile) : vec2(0);
  s.index = spectrum.x;
  s.left = segment_of(to, interface_at, spectrum.x);
  s.flux = s.path != 0u ? s.left.arrives : 0.0;
#ifdef TINTS
  s.tints = tints_of(wide_signature(signature[at]));
  s.node = node;
#endif
  return s;
}

// Which hits something nearest the middle.
int reference_of(uint first) {
  int reference = 0;
  for (int k = 0; k < counts.nodes; k++)
    if (SIGNATURE(first + uint(k)) != 0u && abs(2 * k - counts.nodes) < abs(2 * reference - counts.nodes)) reference = k;
  return reference;
}

// What the map resolves of this photon, in texels: the shorter distance to a neighbour's hit on the same path,
// along either axis.
float resolved(ivec2 cell, uint order, uint first, uint reference) {
  uint path = SIGNATURE(first + reference), at = HIT_TEXELS * (first + reference);
  int tile = path != 0u ? interface_tile(hits[at + 1u].w) : -1;
  vec2 here = vec2(0);
  float shortest = 0.0;
  for (int k = 0; k < 3; k++) {  // itself, then the two
    ivec2 c = cell + ivec2(k & 1, k >> 1);
    bool there = path != 0u && all(lessThan(c, grid));
    uint cell_slot = slot[there ? c.y * grid.x + c.x : 0];
    there = there && cell_slot != 0u;
    uint index = ((there ? cell_slot - 1u : 0u) * counts.slots + order) * counts.hit_stride + reference;
    there = there && SIGNATURE(index) == path;
    vec2 to = map_position(hits[HIT_TEXELS * index].xyz, tile);
    if (k == 0) here = to;
    float step = there ? distance(to, here) : 0.0;
    shortest = shortest > 0.0 && step > 0.0 ? min(shortest, step) : max(shortest, step);
  }
  return max(shortest, 1.0);
}

// How far a node lies from where its neighbours alone would put it; -1: they are of other paths.
float bend_of(Sample before, Sample s, Sample after) {
  bool on_path = s.path != 0u && s.path == before.path && s.path == after.path;
  float span = after.index - before.index;
  float t = span != 0.0 ? (s.index - before.index) / span : 0.5;
  vec3 straight = place_between(before.left, after.left, fan_between(before.left, after.left, vec3(0)), t);
  return on_path ? distance(s.at, map_position(straight, s.tile)) : -1.0;
}

// How far off light is laid between a and b, in texels: they lie so far off. before and after: the nodes
// beside them, or the same where there are none.
float misplaced(Sample before, Sample a, Sample b, Sample after, bool has_before, bool has_after, float bend_a,
                float bend_b, float size) {
  if (a.path == b.path)
    return bend_b >= 0.0 ? OFF_CURVE * bend_b : bend_a >= 0.0 ? OFF_LINE * bend_a : OFF_ALONE * distance(a.at, b.at);
  // Where a path ends in between, its hits would have moved on as before.
  bool known_a = has_before && before.path == a.path, known_b = has_after && after.path == b.path;
  float moves_a = a.path == 0u ? 0.0 : known_a ? distance(before.at, a.at) : size;
  float moves_b = b.path == 0u ? 0.0 : known_b ? distance(after.at, b.at) : size;
  return 0.25 * max(moves_a, moves_b);
}

#ifdef TINTS
float larger_of(vec2 v) { return abs(v.x) > abs(v.y) ? v.x : v.y; }
#endif

// The share of the photon's light that may lie wrong between a and b.
float wrong_between(Sample a, Sample b, float misplaced_by, float size, float photon_flux,
                    float weight) {
  float flux_a = a.flux, flux_b = b.flux, left = 1.0;
#ifdef TINTS
  // What is left of the halves between them, and, to find what changes, of the same path through what tints.
  int at_a = TINT_TEXELS * PART_SURFACES * a.node, at_b = TINT_TEXELS * PART_SURFACES * b.node;
  vec2 above = depth_of(a.tints, at_a, true), below = depth_of(b.tints, at_b, false);
  left = 0.5 * (left_after(above) + left_after(below));
#endif
  float most = left * max(flux_a, flux_b) / photon_flux * weight;
#ifdef TINTS
  vec2 at_first = above - depth_of(b.tints, at_a, true), at_last = depth_of(a.tints, at_b, false) - below;
  flux_b *= exp(0.5 * (larger_of(at_first) + larger_of(at_last)));
#endif
  float change = (flux_a - flux_b) / max(max(flux_a, flux_b), 1e-30);
  float changed = a.path == b.path ? 0.125 * change * change : 0.0;
  return most * max(min(misplaced_by / size, 1.0), changed);
}

// The intervals that are wrong, a bit each. Node by node, four at hand: no node is read or placed by a
// part of the shader of its own.
uint wrong_intervals(uint first, float size, float photon_flux) {
  uint wanted = 0u;
  Sample before, a, b, after;
  float bend_a = -1.0, bend_b = -1.0;
  for (int k = -2; k + 1 < counts.nodes; k++) {  // the interval from node k on
    before = a;
    a = b;
    b = after;
    after = sample_at(first, min(k + 2, counts.nodes - 1));
    if (k == -2) before = a = b = after;
    bool has_after = k + 2 < counts.nodes;
    bend_a = bend_b;
    bend_b = k >= 0 && has_after ? bend_of(a, b, after) : -1.0;
    float misplaced_by = misplaced(before, a, b, after, k > 0, has_after, bend_a, bend_b, size);
    bool wrong = wrong_between(a, b, misplaced_by, size, photon_flux, interval_weight[max(k, 0)]) > MOST_WRONG;
    wanted |= k >= 0 && wrong ? 1u << uint(k) : 0u;
  }
  return wanted;
}

void main() {
  copy_light();
  uint listed = thread_number();
  if (listed >= path_count) return;
  uint photon_path = path_list[listed];
  uint photon = photon_path / counts.slots, order = photon_path % counts.slots, first = photon_path * counts.hit_stride;
  Photon from_cell = photon_at[photon];
  ivec2 cell = ivec2(from_cell.cell & 0xffffu, from_cell.cell >> 16);
  float size = resolved(cell, order, first, uint(reference_of(first)));
  uint wanted = wrong_intervals(first, size, from_cell.flux);
  if (wanted == 0u) return;
  for (uint added = wanted & ~atomicOr(want[photon], wanted); added != 0u; added &= added - 1u) {
    uint place = atomicAdd(pair_count, 1u);
    if (place < most_pairs) pair_at[place] = photon * PAIR_INTERVALS + uint(findLSB(added));
  }
}
