// Follows photons, each thread one photon at one wavelength, along the paths of photon_path.glsl. Keeps
// their hits, and enters in the ledger what becomes of their light otherwise.
layout(local_size_x = 256) in;
#define COPIES_TABLES
#include "refractor.glsl"
#include "wide_sum.glsl"
#include "thread.glsl"
#include "receiver.glsl"
#include "outgoing_segment.glsl"
#include "photons.glsl"
#include "photon_nodes.glsl"
#include "pair_list.glsl"
#include "tints.glsl"

// [((item * slots + slot) * hit_stride + sample) * HIT_TEXELS], item: the photon, or where its interval
// stands on the list of refined ones; sample: its wavelength in this batch, the coarse set or the interval.
// xyz: where it lands, and w: flux for unit weight and power; then where it left its last refractor, and w:
// interface_word(). While tiles are chosen: chart coordinates, and the chart's side.
layout(std430, binding = BINDING_HITS) writeonly buffer Hits { vec4 hits[]; };
// Receiver, facets along the path and whether on a tile, equal for paths that vary continuously;
// refractor in the low eight bits; 0: no hit. TINTS: and those (tints.glsl).
layout(std430, binding = BINDING_SIGNATURES) writeonly buffer Signatures { Signature signature[]; };
// Y weight of the samples at [light * wavelengths + i]: of the parts of their bands below and above
// the node, then those in the coarse set.
layout(std430, binding = BINDING_SAMPLE_WEIGHTS) readonly buffer SampleWeights { vec4 sample_weight[]; };
// [item * slots + slot]: 1 where there is a hit at some wavelength.
layout(std430, binding = BINDING_PATH_MARKS) writeonly buffer PathMarks { uint path_mark[]; };
// Sums of reached, reflected, absorbed, trapped and missed, in ledger_unit: low and high word of
// the sum.
layout(std430, binding = BINDING_LEDGER) buffer Ledger { uint ledger[]; };

#include "pass_light.glsl"
uniform ivec2 grid;
#include "photon_start.glsl"
uniform int sample_first;  // ALL: the first wavelength of this batch; else 0
uniform int sample_count;  // samples of an item: of the batch, of the coarse set, or of the widest interval
uniform int ledger_first;  // wavelengths before this one are in the ledger already
// ALL: consecutive wavelengths of all photons; COARSE: of all photons those few that every photon takes;
// REFINED: all wavelengths of the intervals on the list, with both ends, which are of the coarse set.
const int ALL = 0, COARSE = 1, REFINED = 2;
uniform int set;
bool is_set(int which) { return of_dispatch(set) == which; }
uniform int hit_stride;     // capacity for samples
uniform uint most_pairs;    // capacity of the list of intervals
uniform float share_limit;   // paths below this share of their light end
uniform float ledger_unit;   // W

shared uint more_sum[5], less_sum[5];

#include "photon_path.glsl"

void keep_hit(PhotonRay photon, PhotonHit hit) {
  uint path = photon.item * counts.slots + hit.slot, index = path * hit_stride + photon.sample_number;
  hits[HIT_TEXELS * index] = vec4(hit.place, hit.flux);
  hits[HIT_TEXELS * index + 1u] = hit.interface_at;
  path_mark[path] = 1u;
#ifdef TINTS
  signature[index] = pack_signature(hit.signature, hit.tints);
#else
  signature[index] = hit.signature;
#endif
}

// What a thread traces: a photon at one wavelength. Of a refined interval, low and high are its ends.
struct Task {
  bool there;
  uint item, photon;
  int sample_number, wavelength;
  int interval, low, high;  // low and high are -1 where there is no interval
};

Task task_of(uint thread) {
  Task t;
  // A photon's wavelengths side by side: they take the same paths for longer than its neighbours.
  t.item = t.photon = thread / uint(sample_count);
  t.sample_number = int(thread % uint(sample_count));
  t.there = t.item < (is_set(REFINED) ? min(pair_count, most_pairs) : photon_count);
  t.wavelength = is_set(COARSE) ? coarse_node(t.sample_number) : sample_first + t.sample_number;
  t.interval = 0;
  t.low = t.high = -1;
  if (is_set(REFINED) && t.there) {
    uint pair = pair_at[t.item];
    t.interval = int(pair % PAIR_INTERVALS);
    t.photon = pair / PAIR_INTERVALS;
    t.low = coarse_node(t.interval);
    t.high = coarse_node(t.interval + 1);
    t.wavelength = t.low + t.sample_number;
    t.there = t.wavelength <= t.high;
  }
  return t;
}

PhotonRay ray_of(Task t) {
  Photon from = photon_at[t.photon];
  vec2 cell = vec2(from.cell & 0xffffu, from.cell >> 16);
  vec2 uv = (cell + 0.5 + unpackSnorm2x16(from.offset)) / vec2(grid);
  PhotonRay ray;
  float flux;
  ray.reached = photon_start(uv, ray.o, ray.d, ray.front, flux);
  ray.flux = from.flux;
#ifdef CRYSTALS
  path_place = floor(0.5 * cell);  // each has neighbours on its path
#endif
  ray.item = t.item;
  ray.sample_number = t.sample_number;
  ray.wavelength = t.wavelength;
  return ray;
}

#ifdef TINTS
// One half of the band of an interval's end lies in the interval. In place of the other stands the
// half of the coarse band that covered the interval, which enter() takes back.
void load_attenuation(Task t) {
  bool at_low = t.wavelength == t.low, at_high = t.wavelength == t.high;
  int all = counts.nodes == counts.wavelengths ? 0 : counts.nodes;
  int node = is_set(COARSE) ? t.sample_number : all + t.wavelength;
  below_texel = TINT_TEXELS * PART_SURFACES * (at_low ? t.interval : node);
  above_texel = TINT_TEXELS * PART_SURFACES * (at_high ? t.interval + 1 : node);
  below_is_above = at_low;
  above_is_below = at_high;
}
#endif

// The coarse set entered light for the refined interval, too: its ends take that back.
void enter(Task t, float flux, Shares entry[5]) {
  vec4 weight = sample_weight[light * counts.wavelengths + t.wavelength];
  bool at_low = t.wavelength == t.low, at_high = t.wavelength == t.high;
  float below = is_set(COARSE) ? weight.z : at_low ? 0.0 : weight.x;
  float above = is_set(COARSE) ? weight.w : at_high ? 0.0 : weight.y;
  float back = at_low ? weight.w : at_high ? weight.z : 0.0;
  float scale = flux / ledger_unit;
  for (int k = 0; k < 5; k++) {
    vec2 part = vec2(entry[k]);
    if (max(part.x, part.y) <= 0.0 || t.wavelength < ledger_first) continue;
    atomicAdd(more_sum[k], uint(part.x * (below * scale) + 0.5) + uint(part.y * (above * scale) + 0.5));
    if (back > 0.0) atomicAdd(less_sum[k], uint((at_low ? part.x : part.y) * (back * scale) + 0.5));
  }
}

void main() {
  if (gl_LocalInvocationID.x < 5u) {
    more_sum[gl_LocalInvocationID.x] = 0u;
    less_sum[gl_LocalInvocationID.x] = 0u;
  }
  barrier();
  copy_tables();
  copy_surroundings();
  copy_light();
  Task task = task_of(thread_number());
  if (task.there) {
    PhotonRay ray = ray_of(task);
#ifdef TINTS
    load_attenuation(task);
#endif
    Shares entry[5];
    trace(ray, entry);
    enter(task, ray.flux, entry);
  }
  barrier();
  if (gl_LocalInvocationID.x < 5u) {
    uint k = gl_LocalInvocationID.x;
    WIDE_ADD(ledger, 2u * k, 2u * k + 1u, more_sum[k])
    WIDE_SUBTRACT(ledger, 2u * k, 2u * k + 1u, less_sum[k])
  }
}
