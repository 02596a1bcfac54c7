// Lists the beams of a batch of path segments in one medium: the light of a photon there, as wide as its neighbours on the
// same path stand apart, and as the wavelengths do between which it lies.
// Wavelengths that part by less than shows are one beam; an interval of others is several, each in the colour of
// its own part of the band. Beams are listed as they lie in the picture (beam.glsl); IN_WORLD: as they lie in a
// refractor's medium, to be added to its grid.
layout(local_size_x = 256) in;
#include "common.glsl"
#include "thread.glsl"
#include "photons.glsl"
#include "path_list.glsl"
#include "haze.glsl"
#include "beam.glsl"
#include "tints.glsl"
layout(std430, binding = BINDING_PHOTON_OF_CELL) readonly buffer Slots { uint slot[]; };
layout(std430, binding = BINDING_SPLATS) buffer Beams {
  uint beam_count, beam_groups[3];
  vec4 beam[];
};
uniform samplerBuffer hits;          // [photons][slots][stride] of two (outgoing_segment.glsl)
uniform usamplerBuffer signatures;   // 0: no hit; TINTS: and those
uniform samplerBuffer beam_colours;  // [light views][intervals][PARTS] of unit power, in the picture's space
uniform samplerBuffer beam_haze;     // [intervals][PARTS] what the medium takes there, and of that what it scatters, 1/m
#ifdef TINTS
uniform samplerBuffer beam_tints;  // [refractors][intervals][PARTS] by amount
uniform int medium_tint;           // the medium's; -1: it has none
#endif
uniform int light, stride, sample_count, sample_first;
uniform ivec2 grid;
uniform uint chunks, chunk;  // only photons of this chunk
uniform uint most;           // capacity of the list of beams
uniform int medium;          // the refractor that they are in; -1: the air
#ifdef IN_WORLD
uniform float cell_m;  // side of the grid's cells
#else
uniform vec3 eye;
uniform vec4 eye_view[6];
uniform vec2 size;  // pixels
#endif

const int PARTS = 8;        // parts of an interval
const float NARROW = 0.35;                 // share of the photons' distance: what wavelengths may part by unseen

const float SMALL_ANGLE = 0.12;            // rad, that a cell's side is seen under at the most
const int MOST_SPLITS = 8;

// A path at a wavelength.
struct Node {
  uint path;   // signature; 0: no hit
  vec3 from, to;
  float light;  // W where it begins, of unit power; TINTS: without what these absorbed before
#ifdef TINTS
  Tints tints;  // that it has passed where it ends in its medium, or begins in the air
#endif
};

Node no_node() {
  Node n;
  n.path = 0u;
  n.from = n.to = vec3(0);
  n.light = 0.0;
#ifdef TINTS
  n.tints = no_tints();
#endif
  return n;
}

Node node_at(uint path, int i) {
  int hit = int(path) * stride + i;
  vec4 landed = texelFetch(hits, 2 * hit);
  Node n;
  uvec4 signature = texelFetch(signatures, hit);
  vec4 left = texelFetch(hits, 2 * hit + 1);
  n.path = landed.w > 0.0 && int(left.w) == medium ? signature.x : 0u;
  n.from = left.xyz;
  n.to = landed.xyz;
  float per_m = spectra[(medium < 0 ? REFRACTORS : medium) * counts.wavelengths + sample_first + i].y;
  float grows = exp(min(per_m * distance(n.from, n.to), 80.0));
#ifdef TINTS
  n.tints = tints_of(signature);
  n.light = landed.w * (medium < 0 || !has_tint(n.tints, medium_tint) ? grows : 1.0);
#else
  n.light = landed.w * grows;
#endif
  return n;
}

int interval_of(int interval) { return clamp(interval, 0, max(counts.wavelengths - 2, 0)); }

vec3 colour_of(int interval, int part) {
  int intervals = max(counts.wavelengths - 1, 1);
  return texelFetch(beam_colours, (light * intervals + interval_of(interval)) * PARTS + part).rgb;
}

// The light of an interval's part that is left where it begins, in a medium that takes so much of
// it.
float left_in(Node a, Node b, int interval, int k, float per_m) {
#ifdef TINTS
  bool own = medium >= 0 && has_tint(a.tints, medium_tint);
  float depth = own ? -per_m * distance(a.from, a.to) : 0.0;
  Tints t = tints_between(a.tints, b.tints, (float(k) + 0.5) / float(PARTS));
  for (int i = 0; i < TINTS; i++) {
    int row = t.of[i] * max(counts.wavelengths - 1, 1) + interval_of(interval);
    depth += t.amount[i] * texelFetch(beam_tints, row * PARTS + k).x;
  }
  return exp(-max(depth, 0.0));
#else
  return 1.0;
#endif
}

// What is scattered, W/m, of the parts [from, to) of an interval between two nodes, after so many metres in the medium.
vec3 scattered_after(Node a, Node b, int interval, int from, int to, float metres) {
  vec3 sum = vec3(0);
  for (int k = from; k < to; k++) {
    vec2 haze = texelFetch(beam_haze, interval_of(interval) * PARTS + k).xy;
    float light_w = mix(a.light, b.light, (float(k) + 0.5) / float(PARTS)) * left_in(a, b, interval, k, haze.x);
    sum += colour_of(interval, k) * (light_w * haze.y * exp(-haze.x * metres));
  }
  return sum;
}

// What two rays differ by, at both ends.
struct Apart {
  vec3 from, to;
};

// To the neighbour on the same path, as if the two started a cell apart; zero if there is none.
Apart step_to(ivec2 cell, ivec2 to, vec2 start, int order, int i, Node n) {
  ivec2 c = cell + to;
  bool there = all(greaterThanEqual(c, ivec2(0))) && all(lessThan(c, grid));
  uint at = slot[there ? c.y * grid.x + c.x : 0];
  there = there && at != 0u;
  uint other = there ? at - 1u : 0u;
  int hit = int(other * uint(counts.slots) + uint(order)) * stride + i;
  there = there && texelFetch(signatures, hit).x == n.path;
  vec2 between = vec2(to) + unpackSnorm2x16(photon_at[other].offset) - start;
  float part = there ? 1.0 / max(dot(between, vec2(to)), 0.25) : 0.0;
  return Apart(part * (texelFetch(hits, 2 * hit + 1).xyz - n.from), part * (texelFetch(hits, 2 * hit).xyz - n.to));
}

bool is_none(Apart a) { return a.from == vec3(0) && a.to == vec3(0); }

// A cell's side: the mean of the steps to both neighbours, where both are.
Apart side_of(Apart next, Apart last, float extent) {
  float share = is_none(next) || is_none(last) ? extent : 0.5 * extent;
  return Apart(share * (next.from - last.from), share * (next.to - last.to));
}

struct Cell {
  Apart u, v;
};

// A side without neighbours is as the other, square to it.
Cell cell_of(Photon photon, int order, int i, Node n) {
  ivec2 at = ivec2(photon.cell & 0xffffu, photon.cell >> 16);
  vec2 start = unpackSnorm2x16(photon.offset), extent = unpackUnorm2x16(photon.extent);
  Apart step[4];
  for (int k = 0; k < 4; k++) {
    int on = 1 - (k & 2);
    step[k] = step_to(at, (k & 1) == 0 ? ivec2(on, 0) : ivec2(0, on), start, order, i, n);
  }
  Cell c = Cell(side_of(step[0], step[2], extent.x), side_of(step[1], step[3], extent.y));
  vec3 way = normalize(n.to - n.from);
  bool no_u = is_none(c.u), no_v = is_none(c.v);
  if (no_u) c.u = Apart(cross(way, c.v.from), cross(way, c.v.to));
  if (no_v) c.v = Apart(cross(way, c.u.from), cross(way, c.u.to));
  return c;
}

// Light that goes along one segment.
struct Stretch {
  vec3 from, to;
  Apart parts;       // parts of its spectrum
  vec2 metres;       // along the light's path from the segment's start to the camera, and what is scattered, W/m,
  vec3 first, last;  // after these
};

// What red, green and blue lose a metre, as far as it can be found: negative parts of colours may cross zero.
vec3 losses_of(Stretch w) {
  float whole = dot(w.first, vec3(1)) / dot(w.last, vec3(1));
  vec3 lost;
  for (int k = 0; k < 3; k++) {
    bool told = w.first[k] * w.last[k] > 0.0;
    lost[k] = log(max(told ? w.first[k] / w.last[k] : whole, 1.0)) / max(w.metres.y - w.metres.x, 1e-30);
  }
  return lost;
}

// At its end, by these.
vec3 scattered_at_end(Stretch w, vec3 losses) {
  return w.last * exp(min(losses * (w.metres.y - distance(w.from, w.to)), vec3(80)));
}

// The least and the most distance that light has in the medium from the start of a photon's segment to the camera:
// the losses of a mixture are found by it. In the grid it ends with the photon's own.
vec2 metres_seen(Node n);

#ifdef IN_WORLD
vec2 metres_seen(Node n) { return vec2(0, max(distance(n.from, n.to), 1e-9)); }

int splits(Stretch w, Cell cell) { return 1; }

// How far rays part, beyond what the grid resolves.
float parting(Node at, Apart a, Cell cell) {
  float from = max(NARROW * max(length(cell.u.from), length(cell.v.from)), cell_m);
  float to = max(NARROW * max(length(cell.u.to), length(cell.v.to)), cell_m);
  return max(length(a.from) / from, length(a.to) / to);
}

// Its ends, and a cell's sides at both, each with a part of the light at its end and of what it loses.
void list_beam(Stretch w, Cell cell) {
  vec3 grows = losses_of(w), last = scattered_at_end(w, grows);
  uint at = atomicAdd(beam_count, 1u);
  if (at >= most) return;
  at *= uint(BEAM_TEXELS);
  beam[at] = vec4(w.from, last.r);
  beam[at + 1u] = vec4(w.to, last.g);
  beam[at + 2u] = vec4(cell.u.from, last.b);
  beam[at + 3u] = vec4(cell.u.to, grows.r);
  beam[at + 4u] = vec4(cell.v.from, grows.g);
  beam[at + 5u] = vec4(cell.v.to, grows.b);
}
#else
// A segment in the picture, as far as it is before the camera.
struct Line {
  bool seen;
  vec3 from, to;
  vec2 part;  // where in the whole it begins and ends
  vec2 place[2];
  vec2 depth;
  vec2 normal;   // across it
  float offset;  // pixels from the picture's axis to it
};

float metres_to_eye(vec3 p) {
  float distance_m = distance(eye, p), first;
  return medium < 0 ? haze_way(eye, (p - eye) / max(distance_m, 1e-30), 0.0, distance_m, first) : distance_m;
}

vec2 metres_seen(Node n) {
  float a = metres_to_eye(n.from), b = distance(n.from, n.to) + metres_to_eye(n.to), most = max(max(a, b), 1e-9);
  return vec2(min(min(a, b), 0.5 * most), most);
}

vec2 per_tangent() { return size / (eye_view[4].yw - eye_view[4].xz); }

vec2 beside_axis(vec3 p) { return vec2(dot(p, eye_view[1].xyz), dot(p, eye_view[2].xyz)); }

Line line_of(vec3 from, vec3 to) {
  Line l;
  float near = eye_view[5].x, a = dot(from - eye, eye_view[3].xyz), b = dot(to - eye, eye_view[3].xyz);
  float cut = clamp((near - a) / (b == a ? 1e-20 : b - a), 0.0, 1.0);
  l.seen = max(a, b) > near && distance(from, to) > 0.0;
  l.part = vec2(a < near ? cut : 0.0, b < near ? cut : 1.0);
  l.from = mix(from, to, l.part.x);
  l.to = mix(from, to, l.part.y);
  l.depth = max(mix(vec2(a), vec2(b), l.part), vec2(near));
  vec2 p = beside_axis(l.from - eye) / l.depth.x, q = beside_axis(l.to - eye) / l.depth.y;
  vec2 along = (q - p) * per_tangent();
  float pixels = length(along);
  vec2 way = pixels > 1e-3 ? along / pixels : vec2(1, 0);
  l.normal = vec2(-way.y, way.x);
  l.offset = dot(l.normal, p * per_tangent());
  l.place[0] = (p - eye_view[4].xz) * per_tangent();
  l.place[1] = (q - eye_view[4].xz) * per_tangent();
  // Towards the camera it is a pixel long.
  vec2 lacking = 0.5 * max(1.0 - pixels, 0.0) * way;
  l.place[0] -= lacking;
  l.place[1] += lacking;
  return l;
}

// Pixels across the line at both its ends.
vec2 widths_of(Line l, Apart a) {
  vec3 first = mix(a.from, a.to, l.part.x), last = mix(a.from, a.to, l.part.y);
  vec2 way = l.normal * per_tangent();
  return vec2(dot(way, beside_axis(first)) - l.offset * dot(first, eye_view[3].xyz),
              dot(way, beside_axis(last)) - l.offset * dot(last, eye_view[3].xyz)) /
         l.depth;
}

// How far rays part, in what is not seen.
float parting(Node at, Apart a, Cell cell) {
  Line l = line_of(at.from, at.to);
  vec2 w = abs(widths_of(l, a)), u = abs(widths_of(l, cell.u)), v = abs(widths_of(l, cell.v));
  vec2 unseen = max(NARROW * max(u, v), vec2(1));
  return max(w.x / unseen.x, w.y / unseen.y);
}

// Into how many parts a side a cell is split: near the camera it is more than a width in the picture.
int splits(Stretch w, Cell cell) {
  Line l = line_of(w.from, w.to);
  vec2 widest = max(abs(widths_of(l, cell.u)), abs(widths_of(l, cell.v)));
  return clamp(int(ceil(max(widest.x, widest.y) / (SMALL_ANGLE * per_tangent().y))), 1, MOST_SPLITS);
}

void list_beam(Stretch w, Cell cell) {
  Line line = line_of(w.from, w.to);
  vec2 u = widths_of(line, cell.u), v = widths_of(line, cell.v), s = widths_of(line, w.parts);
  float length_m = distance(w.from, w.to);
  vec3 grows = losses_of(w);
  vec3 light_there = scattered_at_end(w, grows) * exp(grows * (1.0 - line.part.y) * length_m);
  float reach = max(beam_reach(vec3(u.x, v.x, s.x)), beam_reach(vec3(u.y, v.y, s.y)));
  vec2 low = min(line.place[0], line.place[1]) - reach, high = max(line.place[0], line.place[1]) + reach;
  bool shown = line.seen && all(lessThan(low, size)) && all(greaterThan(high, vec2(0)));
  if (!shown) return;
  uint at = atomicAdd(beam_count, 1u);
  if (at >= most) return;
  at *= uint(BEAM_TEXELS);
  beam[at] = vec4(line.place[0], line.place[1]);
  beam[at + 1u] = vec4(line.depth, u);
  beam[at + 2u] = vec4(v, s);
  beam[at + 3u] = vec4(line.from, light_there.r);
  beam[at + 4u] = vec4(line.to, light_there.g);
  beam[at + 5u] = vec4(grows, light_there.b);
}
#endif

Apart part_of(Apart a, float share) { return Apart(share * a.from, share * a.to); }

void list_splits(Stretch w, Cell cell) {
  int n = splits(w, cell);
  float part = 1.0 / float(n);
  Cell small = Cell(part_of(cell.u, part), part_of(cell.v, part));
  for (int k = 0; k < n * n; k++) {
    float u = float(k % n) - 0.5 * float(n - 1), v = float(k / n) - 0.5 * float(n - 1), share = part * part;
    list_beam(Stretch(w.from + u * small.u.from + v * small.v.from, w.to + u * small.u.to + v * small.v.to, w.parts,
                      w.metres, share * w.first, share * w.last),
              small);
  }
}

// Wavelengths that are one beam: where the first and the last go, the mean direction, and their light.
struct Run {
  Node first, last;
  vec3 from, to;
  float weight;
  vec2 metres;
  vec3 light_first, light_last;
};

Run run_from(Node n) { return Run(n, n, vec3(0), vec3(0), 0.0, metres_seen(n), vec3(0), vec3(0)); }

// Parts of an interval between two nodes, or beside one.
void add(inout Run r, Node a, Node b, int interval, int first, int end) {
  vec3 light_first = scattered_after(a, b, interval, first, end, r.metres.x);
  float weight = max(dot(light_first, vec3(1)), 1e-9 * (a.light + b.light));
  r.from += weight * 0.5 * (a.from + b.from);
  r.to += weight * 0.5 * (a.to + b.to);
  r.weight += weight;
  r.light_first += light_first;
  r.light_last += scattered_after(a, b, interval, first, end, r.metres.y);
  r.last = b;
}

Stretch way_of_run(Run r) {
  float w = 1.0 / max(r.weight, 1e-30);
  return Stretch(w * r.from, w * r.to, Apart(r.last.from - r.first.from, r.last.to - r.first.to), r.metres,
                 r.light_first, r.light_last);
}

// Part k of so many between two nodes.
Stretch way_of_part(Node a, Node b, int interval, int k, int parts) {
  float share = 1.0 / float(parts), t = (float(k) + 0.5) * share;
  int first = k * PARTS / parts, end = (k + 1) * PARTS / parts;
  Stretch w;
  w.from = mix(a.from, b.from, t);
  w.to = mix(a.to, b.to, t);
  w.parts = Apart(share * (b.from - a.from), share * (b.to - a.to));
  w.metres = metres_seen(a);
  w.first = scattered_after(a, b, interval, first, end, w.metres.x);
  w.last = scattered_after(a, b, interval, first, end, w.metres.y);
  return w;
}

// A power of two.
int parts_for(float parted) { return min(1 << int(ceil(log2(max(parted, 1.0)))), PARTS); }

void list_path(uint path, Photon photon) {
  int order = int(path % uint(counts.slots)), samples = of_dispatch(sample_count);
  Node a = no_node(), b;
  Cell cell, before;
  Run run = run_from(a), done;
  for (int i = 0; i <= samples; i++) {
    b = node_at(path, min(i, samples - 1));
    if (i == samples) b = no_node();
    bool joined = a.path != 0u && a.path == b.path, within = i > 0 && i < samples;
    int interval = sample_first + i - 1, parts = 0;
    float parted = joined ? parting(a, Apart(b.from - a.from, b.to - a.to), cell) : 0.0;
    bool one = joined && parted <= 1.0;
    bool ends = !one || parting(a, Apart(b.from - run.first.from, b.to - run.first.to), cell) > 1.0;
    if (!joined && within && a.path != 0u) add(run, a, a, interval, 0, PARTS / 2);
    done = run;
    before = cell;
    if (ends) run = run_from(one ? a : b);
    if (one) add(run, a, b, interval, 0, PARTS);
    if (joined && !one) parts = parts_for(parted);
    if (!joined && b.path != 0u) {
      cell = cell_of(photon, order, i, b);
      bool alone = counts.wavelengths == 1;
      if (within || alone) add(run, b, b, interval, alone ? 0 : PARTS / 2, PARTS);
    }
    for (int k = ends && done.weight > 0.0 ? -1 : 0; k < parts; k++) {
      Stretch w;
      if (k < 0)
        w = way_of_run(done);
      else
        w = way_of_part(a, b, interval, k, parts);
      list_splits(w, before);
    }
    a = b;
  }
}

void main() {
  uint listed = thread_number();
  if (listed >= path_count) return;
  uint path = path_list[listed];
  Photon photon = photon_at[path / uint(counts.slots)];
  if (photon.cell * 2654435761u % chunks == chunk) list_path(path, photon);
}
