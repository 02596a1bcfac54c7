// The eye's rays on the general way (walk.glsl): what the branches show, by their shares.

#include "walk.glsl"

// Of one band. Mesa 22's llvmpipe ends every loop of a thread that has been through 65535 turns of any
// loops, which a longer search through a large mesh would come near; the strongest ways come first.
const int MOST_SEGMENTS = max(8, 224 / (WAVELENGTHS + 1));

int band_of_refractor;  // that is followed, among one refractor's
float left;             // share of what is not followed

vec2 refractor_spectrum(int r) {
  Band band = bands[r * BAND_COUNT + band_of_refractor];
  return vec2(band.weight_n.w, band.attenuation.x);
}

// At an interface: the stronger branch is left in w, and of both what carries enough.
void branch(inout Way w, Interface h, inout Way pending[PENDING]) {
  Way mirrored;
  if (!split(w, h, mirrored)) return;
  bool reflects = reflects_on(mirrored), passes = w.share >= 0.5 * share_limit;
  left += (reflects ? 0.0 : mirrored.share) + (passes ? 0.0 : w.share);
  if (!reflects) mirrored.share = 0.0;
  if (!passes) w.share = 0.0;
  Way weaker = mirrored;
  if (mirrored.share > w.share) {
    weaker = w;
    w = mirrored;
  }
  left += keep_pending(weaker, pending);
}

// What w shows, times its share. What is not followed shows what the rest has shown.
vec3 shown(Way w) {
  Way pending[PENDING];
  for (int k = 0; k < PENDING; k++) {
    pending[k] = w;
    pending[k].share = 0.0;
  }
  vec3 light = vec3(0);
  float seen_share = 0.0;
  left = 0.0;
  bool going = w.share > 0.0;
  for (int segment = 0; going && segment < MOST_SEGMENTS; segment++) {
    Interface h;
    h.hit.t = 1e30;
    bool met = next_interface(w, h), receiver;
    float t_min = w.inside == 0u ? -touch * refractor_bounds.w : 0.0;
    vec3 radiance = seen(w.p, w.d, t_min, met ? h.hit.t : 1e30, receiver);
#ifdef ABSORBING
    if (w.inside != 0u && met)
      w.share *= exp(-h.hit.t * refractor_spectrum(medium_of(w.inside)).y);
#endif
    if (met && !receiver) {
      branch(w, h, pending);
    } else {
      light += w.share * radiance;
      seen_share += w.share;
      w.share = 0.0;
    }
    if (w.share <= 0.0) w = take_pending(pending);
    going = w.share > 0.0;
    bool last = segment == MOST_SEGMENTS - 1;
    left += last ? w.share : 0.0;
    for (int k = 0; k < PENDING; k++) left += last ? pending[k].share : 0.0;
  }
  return light * (seen_share > 0.0 ? 1.0 + left / seen_share : 0.0);
}

// Through the first interface, in one band; the share that is mirrored there is left to others.
vec3 through(Way start, Interface first, int band, out Way mirrored) {
  band_of_refractor = band;
  Way w = start;
  mirrored = start;
  if (!split(w, first, mirrored)) mirrored.share = 0.0;
  return shown(w);
}

// In the mirror of the first interface, for all bands alike.
vec3 in_the_mirror(Way start, Interface first, int band) {
  band_of_refractor = band;
  Way w = start, mirrored;
  if (!split(w, first, mirrored) || mirrored.share <= 0.0) return vec3(0);
  return shown(mirrored) / mirrored.share;
}
