// A tile of a receiver's side: what mirrors and refractors change there of the light of surroundings that
// nothing hides. A texel looks through each sample that it sees: light goes on from there by all interfaces, off
// mirrors and through refractors, until it is outside, where it comes from the surroundings, or at a receiver,
// which is dark; and what it would have seen were nothing there is taken away. So light that is alike all around
// changes nothing where nothing is absorbed, whatever the samples. A sample of area A weighs A cos cos / (d2 +
// A / pi), which is exact for a disk around the texel's axis; near ones are taken by their parts, far ones in
// clusters. A thread is a listed texel. Paths differ in length, so a turn of its loop is one ray, whatever the ray
// is for: to a sample, from one interface to the next, or to a lamp.
layout(local_size_x = 32) in;
#include "thread.glsl"
#define COPIES_TABLES
#include "refractor.glsl"
uniform vec4 refractor_bounds;
uniform float share_limit;
uniform mat3 rgb_from_xyz, xyz_from_rgb;
#include "receiver_hit.glsl"
#include "pinholes.glsl"
#include "pinhole_tree.glsl"
#include "pinhole_map.glsl"
#include "page_texels.glsl"
layout(std430, binding = BINDING_PAGE_TEXELS) readonly buffer Texels {
  uint texel_count, texel_groups[3];
  uint texels[];  // x | y << 16
};
uniform float seen_off;  // m, that a ray may meet a sample's surface beside it

#include "walk.glsl"
#include "camera_bands.glsl"

// All wavelengths as one.
void take_joined_band() { take_band(0, counts.bands - 1); }

#ifdef ROUGH
uniform float scene_size;
uniform float light_unit;  // W of the lights' unit
#define ASKS_FOR_LAMPS
#include "rough_lamps.glsl"
#endif

// a, or what is as wide in its direction.
vec3 widened(vec3 a, vec3 other, float wide) {
  float is = length(a);
  return is >= wide ? a : is > 1e-6 ? a * (wide / is) : other * wide;
}

// Where a texel is and in which direction it faces.
void place_of(ivec2 at, ivec2 size, out vec3 p, out vec3 n) {
  float side = page % 2 == 0 ? 1.0 : -1.0;
#ifdef PINHOLE_CHARTS
  if (page / 2 >= RECEIVERS) {
    p = texelFetch(page_places, chart_row(at)).xyz;
    n = side * texelFetch(page_places, chart_row(at) + 1).xyz;
    return;
  }
#endif
  Receiver r = receivers[min(page / 2, RECEIVER_ROOM - 1)];
  vec2 t = (vec2(at) + 0.5) / vec2(size);
  n = side * r.normal.xyz;
  p = r.anchor.xyz + (from_page(page_axis(r.du, r.anchor.xyz), t.x) - r.du.w) * r.u.xyz +
      (from_page(page_axis(r.dv, r.anchor.xyz), t.y) - r.dv.w) * r.v.xyz;
}

// Loops of a thread may turn only so often (refraction_walk.glsl): after so many rays it begins no other sample.
const int MOST_RAYS = 64;
const int MOST_SEGMENTS = 24;
// A path off a curved mirror soon stands for many that part: at the mirror after so many it ends, as if outside.
const int MOST_MIRRORED = 4;
// Paths through a refractor fan out, and one stands for many: they show the surroundings blurred, rad.
const float FANNED_OUT = 0.35;

// The sample that is looked through, from p.
Pinhole pinhole;
int node_of;
float weight;       // weight of its light
vec3 total;         // sum over its paths, XYZ
vec3 by_u, by_v;    // by how much a path's last direction differs over it

// The path that goes on from there.
PathState w;
Interface h;                // where it is met last
int segment;                // that comes next
vec3 followed, left;        // weights: of what came to an end, and of what was given up
vec3 light, lamps;          // light of all ends, and of lights that rough mirrors show
int of;                     // refractor of its first interface
int ways, way;
#ifdef ROUGH
PathState w_first;  // the first of all paths
Interface h_first;
vec2 wider;         // by the sample's curvature and size
int lamp = LIGHTS;  // that is asked for at h; LIGHTS: none
#endif

void begin_way() {
  for (int k = 0; k < PENDING; k++) {
    pending[k] = w;
    pending[k].share = 0.0;
  }
  followed = left = light = lamps = vec3(0);
#ifdef ROUGH
  lobe_u = lobe_way_of(uint(node_of * LOBE_WAYS + way));
  lobe_ways = float(ways);
  lobe_width = 0.0;
#endif
}

void begin_pinhole(vec3 p, vec3 n, int number) {
  node_of = number;
  pinhole = pinhole_of(node_at(number), p);
  vec3 to = pinhole.p - p;
  float far2 = dot(to, to);
  vec3 d = to / max(sqrt(far2), 1e-20);
  weight = pinhole.area * max(dot(n, d), 0.0) * max(-dot(pinhole.n, d), 0.0) / (far2 + pinhole.area / PI);
  w = path_from(p, d);
  segment = way = 0;
  ways = 1;
  total = vec3(0);
  begin_way();
}

// What the path has shown, and what is left of it as if it had.
void end_way() {
  for (int k = 0; k < PENDING; k++) left += left_of(pending[k]);
  left += left_of(w);
  light *= tail_of(followed, left);
  total += (light + lamps) / float(ways);
}

// By how much directions differ over the sample, which is met: there, by a and b, and of the path's end.
void begin_footprint(vec3 p, vec3 d, float far, out vec3 a, out vec3 b) {
  a = b = by_u = by_v = vec3(0);
#ifdef FOOTPRINTS
  // Twice what half a spacing turns: samples meet in the middle.
  footprint(pinhole, p, mirrored(p, pinhole.p, pinhole.n), by_u, by_v);
  by_u *= 2.0;
  by_v *= 2.0;
  vec3 u = 2.0 * pinhole.half_width * pinhole.u, v = 2.0 * pinhole.half_width * pinhole.v;
  a = (u - dot(u, d) * d) / far;
  b = (v - dot(v, d) * d) / far;
#endif
  if (!is_mirror(of)) by_u = by_v = vec3(0);
}

#ifdef ROUGH
// A sample of a rough mirror shows the surroundings by some of the lobe's directions, each as wide as the share that
// it stands for: the more, the more it weighs. For lights the lobe is as much wider as the sample is.
void begin_rough(float far) {
  w_first = w;
  h_first = h;
  ways = cluster_share > 0.0 ? int(ceil(float(LOBE_WAYS) * min(weight / (PI * cluster_share), 1.0))) : LOBE_WAYS;
  lobe_ways = float(ways);
  wider = vec2(0);
#ifdef FOOTPRINTS
  // For even slopes of that half width, by GGX's measure: their standard deviation times the root
  // of two.
  RoughHit m = rough_hit(w, h);
  float half_width = 0.8165 * pinhole.half_width, near = 0.5 * half_width / max(far, 1e-20);
  vec2 along = abs(pinhole.turn) * half_width;
  for (int k = 0; k < 2; k++) {
    vec3 axis = k == 0 ? m.x : m.y;
    float u = dot(axis, pinhole.u), v = dot(axis, pinhole.v);
    wider[k] = along.x * u * u + along.y * v * v + near;
  }
  // Lobes that are wider than samples are apart sum to what they should by themselves.
  wider = sqrt(max(wider * wider - 0.25 * m.facets * m.facets, vec2(0)));
#endif
}

vec2 lamp_facets(RoughHit m) {
  vec2 by = segment == 0 ? wider : vec2(0.5 * lobe_width);
  return sqrt(m.facets * m.facets + by * by);
}

// The first light from number i on that the lobe shows where nothing is between.
void find_lamp(int i) {
  RoughHit m = rough_hit(w, h);
  vec2 facets = lamp_facets(m);
  bool shown = false;
  lamp = i;
  while (lamp < LIGHTS && !shown) {
    shown = lobe_shows_lamp(lamp, m, facets, w, h).e > 0.0;
    lamp += shown ? 0 : 1;
  }
}
#endif

// One ray from p, or from where its path is. Returns what it changes; going: there is more of this sample.
vec3 go_on(vec3 p, inout bool going) {
  bool asks = false, first = segment == 0;
  PathState ray = w;
  Interface at;
  at.hit.t = 1e30;
#ifdef ROUGH
  asks = lamp < LIGHTS;
  LampRay to_lamp = lobe_shows_lamp(min(lamp, LIGHT_ROOM - 1), rough_hit(w, h), lamp_facets(rough_hit(w, h)), w, h);
  if (asks) ray = to_lamp.ray;
  if (asks) at.hit.t = to_lamp.distance_m;
#endif
  float reach = at.hit.t, far = distance(p, pinhole.p), t_min = ray.inside == 0u ? 1e-4 * refractor_bounds.w : 0.0;
  bool met = next_interface(ray, at);
  bool dark = receiver_between(ray.p, ray.d, t_min, met ? at.hit.t : reach);
#ifdef AREA_LIGHTS
#ifdef ROUGH
  int own = asks ? area_light_of(min(lamp, LIGHT_ROOM - 1)) : -1;
#else
  const int own = -1;
#endif
  dark = dark || area_light_between(ray.p, ray.d, t_min, met ? at.hit.t : reach * (1.0 - 2e-5), own);
#endif
  bool turns = !asks && met && !dark && (!first || abs(at.hit.t - far) <= seen_off + 1e-4 * far);
  turns = turns && segment < (first || !is_mirror(of) ? MOST_SEGMENTS : MOST_MIRRORED);
  bool begins = first && turns, ends = !asks && !first && !turns;
  if (!asks) h = at;
#ifdef ABSORBING
  if (!asks && w.inside != 0u && met) absorb_inside(w, h.hit.t);
#endif

  // What is around, where the path ends, or where it would have if nothing were there.
  vec3 a = by_u, b = by_v, change = vec3(0);
  if (begins) {
    of = h.hit.refractor;
    begin_footprint(p, w.d, far, a, b);
  }
  float wide = ends && !is_mirror(of) ? FANNED_OUT : 0.0;
#ifdef ROUGH
  wide = ends ? max(wide, lobe_width) : 0.0;
#endif
  vec3 u = normalize(cross(w.d, abs(w.d.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
  vec3 sky = sky_over(w.d, widened(a, u, wide), widened(b, cross(w.d, u), wide), begins || (ends && !dark));
  if (begins) change = -weight * sky;
  if (ends) {
    light += dark ? vec3(0) : in_band(w, sky);
    followed += left_of(w);
    w.share = 0.0;
    w = take_pending();
  }

#ifdef ROUGH
  bool rough = turns && is_rough(h.hit.refractor);
  if (begins && rough) begin_rough(far);
  if (asks && !met && !dark) {
    vec3 shown = in_band(to_lamp.ray, light_unit * to_lamp.shown);
    total += first ? shown : vec3(0);
    lamps += first ? vec3(0) : shown;
  }
  if (asks || rough) find_lamp(asks ? lamp + 1 : 0);
  turns = (turns || asks) && lamp == LIGHTS;
  bool over = !turns && lamp == LIGHTS;
#else
  bool over = !turns;
#endif
  if (over && !(first && !asks)) over = w.share <= 0.0;
  if (over && !first) {
    end_way();
    way++;
    change += way == ways ? weight * (rgb_from_xyz * total) : vec3(0);
#ifdef ROUGH
    if (way < ways) {
      w = w_first;
      h = h_first;
      begin_way();
      segment = 0;
      turns = true;
    }
#endif
  }
  if (turns) {
    float ended, dropped, absorbed;
    vec3 rest = left_further(w, h);
    branch(w, h, 0.5 * share_limit, ended, dropped, absorbed);
    left += (ended + dropped) * rest;
    segment++;
    if (w.share <= 0.0) w = take_pending();
  }
  going = turns || !over;
  return change;
}

void main() {
  copy_tables();
  take_joined_band();
  bool there = thread_number() < texel_count;
  uint place = there ? texels[thread_number()] : 0u;
  ivec2 at = ivec2(place & 0xffffu, place >> 16);
  vec3 p, n;
  place_of(at, imageSize(pages).xy, p, n);
  vec4 sum = imageLoad(pages, ivec3(at, page));
  int node = there ? int(sum.w) : node_count, rays = 0;
  bool going = false;
  while (going || (node < node_count && rays < MOST_RAYS)) {
    int taken = going ? -1 : next_taken(p, n, node);
    if (taken >= 0) begin_pinhole(p, n, taken);
    going = going || taken >= 0;
    bool goes = going;
    vec3 change = go_on(p, going);
    sum.rgb += goes ? change : vec3(0);
    going = going && goes;
    rays++;
  }
  sum.w = node < node_count ? float(node) : DONE;
  if (there) imageStore(pages, ivec3(at, page), sum);
  if (there && sum.w != DONE) unfinished[atomicAdd(unfinished_count, 1u)] = place;
}
