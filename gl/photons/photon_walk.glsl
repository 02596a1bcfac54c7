// A photon's light at wavelength i on the general way (walk.glsl): at each interface the stronger
// branch goes on and the other waits. A landing's slot follows from its path, so that neighbouring
// photons and wavelengths have the same path in the same slot.

#define KEEPS_WALL
#include "walk.glsl"

const int MOST_SEGMENTS = 128;  // of one photon's light; fewer are met but in a hall of mirrors

int wavelength;

vec2 refractor_spectrum(int r) {
  return spectra[r * WAVELENGTHS + wavelength].xy;
}

// At an interface: the stronger branch is left in w. Returns the share that is not followed.
float branch(inout Way w, Interface h, inout Way pending[PENDING]) {
  Way mirrored;
  if (!split(w, h, mirrored)) return 0.0;
  float ended = reflects_on(mirrored) ? 0.0 : mirrored.share;
  mirrored.share -= ended;
  Way weaker = mirrored;
  if (mirrored.share > w.share) {
    weaker = w;
    w = mirrored;
  }
  return ended + keep_pending(weaker, pending);
}

// A free slot, the path's own if it can be; -1: all are used.
int take_slot(uint path, inout uint used) {
  int at = int((path * 2654435761u >> 8) % uint(SLOTS)), slot = -1;
  for (int k = 0; k < SLOTS; k++) {
    int here = (at + k) % SLOTS;
    if (slot < 0 && (used >> here & 1u) == 0u) slot = here;
  }
  if (slot >= 0) used |= 1u << slot;
  return slot;
}

void trace(uint photon, int lane, int i, float flux, vec3 o, vec3 d, Hit front, bool reached,
           out Shares entry[5]) {
  for (int k = 0; k < 5; k++) entry[k] = Shares(0.0);
  wavelength = i;
  Way pending[PENDING];
  Way w = Way(o, d, 1.0, 0u, 0u, -1, -1, -1, d, false);
  for (int k = 0; k < PENDING; k++) pending[k] = Way(o, d, 0.0, 0u, 0u, 0, -1, -1, d, false);
  Interface h;
  h.hit.t = 1e30;
  bool going = reached && next_interface(w, h);
  uint owner = uint(h.hit.refractor), used = 0u;
  float missed = 0.0, reflected = 0.0, absorbed = 0.0, trapped = 0.0;
  if (going) {
    entry[REACHED] = Shares(1.0);
    trapped = branch(w, h, pending);
  }
  for (int segment = 0; going && segment < MOST_SEGMENTS; segment++) {
    h.hit.t = 1e30;
    bool met = next_interface(w, h);
    vec3 at, place;
    int page;
    uint receiver;
    // What leaves a refractor that touches a receiver lands there.
    float t_min = w.inside == 0u ? -touch * refractor_bounds.w : 0.0;
    int landed = land(w.p, w.d, t_min, met ? h.hit.t : 1e30, at, place, page, receiver);
#ifdef ABSORBING
    if (w.inside != 0u && (met || landed != NO_RECEIVER)) {
      float way = landed != NO_RECEIVER ? distance(at, w.p) : h.hit.t;
      float left = exp(-way * refractor_spectrum(medium_of(w.inside)).y);
      absorbed += w.share * (1.0 - left);
      w.share *= left;
    }
#endif
    if (landed == NO_RECEIVER && met) {
      trapped += branch(w, h, pending);
    } else {
      int slot = landed >= LANDED ? take_slot(w.path, used) : -1;
      if (slot >= 0)
        keep_landing(
            photon, slot, lane, place, w.share * flux,
            signature_of(w.path * 31u + receiver, landed, owner), 0.0,
            vec4(w.p, wall_word(dot(w.wall_n, w.d) < 0.0 ? -w.wall_n : w.wall_n,
                                w.transmitted && w.inside == 0u && w.refractor == int(owner), page)));
      else if (landed >= LANDED || (landed == NO_RECEIVER && w.inside != 0u))
        trapped += w.share;
      else if (w.walls == 0 && w.inside == 0u)
        reflected += w.share;
      else
        missed += w.share;
      w.share = 0.0;
    }
    if (w.share <= 0.0) w = take_pending(pending);
    going = w.share > 0.0;
  }
  if (going) {
    trapped += w.share;
    for (int k = 0; k < PENDING; k++) trapped += pending[k].share;
  }
  entry[REFLECTED] = Shares(reflected);
  entry[ABSORBED] = Shares(absorbed);
  entry[TRAPPED] = Shares(trapped);
  entry[MISSED] = Shares(missed);
}
