// Light inside a refractor alone, from interface to interface: what photons and the camera's rays share.

// What leaves is looked up by all lanes of a software rasteriser, whether theirs leaves or not. So each may
// go on to its next interface that lets enough out first; but not where interfaces cost more than that.
#ifdef LAYERS
const bool CHEAP_INTERFACES = false;
#include "depth_layers.glsl"
// Who includes this gives the layers of its view: the next interface of refractor r, and its normal.
void layers_hit(int r, vec3 p, vec3 d, out vec3 q, out vec3 n);
#else
const bool CHEAP_INTERFACES = true;
#endif

struct InnerRay {
  vec3 p, d;
  int facet;    // that p lies on
  float share;  // share of the light that it began with
#ifdef CRYSTALS
  int wave, turns;
  vec3 k;
#endif
};

struct InnerHit {
  vec3 p, n;  // n points outwards
  int facet;
};

struct Outgoing {
  vec3 p, n, d;
  float share;  // 0: the interface reflects all
};

InnerHit next_inner_hit(int r, InnerRay ray) {
  InnerHit h;
  bool exact = inner_hit(r, ray.facet, ray.p, ray.d, h.p, h.n, h.facet);
#ifdef LAYERS
  if (!exact) layers_hit(r, ray.p, ray.d, h.p, h.n);
#endif
  return h;
}

// Shares of light that a facet of refractor r, of index n, reflects and passes.
vec2 face_shares(int r, int facet, bool outside, float cos_i, float n) {
#ifdef FILMS
  int film = film_on(r, facet);
  if (film != BARE) return film_shares(film, outside, cos_i, n);
#endif
  float reflected = fresnel(cos_i, outside ? 1.0 / n : n);
  return vec2(reflected, 1.0 - reflected);
}

#ifdef CRYSTALS
Crystal crystal;  // that is followed

// Into refractor r, as one of its waves; its part of unpolarised light, and what it mirrors of that. Share 0: it does
// not enter.
InnerRay enter_crystal(int r, int wave, vec3 p, vec3 n, int facet, vec3 d, out float mirrored) {
  InnerRay ray = InnerRay(p, d, facet, 0.0, wave, 0, d);
  bool enters = wave_from(crystal, wave, d - dot(d, n) * n, -n, ray.k, ray.d);
  vec2 field = field_parts(crystal, wave, ray.k, n);
  vec3 reflects = face_reflects(-dot(d, n), 1.0, length(ray.k));
  vec2 shares = vec2(0.0, 1.0 - dot(reflects.xy, field * field));
  shares.x = 1.0 - shares.y;
#ifdef FILMS
  int film = film_on(r, facet);
  if (film != BARE) shares = wave_film_shares(crystal, r, film, true, -dot(d, n), length(ray.k));
#endif
  ray.share = enters ? 0.5 * shares.y : 0.0;
  mirrored = enters ? 0.5 * shares.x : 0.5;
  return ray;
}

Outgoing leave(int r, InnerHit h, float n, inout InnerRay ray) {
  float size = length(ray.k), cos_i = dot(ray.k, h.n) / size;
  vec3 along = ray.k - dot(ray.k, h.n) * h.n, reflects = face_reflects(cos_i, size, 1.0);
  vec2 field = field_parts(crystal, ray.wave, ray.k, h.n);
  float reflected = dot(reflects.xy, field * field), passed = 1.0 - reflected, out2 = 1.0 - dot(along, along);
#ifdef FILMS
  int film = film_on(r, h.facet);
  if (film != BARE) {
    vec2 shares = wave_film_shares(crystal, r, film, false, cos_i, size);
    reflected = shares.x;
    passed = shares.y;
    reflects = vec3(reflected);
  }
#endif
  Outgoing o = Outgoing(h.p, h.n, normalize(along + sqrt(max(out2, 0.0)) * h.n), out2 > 0.0 ? ray.share * passed : 0.0);
  ray.share *= reflected;
  ray.p = h.p;
  ray.facet = h.facet;
  turn_wave(crystal, reflects, h.n, wave_choice(ray.turns++), ray.wave, ray.k, ray.d);
  return o;
}
#else
// What leaves where the ray meets the interface of refractor r, of index n; the rest goes on in the ray.
Outgoing leave(int r, InnerHit h, float n, inout InnerRay ray) {
  Outgoing o = Outgoing(h.p, h.n, ray.d, 0.0);
  vec2 shares = face_shares(r, h.facet, false, dot(ray.d, h.n), n);
  bool leaves = refract_direction(ray.d, -h.n, n, o.d);
  o.share = leaves ? ray.share * shares.y : 0.0;
  ray.share *= shares.x;
  ray.p = h.p;
  ray.facet = h.facet;
  ray.d = reflect(ray.d, h.n);
  return o;
}
#endif
