// A page of a receiver's side: what mirrors and refractors change there of the light of surroundings that
// nothing hides. A texel looks through each sample that it sees: light goes on from there by all interfaces, off
// mirrors and through refractors, until it is outside, where it comes from the surroundings, or at a receiver,
// which is dark; and what it would have seen were nothing there is taken away. So light that is alike all around
// changes nothing where nothing is absorbed, whatever the samples. A sample of area A weighs A cos cos / (d2 +
// A / pi), which is exact for a disk around the texel's axis; near ones are taken by their parts, far ones in
// clusters (scenes/samples/sample_tree.h). Texels are taken from coarse to fine: one in the midst of others that
// lie on a smooth line takes what lies between them.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
#define COPIES_TABLES
#include "refractor.glsl"
uniform vec4 refractor_bounds;
uniform float share_limit;
uniform mat3 rgb_from_xyz, xyz_from_rgb;
const float NEAR_AREAS = 6.0;  // samples nearer than the root of so many times their area are taken by parts
#include "receiver_hit.glsl"
#include "pinholes.glsl"
#include "pinhole_map.glsl"
// rgb; the next node of the tree that a texel takes, 0: it has not begun, DONE: none.
layout(rgba32f, binding = 0) uniform image2DArray pages;
const float DONE = -1.0;
layout(std430, binding = BINDING_UNFINISHED) buffer Unfinished { uint unfinished; };
uniform samplerBuffer pinhole_nodes;  // rows as gl/pinholes/pinhole_samples.h has them
uniform int node_count;
uniform int page, stride;  // texels are `stride` apart
uniform ivec2 first;       // and the first is there
uniform float cluster_share;  // of a hemisphere's light, that a cluster may send at the most; 0: there are none
uniform float smooth_share;   // of its light, by how much three texels may be off a line
uniform int most_shown;       // nodes that a thread takes at once
#ifdef PINHOLE_CHARTS
uniform samplerBuffer page_places;  // of texels of meshes' charts: place (w: 1, 0: there is none), normal
#endif
uniform float seen_off;  // m, that a ray may meet a sample's surface beside it

struct Band {  // as in refraction.comp
  vec4 weight_n;
  vec4 attenuation;
};
#ifdef BANDS_IN_STORAGE
layout(std430, binding = BINDING_BANDS) readonly buffer Bands { Band bands[]; };
#else
layout(std140, binding = BINDING_BANDS) uniform Bands { Band bands[BAND_ROOM]; };
#endif

// All wavelengths as one.
int joined_band(int r) { return (r * BAND_SETS + 1) * counts.bands - 1; }

vec2 refractor_spectrum(int r);
#include "walk.glsl"

vec2 refractor_spectrum(int r) {
  Band band = bands[joined_band(r)];
  return vec2(band.weight_n.w, band.attenuation.x);
}

#ifdef MIRRORS
vec3 mirror_spectrum(int r) { return bands[joined_band(r)].attenuation.yzw; }
#endif

#ifdef ROUGH
uniform float scene_size;
uniform float light_unit;  // W of the lights' unit
#include "rough_lamps.glsl"

// a, or what is as wide in its direction.
vec3 widened(vec3 a, vec3 other, float wide) {
  float is = length(a);
  return is >= wide ? a : is > 1e-6 ? a * (wide / is) : other * wide;
}
#endif

const int MOST_SEGMENTS = 24;
// Paths through a refractor fan out, and one stands for many: they show the surroundings blurred, rad.
const float FANNED_OUT = 0.35;

// What comes along the path backwards, rgb; by_u and by_v: by how much its last direction differs over its
// sample, where it was mirrored once.
vec3 carried(PathState w, Interface h, vec3 by_u, vec3 by_v) {
  PathState pending[PENDING];
  for (int k = 0; k < PENDING; k++) {
    pending[k] = w;
    pending[k].share = 0.0;
  }
  vec3 weight = bands[joined_band(h.hit.refractor)].weight_n.xyz, light = vec3(0), lamps = vec3(0);
  float followed = 0.0, left = 0.0, blurred = log2(FANNED_OUT * sky_side / CUBE_TEXEL);
  bool going = true, met = true, mirror = is_mirror(h.hit.refractor);
  for (int segment = 0; going && segment < MOST_SEGMENTS; segment++) {
    if (segment > 0) {
      h.hit.t = 1e30;
      met = next_interface(w, h);
    }
    float t_min = w.inside == 0u ? 1e-4 * refractor_bounds.w : 0.0;
    bool dark = segment > 0 && receiver_between(w.p, w.d, t_min, met ? h.hit.t : 1e30);
#ifdef ABSORBING
    if (w.inside != 0u && met) w.share *= exp(-h.hit.t * refractor_spectrum(medium_of(w.inside)).y);
#endif
    if (met && !dark) {
      float ended, dropped, absorbed;
#ifdef ROUGH
      // The first one's lamps are asked for once for all ways (rough_light).
      if (segment > 0 && is_rough(h.hit.refractor))
        lamps += w.share * light_unit * lobe_shows(w, h, vec2(0.5 * lobe_width));
#endif
      branch(w, h, 0.5 * share_limit, pending, ended, dropped, absorbed);
      left += ended + dropped;
    } else {
#ifdef ROUGH
      if (lobe_width > 0.0) {
        vec3 u = abs(w.d.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        u = normalize(cross(w.d, u));
        by_u = widened(by_u, u, lobe_width);
        by_v = widened(by_v, cross(w.d, u), lobe_width);
      }
#endif
      vec3 sky = mirror ? sky_over(w.d, by_u, by_v) : sky_at(w.d, max(blurred, 0.0));
      light += dark ? vec3(0) : w.share * sky;
      followed += w.share;
      w.share = 0.0;
    }
    if (w.share <= 0.0) w = take_pending(pending);
    going = w.share > 0.0;
  }
  left += w.share;
  for (int k = 0; k < PENDING; k++) left += pending[k].share;
  light *= followed > 0.0 ? 1.0 + left / followed : 0.0;
  light += lamps;
  return rgb_from_xyz * (weight * (xyz_from_rgb * light));
}

#ifdef ROUGH
// What a sample of a rough mirror shows: the surroundings by some of the lobe's ways, each as wide as the share
// that it stands for, and lamps, whose lobe is as much wider as the sample is.
vec3 rough_light(PathState w, Interface h, Pinhole s, int number, vec3 by_u, vec3 by_v) {
  vec3 sum = vec3(0), wider = vec3(0);
#ifdef FOOTPRINTS
  // Of even slopes of that half width, by GGX's measure: their standard deviation times the root of two.
  RoughHit m = rough_hit(w, h);
  float half_width = 0.8165 * s.half_width, near = 0.5 * half_width / max(distance(w.p, h.hit.p), 1e-20);
  vec2 along = abs(s.turn) * half_width;
  for (int k = 0; k < 2; k++) {
    vec3 axis = k == 0 ? m.x : m.y;
    float u = dot(axis, s.u), v = dot(axis, s.v);
    wider[k] = along.x * u * u + along.y * v * v + near;
  }
  // Lobes that are wider than samples are apart sum to what they should by themselves.
  wider.xy = sqrt(max(wider.xy * wider.xy - 0.25 * m.facets * m.facets, vec2(0)));
#endif
  float weight = 1.0 / float(LOBE_WAYS);
  vec3 of_lamps = light_unit * lobe_shows(w, h, wider.xy);
  vec3 band = bands[joined_band(h.hit.refractor)].weight_n.xyz;
  sum = rgb_from_xyz * (band * (xyz_from_rgb * of_lamps));
  for (int k = 0; k < LOBE_WAYS; k++) {
    lobe_u = lobe_way(k, 0.618034 * float(number));
    lobe_width = 0.0;
    sum += weight * carried(w, h, by_u, by_v);
  }
  lobe_width = 0.0;
  return sum;
}
#endif

// What a sample changes at p, where n is the receiver's side.
vec3 changed(vec3 p, vec3 n, Pinhole s, int number) {
  vec3 to = s.p - p;
  float far2 = dot(to, to), far = sqrt(far2);
  vec3 d = to / max(far, 1e-20);
  float weight = s.area * max(dot(n, d), 0.0) * max(-dot(s.n, d), 0.0) / (far2 + s.area / PI);
  if (weight <= 0.0) return vec3(0);
  PathState w = PathState(p, d, 1.0, 0u, 0u, -1, -1, -1);
  Interface h;
  h.hit.t = 1e30;
  bool met = next_interface(w, h);
  if (!met || abs(h.hit.t - far) > seen_off + 1e-4 * far) return vec3(0);
  if (receiver_between(p, d, 1e-4 * refractor_bounds.w, h.hit.t)) return vec3(0);
  vec3 by_u = vec3(0), by_v = vec3(0), wide_u = vec3(0), wide_v = vec3(0);
#ifdef FOOTPRINTS
  // Twice what half a spacing turns: samples meet in the middle.
  footprint(s, p, mirrored(p, s.p, s.n), by_u, by_v);
  by_u *= 2.0;
  by_v *= 2.0;
  vec3 u = 2.0 * s.half_width * s.u, v = 2.0 * s.half_width * s.v;
  wide_u = (u - dot(u, d) * d) / far;
  wide_v = (v - dot(v, d) * d) / far;
#endif
#ifdef ROUGH
  lobe_u = lobe_way(0, 0.618034 * float(number));
  lobe_width = 0.0;
  vec3 light = is_rough(h.hit.refractor) ? rough_light(w, h, s, number, by_u, by_v) : carried(w, h, by_u, by_v);
#else
  vec3 light = carried(w, h, by_u, by_v);
#endif
  return weight * (light - sky_over(d, wide_u, wide_v));
}

struct Node {
  vec3 p, n;
  float area, radius, cone;
  int next, of;  // of: the sample
  bool cluster, leaf;
};

Node node_at(int i) {
  vec4 place = texelFetch(pinhole_nodes, 3 * i), normal = texelFetch(pinhole_nodes, 3 * i + 1);
  vec4 rest = texelFetch(pinhole_nodes, 3 * i + 2);
  return Node(place.xyz, normal.xyz, place.w, normal.w, rest.x, int(rest.y), int(rest.z), rest.w > 0.0,
              int(rest.y) == i + 1);
}

// Whether nothing below it sends p any light: all lies behind the receiver's plane, or faces away.
bool is_hidden(Node k, vec3 n, vec3 to, float far) {
  float sine = k.radius / max(far, 1e-20), cosine = sqrt(max(1.0 - sine * sine, 0.0));
  float turn = sqrt(max(1.0 - k.cone * k.cone, 0.0));
  float facing = -dot(k.n, to) / max(far, 1e-20);
  bool narrow = sine < 1.0 && k.cone * cosine - turn * sine > 0.0;
  return dot(n, to) + k.radius <= 0.0 || (narrow && facing < -(turn * cosine + k.cone * sine) - 1e-4);
}

// Whether p takes it for all that is below it.
bool is_enough(Node k, vec3 n, vec3 to, float far) {
  float gap = max(far - k.radius, 0.0), up = min(dot(n, to) + k.radius, gap);
  bool faint = gap > 0.0 && k.area * up <= PI * cluster_share * gap * gap * gap;
  return k.leaf || (k.cluster ? faint && cluster_share > 0.0 : far * far >= NEAR_AREAS * k.area);
}

// As a sample: it turns as its own does, and shows as much more or less as its area is.
Pinhole pinhole_of(Node k, vec3 from) {
  Pinhole s = pinhole_at(k.of, from);
  s.half_width *= sqrt(k.area / max(s.area, 1e-30));
  s.area = k.area;
  s.p = k.p;
  s.n = dot(k.n, s.n) < 0.0 ? -k.n : k.n;
  return s;
}

// Where a texel is and which way it faces; false: nowhere.
bool place_of(ivec2 at, ivec2 size, out vec3 p, out vec3 n) {
  float side = page % 2 == 0 ? 1.0 : -1.0;
#ifdef PINHOLE_CHARTS
  if (page / 2 >= RECEIVERS) {
    int i = 2 * (((page / 2 - RECEIVERS) * size.y + at.y) * size.x + at.x);
    vec4 place = texelFetch(page_places, i);
    p = place.xyz;
    n = side * texelFetch(page_places, i + 1).xyz;
    return place.w > 0.0;
  }
#endif
  Receiver r = receivers[min(page / 2, RECEIVER_ROOM - 1)];
  vec2 t = (vec2(at) + 0.5) / vec2(size);
  n = side * r.normal.xyz;
  p = r.corner.xyz + from_page(page_axis(r.du.xyz, r.corner.xyz), t.x) * r.u.xyz +
      from_page(page_axis(r.dv.xyz, r.corner.xyz), t.y) * r.v.xyz;
  return true;
}

// Of four in a row the cubic's middle, and whether they lie on a line nearly: on no step either.
bool lies_between(ivec2 at, ivec2 step, vec3 open, out vec3 middle) {
  ivec2 size = imageSize(pages).xy, low = min(at - 3 * step, at + 3 * step), high = max(at - 3 * step, at + 3 * step);
  bool held = all(greaterThanEqual(low, ivec2(0))) && all(lessThan(high, size));
  vec3 a = imageLoad(pages, ivec3(at - 3 * step, page)).rgb, b = imageLoad(pages, ivec3(at - step, page)).rgb;
  vec3 c = imageLoad(pages, ivec3(at + step, page)).rgb, d = imageLoad(pages, ivec3(at + 3 * step, page)).rgb;
  vec3 bend = max(abs(a - 2.0 * b + c), abs(b - 2.0 * c + d)), most = 0.25 * (abs(a) + abs(b) + abs(c) + abs(d));
  middle = (9.0 * (b + c) - a - d) / 16.0;
  return held && all(lessThanEqual(bend, smooth_share * (most + open)));
}

// What is around over a hemisphere, in the mean.
vec3 open_light() {
  float top = log2(sky_side);
  vec3 sum = textureLod(pinhole_sky, vec3(1, 0, 0), top).rgb + textureLod(pinhole_sky, vec3(-1, 0, 0), top).rgb;
  sum += textureLod(pinhole_sky, vec3(0, 1, 0), top).rgb + textureLod(pinhole_sky, vec3(0, -1, 0), top).rgb;
  sum += textureLod(pinhole_sky, vec3(0, 0, 1), top).rgb + textureLod(pinhole_sky, vec3(0, 0, -1), top).rgb;
  return PI / 6.0 * sum;
}

// Whether others that are taken already tell it. first.x, first.y: half a stride off their rows, columns.
bool is_between(ivec2 at, out vec3 light) {
  vec3 other;
  ivec2 along = first.x > 0 && first.y > 0 ? first : first.x > 0 ? ivec2(first.x, 0) : ivec2(0, first.y);
  light = vec3(0);
  if (first == ivec2(0)) return false;
  vec3 open = open_light();
  if (!lies_between(at, along, open, light)) return false;
  if (first.x == 0 || first.y == 0) return true;
  bool both = lies_between(at, ivec2(along.x, -along.y), open, other);
  light = 0.5 * (light + other);
  return both;
}

const int MOST_MET = 1024;  // nodes that a thread looks at at once

void main() {
  copy_tables();
  ivec2 at = first + stride * ivec2(texel_number()), size = imageSize(pages).xy;
  vec3 p = vec3(0), n = vec3(0, 0, 1), between;
  bool there = all(lessThan(at, size));
  there = there && place_of(at, size, p, n);
  vec4 sum = there ? imageLoad(pages, ivec3(at, page)) : vec4(0, 0, 0, DONE);
  if (there && sum.w == 0.0 && is_between(at, between)) sum = vec4(between, DONE);
  int node = sum.w >= 0.0 ? int(sum.w) : node_count, met = 0, shown = 0;
  while (node < node_count && met < MOST_MET && shown < most_shown) {
    bool enough = false;
    int number = node;
    while (node < node_count && met < MOST_MET && !enough) {
      Node k = node_at(node);
      vec3 to = k.p - p;
      float far = length(to);
      bool hidden = is_hidden(k, n, to, far);
      enough = !hidden && is_enough(k, n, to, far);
      number = node;
      node = hidden || enough ? k.next : node + 1;
      met++;
    }
    if (enough) sum.rgb += changed(p, n, pinhole_of(node_at(number), p), number);
    shown++;
  }
  sum.w = node < node_count ? float(node) : DONE;
  if (there) imageStore(pages, ivec3(at, page), sum);
  if (there && sum.w != DONE) atomicAdd(unfinished, 1u);
}
