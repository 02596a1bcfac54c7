// A photon's light at wavelength i on multi-refractor paths (walk.glsl): at each interface the stronger
// branch goes on and the other waits. A hit's slot follows from its path, so that neighbouring
// photons and wavelengths have the same path in the same slot.

#define KEEPS_INTERFACE
#include "walk.glsl"

const int MOST_SEGMENTS = 128;  // segments of one photon's light; fewer are met but in a hall of mirrors

int wavelength;

vec2 refractor_spectrum(int r) {
  return spectra[r * counts.wavelengths + wavelength].xy;
}

#ifdef MIRRORS
vec3 mirror_spectrum(int r) {
  return spectra[r * counts.wavelengths + wavelength].yzw;
}
#endif

// A free slot, the path's own if it can be; -1: all are used.
int take_slot(uint path, inout uint used) {
  uint at = (path * 2654435761u >> 8) % uint(counts.slots);
  uint unused = ~used & (0xffffffffu >> uint(32 - counts.slots)), from_there = unused >> at << at;
  int slot = findLSB(from_there != 0u ? from_there : unused);
  if (slot >= 0) used |= 1u << slot;
  return slot;
}

// What a path that ends comes to, in shares of the light.
struct Ends {
  Shares reflected, absorbed, trapped, missed;
};

// What is left of the path's own light, for every share of it.
Shares left_of(PathState w) {
#ifdef TINTS
  return left_after(w.passed.depth);
#else
  return 1.0;
#endif
}

// What a path hands on. The flux is that before tints take theirs.
PhotonHit hit_of(PhotonRay photon, PathState w, int slot, vec3 place, uint signature, vec4 interface_at) {
  PhotonHit hit = clear_hit(slot, place, w.share * photon.flux, signature, interface_at);
#ifdef TINTS
  hit.flux *= exp(min(w.least_depth, 80.0));
  hit.tints = w.passed.tints;
#endif
  return hit;
}

void end_path(PhotonRay photon, PathState w, ReceiverHit to, uint owner, inout uint used, inout Ends e) {
#ifdef HAZE
  if (keeps_ways()) return;
#endif
  int slot = to.state >= HELD ? take_slot(w.path, used) : -1;
  if (slot >= 0) {
    bool last = w.transmitted && w.inside == 0u && w.refractor == int(owner);
    vec3 n = dot(w.interface_n, w.d) < 0.0 ? -w.interface_n : w.interface_n;
    keep_hit(photon, hit_of(photon, w, slot, to.place, signature_of(w.path * 31u + to.receiver, to, owner),
                            vec4(w.p, interface_word(n, last, to.tile))));
  } else if (to.state >= HELD || (to.state == NO_RECEIVER && w.inside != 0u)) {
    e.trapped += w.share * left_of(w);
  } else if (w.interfaces == 0 && w.inside == 0u) {
    e.reflected += w.share * left_of(w);
  } else {
    e.missed += w.share * left_of(w);
  }
}

#ifdef HAZE
// w's segment from an interface to what it meets next; ends: what that is, as a part of the path's signature.
void keep_way(PhotonRay photon, PathState w, float length_m, uint ends, uint owner, inout uint used) {
  bool in_air = w.inside == 0u;
  if (!in_air && (length_m >= 1e30 || spectra[medium_of(w.inside) * counts.wavelengths + wavelength].z <= 0.0)) return;
  uint path = w.path * 31u + ends;
  int slot = take_slot(path, used);
  uint signature = path << 8 | 0x80000000u | owner;
  PhotonHit hit = hit_of(photon, w, slot, w.p + length_m * w.d, signature, vec4(w.p, float(medium_of(w.inside))));
  if (slot >= 0 && in_air)
    keep_air_way(photon, w.p, w.d, length_m, hit);
  else if (slot >= 0)
    keep_hit(photon, hit);
}
#endif

// share: of the photon's light, as which wave it would enter crystals.
void follow(PhotonRay photon, float share, int wave, inout uint used, inout Shares entry[5]) {
  vec3 o = photon.o, d = photon.d;
  PathState w = path_from(o, d);
#ifdef CRYSTALS
  w.share = share;
  w.wave = wave;
  w.path = 977u * uint(wave);
#endif
  for (int k = 0; k < PENDING; k++) {
    pending[k] = w;
    pending[k].share = 0.0;
  }
  uint owner = 0u;
  Ends e = Ends(Shares(0.0), Shares(0.0), Shares(0.0), Shares(0.0));
  bool going = photon.reached;
  // From the light to its first interface in a turn of the loop too: what is called twice is compiled twice.
  for (int segment = -1; going && segment < MOST_SEGMENTS; segment++) {
    bool arrives = segment < 0;
    Interface h;
    h.hit.t = 1e30;
    bool met = next_interface(w, h);
    if (arrives) {
      owner = uint(h.hit.refractor);
      entry[REACHED] += Shares(met ? share : 0.0);
      w.share = met ? w.share : 0.0;
    }
    // What leaves a refractor that touches a receiver lands there.
    float t_min = w.inside == 0u ? -touch * refractor_bounds.w : 0.0;
    ReceiverHit to = meet_receiver(w.p, w.d, t_min, arrives ? -1e30 : met ? h.hit.t : 1e30);
    float length_m = met ? min(length_to(to, w.p), h.hit.t) : length_to(to, w.p);
#ifdef ABSORBING
    if (w.inside != 0u && length_m < 1e30) {
      Shares before = w.share * left_of(w);
      absorb_inside(w, length_m);
      e.absorbed += before - w.share * left_of(w);
    }
#endif
#ifdef HAZE
    if (w.inside == 0u) {
      float left = air_left(photon, w.p, w.d, length_m, arrives);
      e.absorbed += w.share * (1.0 - left) * left_of(w);
      w.share *= left;
    }
    if (keeps_ways() && !arrives && w.share > 0.0)
      keep_way(photon, w, length_m, to.state != NO_RECEIVER ? to.receiver : met ? uint(h.hit.refractor) * 7919u + 65537u : 0u, owner, used);
#endif
    if (to.state == NO_RECEIVER && met) {
      float ended, dropped, absorbed;
      Shares left = left_of(w), before = w.share * left;
      branch(w, h, 0.0, ended, dropped, absorbed);
      e.trapped += (ended + dropped) * left;
      if (is_mirror(h.hit.refractor))
        e.absorbed += before - w.share * left_of(w);
      else
        e.absorbed += absorbed * left;
    } else {
      end_path(photon, w, to, owner, used, e);
      w.share = 0.0;
    }
    if (w.share <= 0.0) w = take_pending();
    going = w.share > 0.0;
  }
  if (going) {
    e.trapped += w.share * left_of(w);
    for (int k = 0; k < PENDING; k++) e.trapped += pending[k].share * left_of(pending[k]);
  }
  entry[REFLECTED] += e.reflected;
  entry[ABSORBED] += e.absorbed;
  entry[TRAPPED] += e.trapped;
  entry[MISSED] += e.missed;
}

void trace(PhotonRay photon, out Shares entry[5]) {
  for (int k = 0; k < 5; k++) entry[k] = Shares(0.0);
  uint used = 0u;
  wavelength = photon.wavelength;
#ifdef FILMS
  film_row = wavelength;
#endif
#ifdef CRYSTALS
  crystal_node = wavelength;
  for (int wave = 0; wave < 2; wave++) follow(photon, 0.5, wave, used, entry);
#else
  follow(photon, 1.0, 0, used, entry);
#endif
}
