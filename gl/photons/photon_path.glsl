// The path of a photon's light of one wavelength: from the light through refractors to receivers.
// Every outgoing segment that still carries energy is followed, one hit each. Who includes this gives
// `light`, `share_limit` and keep_hit(ray, hit). HAZE: with keeps_ways() hits are not where light meets receivers, but its segments through what scatters, from interface to interface and beyond; in place of interface_word()
// stands the refractor in which a segment is, -1: the air.

#include "photon_tints.glsl"
#ifdef CRYSTALS
#include "band_colours.glsl"
#include "crystals.glsl"

int crystal_node;  // the wavelength that is followed; the camera's first bands are of these

Crystal crystal_of(int r) {
  int at = counts.crystals + 2 * r;
  return make_crystal(texelFetch(band_texels, at).xyz, texelFetch(band_texels, at + 1).xyz,
                      texelFetch(band_texels, counts.crystals + 2 * REFRACTORS + r * BAND_SETS * counts.bands + crystal_node));
}
#endif

const int REACHED = 0, REFLECTED = 1, ABSORBED = 2, TRAPPED = 3, MISSED = 4;

// What its light is handed on as, and what it meets first.
struct PhotonRay {
  uint item;  // index in the list that is worked on
  int sample_number, wavelength;
  float flux;  // W
  vec3 o, d;
  bool reached;  // front: the refractor
  Hit front;
};

struct PhotonHit {
  int slot;
  vec3 place;
  float flux;  // W; TINTS: without what these absorb
  uint signature;
  vec4 interface_at;  // as in outgoing_segment.glsl
#ifdef TINTS
  Tints tints;
#endif
};

PhotonHit clear_hit(int slot, vec3 place, float flux, uint signature, vec4 interface_at) {
  PhotonHit hit;
  hit.slot = slot;
  hit.place = place;
  hit.flux = flux;
  hit.signature = signature;
  hit.interface_at = interface_at;
#ifdef TINTS
  hit.tints = no_tints();
#endif
  return hit;
}

void keep_hit(PhotonRay ray, PhotonHit hit);

// Where light comes to a receiver, and whether the light's map or a tile of it holds that.
const int NO_RECEIVER = 0, NOT_HELD = 1, HELD = 2, HELD_ON_TILE = 3;

struct ReceiverHit {
  int state;
  vec3 at, place;  // place: what is kept of it
  int tile;
  uint receiver;
};

#ifdef TILES
uniform int fits_tiles;  // they are yet to be chosen: coordinates of any chart will do
layout(binding = UNIT_CHART_ROWS) uniform samplerBuffer chart_rows;  // two a chart: from a place to its u, and v

// Where the light's map does not hold a place: the tile of a chart's side on which it lies; false where
// there is none.
bool beside_map(int side, inout vec3 place, out int tile) {
  vec3 at = place;
  tile = tile_of_side(light, side);
  if (of_dispatch(fits_tiles) > 0) {
    vec4 to_u = texelFetch(chart_rows, side >> 1 << 1), to_v = texelFetch(chart_rows, side | 1);
    place = vec3(dot(to_u.xyz, at) + to_u.w, dot(to_v.xyz, at) + to_v.w, side);
    return true;
  }
  return tile >= 0 && is_within(tile_rect(light, max(tile, 0)), place_on_tile(light, max(tile, 0), at));
}
#endif

// The first receiver on the ray.
ReceiverHit meet_receiver(vec3 p, vec3 d, float t_min, float t_max) {
  Light l = pass_light;
  ReceiverHit to = ReceiverHit(NO_RECEIVER, p, p, -1, 1u);
  vec3 uvz;
  float t;
  int r = receiver_hit(p, d, t_min, t_max, t);
#ifdef AREA_LIGHTS
  vec3 unused;
  if (area_light_seen(p, d, t_min, t, unused)) {
    to.state = NOT_HELD;
    to.at = to.place = p + t * d;
    return to;
  }
#endif
  if (r < 0) return to;
  to.at = to.place = p + t * d;
  to.receiver = uint(receiver_part(r)) + 1u;
  vec3 from;
  float distance_m;
  light_to(l, to.at, from, distance_m);
  bool held =
      project(l.map_view, to.at, uvz) && inside(uvz.xy) && receiver_lit(light, to.at, receiver_normal(r), from, distance_m);
  to.state = held ? HELD : NOT_HELD;
#ifdef TILES
  int side = chart_side(r, d);
  if (!held && beside_map(side, to.place, to.tile)) {
    to.receiver += 7919u * (uint(side) + 1u);  // parts of a mesh go on across its charts, places do not
    to.state = HELD_ON_TILE;
    return to;
  }
  to.tile = -1;
#endif
  return to;
}

#ifdef HAZE
uniform int ways;  // 1: they are kept
bool keeps_ways() { return of_dispatch(ways) > 0; }

// Extinction and scattering of the air, 1/m.
vec2 air_haze(int i) { return spectra[REFRACTORS * counts.wavelengths + i].yz; }

// What media in the air leave of light along a segment, the first from a light or a later one.
float air_left(PhotonRay photon, vec3 p, vec3 d, float length_m, bool first) {
  bool from_afar = first && int(pass_light.position.w) == 2;
  return haze_left(p, d, from_afar ? -HAZE_FAR : 0.0, length_m, air_haze(photon.wavelength).x);
}
#endif

// How far off it is, where there is one.
float length_to(ReceiverHit to, vec3 from) { return to.state == NO_RECEIVER ? 1e30 : distance(to.at, from); }

// A hit's signature; `path` counts the receiver too.
uint signature_of(uint path, ReceiverHit to, uint owner) {
#ifdef TILES
  return (path << 8 & ~ON_A_TILE) | 0x80000000u | (to.state == HELD_ON_TILE ? ON_A_TILE : 0u) | owner;
#else
  return path << 8 | 0x80000000u | owner;
#endif
}

#ifdef HAZE
// The part of a segment in the air, along d from p, that is in a medium; hit: its slot, signature and depths, and the
// flux that is left at its end.
void keep_air_way(PhotonRay photon, vec3 p, vec3 d, float length_m, PhotonHit hit) {
  float first, way_m = haze_way(p, d, 0.0, length_m, first);
  hit.place = p + (first + way_m) * d;
  hit.interface_at = vec4(p + first * d, -1.0);
  if (way_m > 0.0 && air_haze(photon.wavelength).y > 0.0) keep_hit(photon, hit);
}
#endif

#ifdef WALK
#include "photon_walk.glsl"
#else
#include "photon_inner.glsl"
#endif
