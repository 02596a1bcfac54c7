// From hits to splats of light for the spectral map. Between two neighbouring wavelengths of one
// path the light is laid where the index between theirs sends it (outgoing_segment.glsl), each splat with the
// colour of its own part of the band. Where the paths differ each wavelength keeps its half of the band.
// Intervals go from long waves to short ones: in short waves the index changes fastest, and there two
// intervals before give the curve. Splats closer together than photons are added first; X, Y and Z have
// each a place of their own, or dispersion narrower than that would be lost. A splat is spread over the
// parallelogram that the neighbouring photons' hits span: where that is wide, in a coarser level of
// the map. fine_nodes: the intervals on the list, by all their wavelengths; 0: those of the coarse set that
// are not on it. No branch saves time on a software rasteriser, so there are few.
layout(local_size_x = 256) in;
#include "common.glsl"
#include "photon_nodes.glsl"
#include "splat_list.glsl"
#include "optics.glsl"
#include "wide_sum.glsl"
#include "thread.glsl"
#include "photons.glsl"
#include "path_list.glsl"
#include "pair_list.glsl"
#define FOLLOWS_SEGMENTS
#include "outgoing_segment.glsl"

layout(std430, binding = BINDING_PHOTON_OF_CELL) readonly buffer Slots { uint slot[]; };
// As textures: a software rasteriser fetches a texel in one load, and storage number by number.
uniform samplerBuffer hits;     // HIT_TEXELS each
uniform usamplerBuffer signatures;  // 0: none; TINTS: and those
// The same of the intervals on the list; of the coarse set again where that is laid.
uniform samplerBuffer node_hits;
uniform usamplerBuffer node_signatures;
uniform int fine_nodes;  // wavelengths of an interval on the list
layout(std430, binding = BINDING_WANTS) readonly buffer Wants { uint want[]; };  // a bit a refined interval
// lo and hi of each, as in photon_path.glsl and behind them what is interpolated.
layout(std430, binding = BINDING_LEDGER) buffer Ledger { uint ledger[]; };
uniform float ledger_unit;  // W
shared uint more_sum[3], less_sum[3];
const uint ABSORBED = 2u, MISSED = 4u, INTERPOLATED = 5u;
#include "pass_light.glsl"
uniform ivec2 grid;
uniform int map_size;
uniform int sample_first;
uniform int sample_count;
uniform int interval_first;
uniform int interval_end;
uniform int nodes;  // nodes of the set whose hits these are
uniform int table_first;
uniform uint chunks, chunk;  // only paths of this chunk
uniform uint most;           // capacity of the list of splats

// A path whose light this thread lays.
struct Path {
  uint photon;
  int order;
  int node_first, node_last;  // those that it is known at
  int hit_first;              // node_hits of the first of them
  int coarse_first;           // `hits` at the first coarse node
  int middle_twice;           // twice the coarse node in their middle
  int interval_last, intervals;
  uint refined;    // intervals that are laid by another pass, a bit each
  uint signature;  // at a node where it hits something; 0: it never does
};

#include "map_position.glsl"
#include "photon_footprint.glsl"
#include "splat_collect.glsl"
#include "interval_table.glsl"
#include "tints.glsl"
#include "path_node.glsl"
#include "interval_span.glsl"
#include "span_light.glsl"

Path refined_path_at(uint listed) {
  uint pair = pair_at[listed / counts.slots];
  int interval = int(pair % PAIR_INTERVALS);
  Path p;
  p.photon = pair / PAIR_INTERVALS;
  p.order = int(listed % counts.slots);
  p.node_first = coarse_node(interval);
  p.node_last = coarse_node(interval + 1);
  p.hit_first = int(listed) * fine_nodes;
  p.coarse_first = int((p.photon * counts.slots + uint(p.order)) * counts.hit_stride);
  p.middle_twice = 2 * interval + 1;
  p.interval_last = p.node_last;
  p.intervals = p.node_last - p.node_first;
  p.refined = 0u;
  return p;
}

Path coarse_path_at(uint listed) {
  Path p;
  p.photon = listed / counts.slots;
  p.order = int(listed % counts.slots);
  p.node_first = sample_first;
  p.node_last = sample_first + sample_count - 1;
  p.hit_first = p.coarse_first = int(listed * counts.hit_stride);
  p.middle_twice = sample_count;
  p.interval_last = interval_end - 1;
  p.intervals = interval_end - interval_first;
  p.refined = want[p.photon] << 1;
  return p;
}

Path path_at(uint listed) {
  Path p;
  if (fine_nodes > 0)
    p = refined_path_at(listed);
  else
    p = coarse_path_at(listed);
  return p;
}

// The hit nearest the middle among the wavelengths at which the path hits something. (A loop that
// ended early would do less, but Mesa 22's llvmpipe clobbers a load that is repeated after one.)
Reference reference_of(Path path) {
  Reference r;
  r.order = path.order;
  r.sample_number = 0;
  r.signature = 0u;
  for (int i = 0; i < sample_count; i++) {
    uint found = texelFetch(signatures, path.coarse_first + i).x;
    bool nearer = r.signature == 0u ||
                  abs(2 * i - path.middle_twice) < abs(2 * r.sample_number - path.middle_twice);
    if (found != 0u && nearer) {
      r.signature = found;
      r.sample_number = i;
    }
  }
  int at = HIT_TEXELS * (path.coarse_first + r.sample_number);
  r.tile = r.signature != 0u ? interface_tile(texelFetch(hits, at + 1).w) : NO_TILE;
  r.at = map_position(texelFetch(hits, at).xyz, r.tile);
  return r;
}

uint signature_of(Path path, Reference r) {
  uint signature = r.signature;
  for (int i = 0; i < fine_nodes; i++)
    signature = max(signature, texelFetch(node_signatures, path.hit_first + i).x);
  return signature;
}

Interval interval_at(Path path, int rows, int turn) {
  Interval i;
  i.number = path.interval_last - turn;
  i.last = turn == path.intervals;
  i.taken = !i.last && (path.refined >> uint(max(i.number, 0)) & 1u) == 0u;
  int node_b = i.number - 1;
  i.has_b = node_b >= path.node_first && node_b <= path.node_last && !i.last;
  i.hit_b = path.hit_first + (i.has_b ? node_b - path.node_first : 0);
  i.row = row_of(rows, i.number);
  i.index_b = sums_at(i.row, STEPS).index;
  return i;
}

// Lays the light of one path; returns what of it the ledger is to know (span_light.glsl).
vec3 deposit() {
  vec3 entry = vec3(0);
  uint listed = thread_number();
  if (listed >= path_count) return entry;
  Path path = path_at(path_list[listed]);
  Photon photon = photon_at[path.photon];
  if (photon.cell * 2654435761u % chunks != chunk) return entry;
  Reference reference = reference_of(path);
  Footprint footprint = footprint_of(photon, reference);
  path.signature = signature_of(path, reference);
  int rows = rows_of(path.signature), first_row = row_of(rows, path.interval_last);
  int hit_a = path.hit_first + path.interval_last - path.node_first;
  Trail trail = trail_from(node_at(hit_a, true, sums_at(first_row, 0).index, reference.at), first_row);
  Splat collected = no_splat();
  // The last turn lists what is collected.
  for (int turn = 0; turn <= path.intervals; turn++) {
    Interval i = interval_at(path, rows, turn);
    Node b = node_at(i.hit_b, i.has_b, i.index_b, trail.a.at);
    Span span = span_of(trail, path, i, b, exp2(float(footprint.level)));
    lay(span, i.last, footprint, collected, entry);
  }
  return entry;
}

void main() {
  if (gl_LocalInvocationID.x < 3u) {
    more_sum[gl_LocalInvocationID.x] = 0u;
    less_sum[gl_LocalInvocationID.x] = 0u;
  }
  barrier();
  copy_light();
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
