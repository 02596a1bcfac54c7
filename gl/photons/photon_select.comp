// Lists the intervals between coarse wavelengths that ask for all wavelengths in them: where light would
// be laid wrong by more than what the map resolves of the photon, since its path ends between them or
// bends more than the deposit follows, or where what it carries changes.
layout(local_size_x = 256) in;
#include "common.glsl"
#include "photon_nodes.glsl"

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
layout(std430, binding = BINDING_WANTS) buffer Wants { uint want[]; };  // a bit an interval
layout(std430, binding = BINDING_PHOTON_OF_CELL) readonly buffer Slots { uint slot[]; };
layout(std430, binding = BINDING_HITS) readonly buffer Landings { vec4 landing[]; };
#ifdef TINTING
layout(std430, binding = BINDING_SIGNATURES) readonly buffer Signatures { uvec2 signature[]; };  // length inside in y
#define SIGNATURE(i) signature[i].x
#else
layout(std430, binding = BINDING_SIGNATURES) readonly buffer Signatures { uint signature[]; };
#define SIGNATURE(i) signature[i]
#endif
layout(std430, binding = BINDING_PAIRS) buffer PairList {
  uint pair_count, pair_groups[3];
  uint pair_at[];
};
layout(std430, binding = BINDING_PATHS) readonly buffer PathList {
  uint path_count, path_groups[3];
  uint path_list[];
};

uniform int light;
uniform ivec2 grid;
uniform int map_size;
uniform uint chunks, chunk;  // only photons of this chunk
uniform uint most_pairs;     // that the list has room for

uniform float interval_weight[NODES];  // of the light, by the intervals' mean

// Of the photon's light in an interval: what may lie wrong by a footprint's width.
const float MOST_WRONG = 0.05;

// How far off the deposit's light is: of a node's distance from where its neighbours put it along a line,
// with and without the node before; and of the way between two nodes of which no more is known.
const float OFF_CURVE = 0.1, OFF_LINE = 0.25, OFF_ALONE = 2e-3;

#include "optics.glsl"
#define FOLLOWS_EXITS
#include "exit_wall.glsl"
#include "landing_place.glsl"

// Texels to the landing of the next photon on the same path; 0 if there is none.
float step_to(ivec2 c, uint order, uint lane, uint path, int page, vec2 here) {
  bool there = all(lessThan(c, grid));
  uint at = slot[there ? c.y * grid.x + c.x : 0];
  there = there && at != 0u;
  uint index = ((there ? at - 1u : 0u) * SLOTS + order) * LANES + lane;
  there = there && SIGNATURE(index) == path;
  return there ? distance(map_position(landing[LANDING_TEXELS * index].xyz, page), here) : 0.0;
}

void main() {
  uint listed = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
         gl_LocalInvocationID.x;
  if (listed >= path_count) return;
  uint photon_path = path_list[listed];
  uint photon = photon_path / SLOTS, order = photon_path % SLOTS, first = photon_path * LANES;
  Photon from_cell = photon_at[photon];
  // Other bits than those that choose the chunks of pieces, or one of these would get all.
  if ((from_cell.cell * 2654435761u >> 16) % chunks != chunk) return;
  ivec2 cell = ivec2(from_cell.cell & 0xffffu, from_cell.cell >> 16);

  uint path[NODES];
  vec2 at[NODES];
  float flux[NODES], index[NODES];
  int pages[NODES];
  Exit left[NODES];
#ifdef TINTING
  float way[NODES], per_m[NODES];
#endif
  int reference = 0;
  for (int k = 0; k < NODES; k++) {
    uint found = SIGNATURE(first + uint(k));
    vec4 to = landing[LANDING_TEXELS * (first + uint(k))];
    vec4 wall = landing[LANDING_TEXELS * (first + uint(k)) + 1u];
    vec2 spectrum = spectra[int(found & 255u) % REFRACTORS * WAVELENGTHS + coarse_node(k)].xy;
    path[k] = found;
    pages[k] = found != 0u ? wall_page(wall.w) : -1;
    at[k] = found != 0u ? map_position(to.xyz, pages[k]) : vec2(0);
    index[k] = spectrum.x;
    left[k] = exit_of(to, wall, spectrum.x);
    flux[k] = found != 0u ? left[k].arrives : 0.0;
#ifdef TINTING
    way[k] = uintBitsToFloat(signature[first + uint(k)].y);
    per_m[k] = spectrum.y;
#endif
    if (found != 0u && abs(2 * k - NODES) < abs(2 * reference - NODES)) reference = k;
  }
  uint path_here = SIGNATURE(first + uint(reference));
  uint reference_at = LANDING_TEXELS * (first + uint(reference));
  int page = path_here != 0u ? wall_page(landing[reference_at + 1u].w) : -1;
  vec2 here = map_position(landing[reference_at].xyz, page);
  float a =
      path_here != 0u ? step_to(cell + ivec2(1, 0), order, uint(reference), path_here, page, here) : 0.0;
  float b =
      path_here != 0u ? step_to(cell + ivec2(0, 1), order, uint(reference), path_here, page, here) : 0.0;
  // What the map resolves of this photon, in texels.
  float size = max(a > 0.0 && b > 0.0 ? min(a, b) : max(a, b), 1.0);

  // How far node k lies from where its neighbours alone would put it.
  float bend[NODES];
  for (int k = 0; k < NODES; k++) {
    bool there = k > 0 && k + 1 < NODES;
    int before = max(k - 1, 0), after = min(k + 1, NODES - 1);
    bool on_path = there && path[k] != 0u && path[k] == path[before] && path[k] == path[after];
    float span = index[after] - index[before];
    float t = span != 0.0 ? (index[k] - index[before]) / span : 0.5;
    vec3 straight =
        place_between(left[before], left[after], fan_between(left[before], left[after], vec3(0)), t);
    bend[k] = on_path ? distance(at[k], map_position(straight, pages[k])) : -1.0;
  }
  uint wanted = 0u;
  for (int k = 0; k + 1 < NODES; k++) {
    float flux_a = flux[k], flux_b = flux[k + 1];
#ifdef TINTING
    // What is left at both ends, and, to tell what changes, of the same glass.
    float left = 0.5 * (exp(-per_m[k] * way[k]) + exp(-per_m[k + 1] * way[k + 1]));
    float per_m_between = 0.5 * (per_m[k] + per_m[k + 1]);
    float most = left * max(flux_a, flux_b) / from_cell.flux * interval_weight[k];
    flux_b *= exp(-per_m_between * (way[k + 1] - way[k]));
#else
    float most = max(flux_a, flux_b) / from_cell.flux * interval_weight[k];
#endif
    bool same = path[k] == path[k + 1];
    float wrong = bend[k + 1] >= 0.0 ? OFF_CURVE * bend[k + 1]
                  : bend[k] >= 0.0   ? OFF_LINE * bend[k]
                                     : OFF_ALONE * distance(at[k], at[k + 1]);
    // Where a path ends on the way, its landings would have moved on as before.
    int before = max(k - 1, 0), after = min(k + 2, NODES - 1);
    bool known_a = k > 0 && path[before] == path[k],
         known_b = k + 2 < NODES && path[after] == path[k + 1];
    float moves_a = path[k] == 0u ? 0.0 : known_a ? distance(at[before], at[k]) : size;
    float moves_b = path[k + 1] == 0u ? 0.0 : known_b ? distance(at[after], at[k + 1]) : size;
    if (!same) wrong = 0.25 * max(moves_a, moves_b);
    float change = (flux_a - flux_b) / max(max(flux_a, flux_b), 1e-30);
    float changed = same ? 0.125 * change * change : 0.0;
    if (most * max(min(wrong / size, 1.0), changed) > MOST_WRONG) wanted |= 1u << uint(k);
  }
  if (wanted == 0u) return;
  uint added = wanted & ~atomicOr(want[photon], wanted);
  for (int k = 0; k + 1 < NODES; k++) {
    if ((added >> uint(k) & 1u) == 0u) continue;
    uint place = atomicAdd(pair_count, 1u);
    if (place < most_pairs) pair_at[place] = photon * PAIR_INTERVALS + uint(k);
  }
}
