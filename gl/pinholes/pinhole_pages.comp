// A page of a receiver's side: what mirrors and refractors change there of the light of surroundings that
// nothing hides. A texel looks through each sample that it sees: light goes on from there by all interfaces, off
// mirrors and through refractors, until it is outside, where it comes from the surroundings, or at a receiver,
// which is dark; and what it would have seen were nothing there is taken away. So light that is alike all around
// changes nothing where nothing is absorbed, whatever the samples. A sample of area A weighs A cos cos / (d2 +
// A / pi), which is exact for a disk around the texel's axis; near ones are taken by their parts.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
#define COPIES_TABLES
#include "refractor.glsl"
uniform vec4 refractor_bounds;
uniform float share_limit;
uniform mat3 rgb_from_xyz, xyz_from_rgb;
const int PINHOLE_PARTS = 8;   // as in pinhole_samples.h
const float NEAR_AREAS = 6.0;  // samples nearer than the root of so many times their area are taken by parts
#include "receiver_hit.glsl"
#include "pinholes.glsl"
#include "pinhole_map.glsl"
layout(rgba32f, binding = 0) uniform image2DArray pages;
uniform int page, pinhole_count;
uniform int first_pinhole, end_pinhole;
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
vec3 rough_light(PathState w, Interface h, Pinhole s, int number, float scale, vec3 by_u, vec3 by_v) {
  vec3 sum = vec3(0), wider = vec3(0);
#ifdef FOOTPRINTS
  // Of even slopes of that half width, by GGX's measure: their standard deviation times the root of two.
  RoughHit m = rough_hit(w, h);
  float half_width = 0.8165 * scale * s.half_width, near = 0.5 * half_width / max(distance(w.p, h.hit.p), 1e-20);
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

// What a sample of an area changes at p, where n is the receiver's side.
vec3 changed(vec3 p, vec3 n, Pinhole s, int number, float area, float scale) {
  vec3 to = s.p - p;
  float far2 = dot(to, to), far = sqrt(far2);
  vec3 d = to / max(far, 1e-20);
  float weight = area * max(dot(n, d), 0.0) * max(-dot(s.n, d), 0.0) / (far2 + area / PI);
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
  by_u *= 2.0 * scale;
  by_v *= 2.0 * scale;
  vec3 u = 2.0 * scale * s.half_width * s.u, v = 2.0 * scale * s.half_width * s.v;
  wide_u = (u - dot(u, d) * d) / far;
  wide_v = (v - dot(v, d) * d) / far;
#endif
#ifdef ROUGH
  lobe_u = lobe_way(0, 0.618034 * float(number));
  lobe_width = 0.0;
  vec3 light = is_rough(h.hit.refractor) ? rough_light(w, h, s, number, scale, by_u, by_v) : carried(w, h, by_u, by_v);
#else
  vec3 light = carried(w, h, by_u, by_v);
#endif
  return weight * (light - sky_over(d, wide_u, wide_v));
}

// A part of a sample: its own place and normal; it turns as the sample does.
Pinhole part_of(Pinhole s, int i, int k, out float area) {
  int at = 4 * pinhole_count + 2 * (i * PINHOLE_PARTS + k);
  vec4 place = texelFetch(pinholes, at);
  vec3 own = texelFetch(pinholes, at + 1).xyz;
  area = place.w;
  s.p = place.xyz;
  s.n = dot(own, s.n) < 0.0 ? -own : own;
  return s;
}

void main() {
  copy_tables();
  ivec2 at = ivec2(texel_number());
  ivec2 size = imageSize(pages).xy;
  Receiver r = receivers[page / 2];
  vec3 n = page % 2 == 0 ? r.normal.xyz : -r.normal.xyz;
  vec2 t = (vec2(at) + 0.5) / vec2(size);
  vec3 p = r.corner.xyz + from_page(page_axis(r.du.xyz, r.corner.xyz), t.x) * r.u.xyz +
           from_page(page_axis(r.dv.xyz, r.corner.xyz), t.y) * r.v.xyz;
  bool there = all(lessThan(at, size));
  vec3 sum = first_pinhole > 0 && there ? imageLoad(pages, ivec3(at, page)).rgb : vec3(0);
  for (int i = first_pinhole; i < end_pinhole && there; i++) {
    Pinhole whole = pinhole_at(i, p);
    vec3 to = whole.p - p;
    bool near = dot(to, to) < NEAR_AREAS * whole.area;
    int parts = near ? PINHOLE_PARTS : 1;
    for (int k = 0; k < parts; k++) {
      float area = whole.area;
      Pinhole s = whole;
      if (near) s = part_of(whole, i, k, area);
      sum += changed(p, n, s, i, area, sqrt(area / whole.area));
    }
  }
  if (there) imageStore(pages, ivec3(at, page), vec4(sum, 1));
}
