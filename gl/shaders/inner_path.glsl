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
