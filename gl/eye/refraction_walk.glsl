// The camera's rays on multi-refractor paths (walk.glsl): what the branches show, by their shares.

// Paths of one band: the strongest paths come first. Mesa 22's llvmpipe ends every loop of a thread
// that has been through 65535 turns of any loops; a segment takes one for each plane and some for
// the BVH, and a thread takes every PIXEL_THREADS-th band (refraction_threads.glsl).
#ifdef REFINES
#define BANDS_TAKEN COARSE_BANDS
#else
#define BANDS_TAKEN counts.eye_bands
#endif
#ifdef CRYSTALS
#define BANDS_AT_ONCE (2 * BANDS_TAKEN)
#else
#define BANDS_AT_ONCE BANDS_TAKEN
#endif
int most_segments() {
#ifdef ROUGH
  return max(8, 49152 / (PLANE_ROOM + 64 + FOOTPRINT_TAPS) / (8 * (BANDS_AT_ONCE + PIXEL_THREADS) / PIXEL_THREADS));
#else
  return max(8, min(224, 49152 / (PLANE_ROOM + 64 + FOOTPRINT_TAPS)) / ((BANDS_AT_ONCE + PIXEL_THREADS) / PIXEL_THREADS));
#endif
}

uniform uint eye_inside;  // refractors that the camera is in, which are clear

#ifdef ROUGH
#include "rough_lamps.glsl"
#endif

// XYZ of what w and `other` show, which have met an interface, in the band that is taken. What is not
// followed shows what the rest has shown, in its own colour: inside, it goes on by as much as it came.
vec3 shown(PathState w, PathState other) {
  for (int k = 0; k < PENDING; k++) {
    pending[k] = other;
    pending[k].share = k == 0 ? other.share : 0.0;
  }
  if (w.share <= 0.0) w = take_pending();
  vec3 light = vec3(0), lamps = vec3(0);
  vec3 seen_weight = vec3(0), left = vec3(0);  // left: of what is not followed
  bool going = w.share > 0.0;
  int most = most_segments();
  for (int segment = 0; going && segment < most; segment++) {
    Interface h;
    float t_min = w.inside == 0u ? -touch * refractor_bounds.w : 0.0;
    h.hit.t = 1e30;
#ifdef COARSE_EYE
    parallelogram_hit(w.p, w.d, t_min, 1e30, h.hit.t);  // a search is dear: none behind what is found cheaply
#endif
    bool met = next_interface(w, h), receiver;
    vec3 radiance = seen(w.p, w.d, SPREAD_OF(w), t_min, met ? h.hit.t : 1e30, receiver);
#ifdef COARSE_EYE
    met = met || receiver;
#endif
#if defined(SHAFTS) || defined(HAZE_BEYOND)
    float way_m = receiver ? seen_at : met ? h.hit.t : HAZE_FAR;
    vec3 scattered = vec3(0);
#ifdef SHAFTS
    int shaft = w.inside == 0u ? -1 : shaft_of(medium_of(w.inside));
    if (shaft >= 0 && way_m < HAZE_FAR)
      scattered = shafts_along(shaft, w.p, w.d, way_m, vec3(refractor_spectrum(medium_of(w.inside)).y));
#endif
#ifdef HAZE_BEYOND
    if (w.inside == 0u)
      scattered = haze_beyond(w.p, w.d, way_m, w.haze_m);
    else
      scattered *= haze_behind(w.haze_m);
    radiance *= haze_behind(w.haze_m);
#endif
    float step_n = medium_n(eye_inside) / medium_n(w.inside);
    lamps += step_n * step_n * in_band(w, scattered);
#endif
#ifdef ABSORBING
#ifdef GLOWS
    Depth depth = w.depth;
#endif
    float metres = receiver ? seen_at : h.hit.t;
    if (w.inside != 0u && met) absorb_inside(w, metres);
#ifdef GLOWS
    if (w.inside != 0u && met)
      lamps += glow_along(medium_of(w.inside), w.share, medium_n(w.inside) / medium_n(eye_inside), w.p, w.d, metres, depth,
                          w.depth - depth);
#endif
#endif
    if (met && !receiver) {
      float ended, dropped, absorbed;
#ifdef ROUGH
      if (is_rough(h.hit.refractor)) lamps += lobe_shows(w, h, vec2(0.5 * lobe_width));
#endif
      vec3 rest = left_further(w, h);
      branch(w, h, 0.5 * share_limit, ended, dropped, absorbed);
      left += (ended + dropped) * rest;
    } else {
      // radiance over the squared index is the same on both sides of an interface
      float n = medium_n(eye_inside) / (receiver ? medium_n(w.inside) : 1.0);
      light += n * n * in_band(w, radiance);
#ifdef KEEPS_SIGHTS
      if (sight_waits) note_sight(n * n * left_of(w), band_of_all_sets());
#endif
      seen_weight += left_of(w);
      w.share = 0.0;
    }
    if (w.share <= 0.0) w = take_pending();
    going = w.share > 0.0;
    if (segment == most - 1) {
      left += left_of(w);
      for (int k = 0; k < PENDING; k++) left += left_of(pending[k]);
    }
  }
  vec3 tail = tail_of(seen_weight, left);
#ifdef KEEPS_SIGHTS
  sight_tail = tail;
#endif
  return light * tail + lamps;
}

PathState start;
Interface first;

#ifdef ROUGH
float lobe_shift;  // shift for the pixel
#endif

void begin_path(ivec2 at) {
  aim_at(at);
#ifdef ROUGH
  // Neighbours take directions far from each other [Roberts2018].
  lobe_shift = fract(dot(vec2(at), vec2(0.7548776662, 0.5698402910)));
  lobe_u = lobe_way(0, lobe_shift);
  lobe_width = 0.0;
#endif
  start = path_from(eye, sight);
  start.inside = eye_inside;
#ifdef KEEPS_SPREAD
  start.spread = sight_spread;
#endif
}

#if defined(COARSE_EYE) && !defined(KEEPS_SPREAD)
// As its front layer has it, which may be drawn of fewer triangles; it lies near enough for light that is followed
// into a refractor, and not for light off a mirror, which would meet the same faces again.
bool is_told_by_layer(ivec2 at) {
  if (refractors[refractor].info.x != MODEL_HIERARCHY || is_mirror(refractor)) return false;
  vec4 layer = texelFetch(eye_layers, ivec3(at, 0), 0);
  first.hit = Hit(eye + layer.w * sight, normalize(layer.xyz), layer.w, refractor, -1);
  first.face_n = first.hit.n;
#ifdef FILMS
  first.film = film_on(refractor, -1);
#endif
  return true;
}
#else
bool is_told_by_layer(ivec2 at) { return false; }
#endif

void look(ivec2 at) {
  begin_path(at);
  found = is_told_by_layer(at);
  if (!found) {
    first.hit.t = 1e30;
    found = next_interface(start, first);
  }
  front = first.hit;
  if (found) refractor = front.refractor;
}
