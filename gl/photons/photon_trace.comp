// A photon a wavelength, on the paths of photon_path.glsl; what leaves a path is entered in the
// ledger.
layout(local_size_x = 256) in;
#include "refractor.glsl"
#include "wide_sum.glsl"
#include "receiver.glsl"
#include "exit_wall.glsl"

// [((photon * SLOTS + order) * LANES + lane) * LANDING_TEXELS]: where it lands, and w: flux for unit
// weight, W; then where it left its last refractor, and w: wall_word(). While pages are chosen: chart
// coordinates, and the chart's side.
layout(std430, binding = BINDING_HITS) writeonly buffer Landings { vec4 landing[]; };
// Receiver, facets along the way and whether on a page, equal for paths that vary continuously;
// refractor in the low eight bits; 0: no landing. TINTING: and the length of its way inside, m.
#ifdef TINTING
layout(std430, binding = BINDING_SIGNATURES) writeonly buffer Signatures { uvec2 signature[]; };
#else
layout(std430, binding = BINDING_SIGNATURES) writeonly buffer Signatures { uint signature[]; };
#endif
// Y weight of the samples at [light * WAVELENGTHS + i]: of the parts of their bands below and above
// the node, then those in the coarse set.
layout(std430, binding = BINDING_SAMPLE_WEIGHTS) readonly buffer SampleWeights { vec4 sample_weight[]; };
// 1 where the path (photon * SLOTS + order) lands at some wavelength.
layout(std430, binding = BINDING_PATH_MARKS) writeonly buffer PathMarks { uint path_mark[]; };
layout(std430, binding = BINDING_PAIRS) readonly buffer PairList {
  uint pair_count, pair_groups[3];
  uint pair_at[];
};
// lo and hi of reached, reflected, absorbed, trapped, missed.
layout(std430, binding = BINDING_LEDGER) buffer Ledger { uint ledger[]; };

uniform int light;
uniform ivec2 grid;
#include "photon_start.glsl"
uniform int lane_first;  // wavelengths lane_first .. lane_first + LANES - 1 in this batch
uniform int lane_count;
uniform int ledger_first;  // wavelengths before this one are in the ledger already
// ALL: consecutive wavelengths of all photons; COARSE: the coarse set of all photons; REFINED: all
// wavelengths of the intervals on the list, landings by their place on it.
const int ALL = 0, COARSE = 1, REFINED = 2;
uniform int set;
uniform int lane_stride;
uniform uint most_pairs;
uniform float share_limit;   // paths below this share of their light end
uniform float ledger_unit;   // W

layout(std430, binding = BINDING_PHOTONS) readonly buffer Photons {
  uint photon_count, groups_x, groups_y, groups_z;
  uint draw[4];
  Photon photon_at[];
};

#include "photon_nodes.glsl"

shared uint book[5], unbook[5];

// A landing of the photon at lane's wavelength, in the path's slot; wall: as in exit_wall.glsl.
void keep_landing(uint photon, int order, int lane, vec3 at, float flux, uint path, float way, vec4 wall) {
  uint listed = photon * SLOTS + order, index = listed * lane_stride + lane;
  landing[LANDING_TEXELS * index] = vec4(at, flux);
  landing[LANDING_TEXELS * index + 1u] = wall;
  path_mark[listed] = 1u;
#ifdef TINTING
  signature[index] = uvec2(path, floatBitsToUint(way));
#else
  signature[index] = path;
#endif
}

#include "photon_path.glsl"

void main() {
  if (gl_LocalInvocationID.x < 5u) {
    book[gl_LocalInvocationID.x] = 0u;
    unbook[gl_LocalInvocationID.x] = 0u;
  }
  barrier();
  // A photon's wavelengths side by side: they take the same ways for longer than its neighbours.
  uint id = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
            gl_LocalInvocationID.x;
  uint item = id / uint(lane_count), photon = item;
  int lane = int(id % uint(lane_count));
  bool there = item < (set == REFINED ? min(pair_count, most_pairs) : photon_count);
  int i = set == COARSE ? coarse_node(lane) : lane_first + lane;
  int low = -1, high = -1;  // ends of the interval
  int interval = 0;
  if (set == REFINED && there) {
    uint pair = pair_at[item];
    interval = int(pair % PAIR_INTERVALS);
    photon = pair / PAIR_INTERVALS;
    low = coarse_node(interval);
    high = coarse_node(interval + 1);
    i = low + lane;
    there = i <= high;
  }
  if (there) {
    Photon from = photon_at[photon];
    vec2 cell = vec2(from.cell & 0xffffu, from.cell >> 16);
    vec2 uv = (cell + 0.5 + unpackSnorm2x16(from.offset)) / vec2(grid);
    vec3 o, d;
    Hit front;
    float flux;
    bool reached = photon_start(uv, o, d, front, flux);
    flux = from.flux;
#ifdef TINTING
    int row = light * REFRACTORS + (reached ? front.refractor : 0);
    int node = set == COARSE ? row * NODES + lane : all_bands(row) + i;
    // A refined interval's ends give back halves of coarse bands; their own outer ones are not its.
    int coarse_a = row * NODES + interval;
    load_halves(i == low ? 2 * coarse_a + 1 : 2 * node, i == high ? 2 * (coarse_a + 1) : 2 * node + 1);
#endif
    Shares entry[5];
    trace(item, lane, i, flux, o, d, front, reached, entry);
    // A refined interval's ends give back what the coarse set entered for it.
    vec4 weight = sample_weight[light * WAVELENGTHS + i];
    float below = set == COARSE ? weight.z : i == low ? 0.0 : weight.x;
    float above = set == COARSE ? weight.w : i == high ? 0.0 : weight.y;
    float back = i == low ? weight.w : i == high ? weight.z : 0.0;
    float scale = flux / ledger_unit;
    for (int k = 0; k < 5; k++) {
      vec2 part = vec2(entry[k]);
      if (max(part.x, part.y) <= 0.0 || i < ledger_first) continue;
      atomicAdd(book[k], uint(part.x * (below * scale) + 0.5) + uint(part.y * (above * scale) + 0.5));
      if (back > 0.0) atomicAdd(unbook[k], uint((i == low ? part.x : part.y) * (back * scale) + 0.5));
    }
  }
  barrier();
  if (gl_LocalInvocationID.x < 5u) {
    uint k = gl_LocalInvocationID.x;
    WIDE_ADD(ledger, 2u * k, 2u * k + 1u, book[k])
    WIDE_SUBTRACT(ledger, 2u * k, 2u * k + 1u, unbook[k])
  }
}
