// Lists the intervals between coarse wavelengths that ask for all wavelengths in them: where light would
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
#ifdef TINTING
layout(std430, binding = BINDING_SIGNATURES) readonly buffer Signatures { uvec2 signature[]; };  // length inside in y
#define SIGNATURE(i) signature[i].x
#else
layout(std430, binding = BINDING_SIGNATURES) readonly buffer Signatures { uint signature[]; };
#define SIGNATURE(i) signature[i]
#endif

#include "pass_light.glsl"
uniform ivec2 grid;
uniform int map_size;
uniform uint chunks, chunk;  // only photons of this chunk
uniform uint most_pairs;     // that the list has room for

uniform float interval_weight[NODES];  // of the light, by the intervals' mean

// Of the photon's light in an interval: what may lie wrong by a footprint's width.
const float MOST_WRONG = 0.05;

// How far off the deposit's light is: of a node's distance from where its neighbours put it along a line,
// with and without the node before; and of the stretch between two nodes of which no more is known.
const float OFF_CURVE = 0.1, OFF_LINE = 0.25, OFF_ALONE = 2e-3;

#include "optics.glsl"
#define FOLLOWS_SEGMENTS
#include "outgoing_segment.glsl"
#include "map_position.glsl"

// A photon's path at the coarse wavelengths.
struct Samples {
  uint path[NODES];  // signature; 0: no hit
  vec2 at[NODES];
  float flux[NODES], index[NODES];
  int tile[NODES];
  Segment left[NODES];
#ifdef TINTING
  float path_m[NODES], per_m[NODES];
#endif
};

Samples samples;

// Reads them; returns which hits something nearest the middle.
int read_samples(uint first) {
  int reference = 0;
  for (int k = 0; k < NODES; k++) {
    uint found = SIGNATURE(first + uint(k));
    vec4 to = hits[HIT_TEXELS * (first + uint(k))];
    vec4 interface_at = hits[HIT_TEXELS * (first + uint(k)) + 1u];
    vec2 spectrum = spectra[int(found & 255u) % REFRACTORS * WAVELENGTHS + coarse_node(k)].xy;
    samples.path[k] = found;
    samples.tile[k] = found != 0u ? interface_tile(interface_at.w) : -1;
    samples.at[k] = found != 0u ? map_position(to.xyz, samples.tile[k]) : vec2(0);
    samples.index[k] = spectrum.x;
    samples.left[k] = segment_of(to, interface_at, spectrum.x);
    samples.flux[k] = found != 0u ? samples.left[k].arrives : 0.0;
#ifdef TINTING
    samples.path_m[k] = uintBitsToFloat(signature[first + uint(k)].y);
    samples.per_m[k] = spectrum.y;
#endif
    if (found != 0u && abs(2 * k - NODES) < abs(2 * reference - NODES)) reference = k;
  }
  return reference;
}

// Texels to the hit of the photon in cell c on the same path; 0 if there is none.
float step_to(ivec2 c, uint order, uint sample_number, uint path, int tile, vec2 here) {
  bool there = all(lessThan(c, grid));
  uint at = slot[there ? c.y * grid.x + c.x : 0];
  there = there && at != 0u;
  uint index = ((there ? at - 1u : 0u) * SLOTS + order) * HIT_STRIDE + sample_number;
  there = there && SIGNATURE(index) == path;
  return there ? distance(map_position(hits[HIT_TEXELS * index].xyz, tile), here) : 0.0;
}

// What the map resolves of this photon, in texels.
float resolved(ivec2 cell, uint order, uint first, uint reference) {
  uint path = SIGNATURE(first + reference), at = HIT_TEXELS * (first + reference);
  int tile = path != 0u ? interface_tile(hits[at + 1u].w) : -1;
  vec2 here = map_position(hits[at].xyz, tile);
  float a = path != 0u ? step_to(cell + ivec2(1, 0), order, reference, path, tile, here) : 0.0;
  float b = path != 0u ? step_to(cell + ivec2(0, 1), order, reference, path, tile, here) : 0.0;
  return max(a > 0.0 && b > 0.0 ? min(a, b) : max(a, b), 1.0);
}

// How far node k lies from where its neighbours alone would put it; -1: they are of other paths.
float bend_at(int k) {
  bool there = k > 0 && k + 1 < NODES;
  int before = max(k - 1, 0), after = min(k + 1, NODES - 1);
  bool on_path = there && samples.path[k] != 0u && samples.path[k] == samples.path[before] &&
                 samples.path[k] == samples.path[after];
  float span = samples.index[after] - samples.index[before];
  float t = span != 0.0 ? (samples.index[k] - samples.index[before]) / span : 0.5;
  Segment a = samples.left[before], b = samples.left[after];
  vec3 straight = place_between(a, b, fan_between(a, b, vec3(0)), t);
  return on_path ? distance(samples.at[k], map_position(straight, samples.tile[k])) : -1.0;
}

// How far off light is laid in interval k, in texels; its nodes lie so far off.
float misplaced(int k, float bend_a, float bend_b, float size) {
  if (samples.path[k] == samples.path[k + 1])
    return bend_b >= 0.0   ? OFF_CURVE * bend_b
           : bend_a >= 0.0 ? OFF_LINE * bend_a
                           : OFF_ALONE * distance(samples.at[k], samples.at[k + 1]);
  // Where a path ends in between, its hits would have moved on as before.
  int before = max(k - 1, 0), after = min(k + 2, NODES - 1);
  bool known_a = k > 0 && samples.path[before] == samples.path[k],
       known_b = k + 2 < NODES && samples.path[after] == samples.path[k + 1];
  float moves_a = samples.path[k] == 0u ? 0.0 : known_a ? distance(samples.at[before], samples.at[k]) : size;
  float moves_b =
      samples.path[k + 1] == 0u ? 0.0 : known_b ? distance(samples.at[after], samples.at[k + 1]) : size;
  return 0.25 * max(moves_a, moves_b);
}

// Of the photon's light, what may lie wrong in interval k.
float wrong_in(int k, float misplaced_by, float size, float photon_flux) {
  float flux_a = samples.flux[k], flux_b = samples.flux[k + 1], left = 1.0;
#ifdef TINTING
  // What is left at both ends, and, to tell what changes, of the same glass.
  float per_m_a = samples.per_m[k], per_m_b = samples.per_m[k + 1];
  left = 0.5 * (exp(-per_m_a * samples.path_m[k]) + exp(-per_m_b * samples.path_m[k + 1]));
#endif
  float most = left * max(flux_a, flux_b) / photon_flux * interval_weight[k];
#ifdef TINTING
  flux_b *= exp(-0.5 * (per_m_a + per_m_b) * (samples.path_m[k + 1] - samples.path_m[k]));
#endif
  float change = (flux_a - flux_b) / max(max(flux_a, flux_b), 1e-30);
  float changed = samples.path[k] == samples.path[k + 1] ? 0.125 * change * change : 0.0;
  return most * max(min(misplaced_by / size, 1.0), changed);
}

void main() {
  copy_light();
  uint listed = thread_number();
  if (listed >= path_count) return;
  uint photon_path = path_list[listed];
  uint photon = photon_path / SLOTS, order = photon_path % SLOTS, first = photon_path * HIT_STRIDE;
  Photon from_cell = photon_at[photon];
  // Other bits than those that choose the chunks of splats, or one of these would get all.
  if ((from_cell.cell * 2654435761u >> 16) % chunks != chunk) return;
  ivec2 cell = ivec2(from_cell.cell & 0xffffu, from_cell.cell >> 16);
  int reference = read_samples(first);
  float size = resolved(cell, order, first, uint(reference));
  float bend[NODES];
  for (int k = 0; k < NODES; k++) bend[k] = bend_at(k);
  uint wanted = 0u;
  for (int k = 0; k + 1 < NODES; k++) {
    float misplaced_by = misplaced(k, bend[k], bend[k + 1], size);
    if (wrong_in(k, misplaced_by, size, from_cell.flux) > MOST_WRONG) wanted |= 1u << uint(k);
  }
  if (wanted == 0u) return;
  uint added = wanted & ~atomicOr(want[photon], wanted);
  for (int k = 0; k + 1 < NODES; k++) {
    if ((added >> uint(k) & 1u) == 0u) continue;
    uint place = atomicAdd(pair_count, 1u);
    if (place < most_pairs) pair_at[place] = photon * PAIR_INTERVALS + uint(k);
  }
}
