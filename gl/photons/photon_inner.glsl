// A photon's light through one refractor alone: light that leaves it meets none again.

#include "inner_path.glsl"

// To look for the next outgoing segment first pays in solids that keep light inside for long, which have
// more of them than others.
#ifdef MANY_EXITS
const bool GO_ON = CHEAP_INTERFACES;
#else
const bool GO_ON = false;
#endif

#ifdef LAYERS
void layers_hit(int r, vec3 p, vec3 d, out vec3 q, out vec3 n) {
  layers_inner(pass_light.near_view, light_layers, vec2(1), 2.0 * float(light), 2.0 * refractors[r].sphere.w, p,
               d, q, n);
}
#endif

#ifdef CRYSTALS
#define MIRROR_SLOT (2 * counts.exits)
#else
#define MIRROR_SLOT counts.exits
#endif

// What media in the air leave between the light and the refractor and from there along d from p.
float outside_left(PhotonRay photon, vec3 p, vec3 d, ReceiverHit to) {
#ifdef HAZE
  return air_left(photon, photon.o, photon.d, photon.front.t, true) * air_left(photon, p, d, length_to(to, p), false);
#else
  return 1.0;
#endif
}

// The mirror on the outside takes the slot behind the outgoing segments'; it is the same for all colours.
// Returns the share that is lost.
float mirror(PhotonRay photon, uint path, float reflected) {
  if (reflected <= 0.0) return 0.0;
  Hit front = photon.front;
  vec3 d = reflect(photon.d, front.n);
  ReceiverHit to = meet_receiver(front.p, d, -touch * refractor_bounds.w, 1e30);
  uint signature = signature_of(path * 17u + to.receiver, to, uint(front.refractor));
  float left = outside_left(photon, front.p, d, to);
#ifdef HAZE
  if (keeps_ways()) {
    keep_air_way(photon, front.p, d, length_to(to, front.p),
                 clear_hit(MIRROR_SLOT, vec3(0), reflected * photon.flux * left, signature, vec4(0)));
    return 0.0;
  }
#endif
  if (to.state < HELD) return reflected;
  keep_hit(photon, clear_hit(MIRROR_SLOT, to.place, reflected * photon.flux * left, signature,
                             vec4(front.p, interface_word(front.n, false, to.tile))));
  return reflected * (1.0 - left);
}

// What a path inside has passed.
struct Inside {
#ifdef PLEOCHROIC
  Tints tints;
  vec4 depth;
#elif defined(TINTS)
  float metres;
  Attenuation attenuation;
#endif
  Shares left;  // shares of its light
};

// What leaves at interface `order`. Returns the share that is lost.
float keep_outgoing(PhotonRay photon, Outgoing o, int facet, int order, uint path, Inside inside) {
  ReceiverHit to = meet_receiver(o.p, o.d, -touch * refractor_bounds.w, 1e30);
  uint signature = signature_of(path * 31u + to.receiver, to, uint(photon.front.refractor));
  float left = outside_left(photon, o.p, o.d, to);
#ifdef FILMS
  bool bare = film_on(photon.front.refractor, facet) == BARE;  // else its transmission is not Fresnel's
#else
  const bool bare = true;
#endif
  PhotonHit hit = clear_hit(order, to.place, o.share * photon.flux * left, signature,
                            vec4(o.p, interface_word(o.n, bare, to.tile)));
#ifdef PLEOCHROIC
  hit.tints = inside.tints;
#elif defined(TINTS)
  add_tint(hit.tints, inside.attenuation.tint, inside.metres);
#endif
#ifdef HAZE
  if (keeps_ways()) {
    keep_air_way(photon, o.p, o.d, length_to(to, o.p), hit);
    return 0.0;
  }
#endif
  if (to.state < HELD) return o.share;
  keep_hit(photon, hit);
  return o.share * (1.0 - left);
}

// What so many metres inside take of light, of which so much was left before, in shares of what it began with.
Shares absorb(int r, float metres, float per_m, inout InnerRay ray, inout Inside inside) {
#ifdef PLEOCHROIC
  Shares first = ray.share * inside.left;
  vec3 amount = metres * axis_shares(crystal, ray.wave, ray.k);
  for (int axis = 0; axis < 3; axis++) {
    Attenuation a = attenuation_of(r + (axis + 1) * REFRACTORS);
    bool kept = add_tint(inside.tints, a.tint, amount[axis]);
    inside.depth += kept ? amount[axis] * a.parts : vec4(0);
    ray.share *= kept ? 1.0 : exp(-amount[axis] * per_m);
  }
  inside.left = left_after(inside.depth);
  return first - ray.share * inside.left;
#elif defined(TINTS)
  if (inside.attenuation.tint >= 0) {
    Shares before = inside.left;
    inside.metres += metres;
    inside.left = left_after(inside.metres * inside.attenuation.parts);
    return ray.share * (before - inside.left);
  }
#endif
  float before = ray.share;
  ray.share *= exp(-per_m * metres);
  return Shares(before - ray.share);
}

// What is left in the half that passes most.
float most_left(InnerRay ray, Inside inside) {
#ifdef TINTS
  return ray.share * max(inside.left.x, inside.left.y);
#else
  return ray.share;
#endif
}

// Follows the ray inside refractor r, of that index and attenuation, from interface to interface; its hits take the slots from
// `first` on. Loops have two exits, as in refraction_inner.glsl.
void follow(PhotonRay photon, int r, float n, float per_m, InnerRay ray, uint path, int first, inout Shares entry[5]) {
  Inside inside;
  inside.left = Shares(1.0);
#ifdef PLEOCHROIC
  inside.tints = no_tints();
  inside.depth = vec4(0);
#elif defined(TINTS)
  inside.metres = 0.0;
  inside.attenuation = attenuation_of(r);
#endif
  for (int order = 0; order < counts.exits;) {
    Outgoing leaving = Outgoing(ray.p, vec3(0), ray.d, 0.0);
    bool ends = false;
    while (order < counts.exits) {
      InnerHit h = next_inner_hit(r, ray);
      entry[ABSORBED] += absorb(r, distance(h.p, ray.p), per_m, ray, inside);
      path = path * 31u + uint(h.facet) + 1u;
#ifdef CRYSTALS
      path += 977u * uint(ray.wave);
#endif
#ifdef FILMS
      float before = ray.share;
#endif
      leaving = leave(r, h, n, ray);
#ifdef FILMS
      entry[ABSORBED] += (before - ray.share - leaving.share) * inside.left;
#endif
      ends = most_left(ray, inside) < share_limit;
      order++;
      if (!GO_ON || leaving.share > 0.0 || ends) break;
    }
    if (leaving.share > 0.0) entry[MISSED] += keep_outgoing(photon, leaving, ray.facet, first + order - 1, path, inside) * inside.left;
    if (ends) break;
  }
  entry[TRAPPED] += ray.share * inside.left;
}

// Each hit is handed on with its slot; `entry` takes the shares of the light that go elsewhere.
void trace(PhotonRay photon, out Shares entry[5]) {
  for (int k = 0; k < 5; k++) entry[k] = Shares(0.0);
  if (!photon.reached) return;
  Hit front = photon.front;
  int r = front.refractor;
  vec2 spectrum = spectra[r * counts.wavelengths + photon.wavelength].xy;
  float n = spectrum.x, per_m = spectrum.y;
#ifdef FILMS
  film_row = photon.wavelength;
#endif
  uint path = uint(r) * 131u + uint(front.facet);
  entry[REACHED] = Shares(1.0);
#ifdef CRYSTALS
  crystal_node = photon.wavelength;
  crystal = crystal_of(r);
  float passed = 0.0, reflected = 0.0, mirrored;
  for (int wave = 0; wave < 2; wave++) {
    InnerRay ray = enter_crystal(r, wave, front.p, front.n, front.facet, photon.d, mirrored);
    passed += ray.share;
    reflected += mirrored;
    if (ray.share > 0.0) follow(photon, r, n, per_m, ray, path + 977u * uint(wave), wave * counts.exits, entry);
  }
#ifdef FILMS
  entry[ABSORBED] += Shares(max(1.0 - passed - reflected, 0.0));
#else
  reflected = 1.0 - passed;
#endif
  entry[REFLECTED] = Shares(mirror(photon, path, reflected));
#else
  vec2 shares = face_shares(r, front.facet, true, -dot(photon.d, front.n), n);
#ifdef FILMS
  entry[ABSORBED] = Shares(1.0 - shares.x - shares.y);
#endif
  entry[REFLECTED] = Shares(mirror(photon, path, shares.x));
  InnerRay ray = InnerRay(front.p, photon.d, front.facet, shares.y);
  if (refract_direction(photon.d, front.n, 1.0 / n, ray.d)) follow(photon, r, n, per_m, ray, path, 0, entry);
#endif
}
