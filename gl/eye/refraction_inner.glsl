// The camera's rays through one refractor alone.

#include "inner_path.glsl"

#ifdef LAYERS
void layers_hit(int r, vec3 p, vec3 d, out vec3 q, out vec3 n) {
  vec2 drawn = eye_samples / vec2(textureSize(eye_layers, 0).xy);
  layers_inner(camera_view(), eye_layers, drawn, 0.0, 2.0 * refractors[r].sphere.w, p, d, q, n);
}
#endif

// The spread of the ray's neighbours along its path: of spheres and facets; what layers show counts as flat.
#if defined(KEEPS_SPREAD) && defined(SPHERES)
mat3 bend_outwards() {
  return mat3(refractors[refractor].info.x == MODEL_SPHERE ? 1.0 / refractors[refractor].sphere.w : 0.0);
}

Spread spread_in_mirror(Hit front) {
  return spread_mirrored(spread_at(sight_spread, sight, front.t, front.n), sight, front.n, bend_outwards());
}

Spread spread_within(Hit front, float n) {
  return spread_refracted(spread_at(sight_spread, sight, front.t, front.n), sight, front.n, bend_outwards(), 1.0 / n);
}

// From p along d to an interface: outside, and further within.
Spread spread_outside(InnerHit h, vec3 p, vec3 d, float n, inout Spread within) {
  mat3 bend = -bend_outwards();
  within = spread_at(within, d, distance(h.p, p), h.n);
  Spread outside = spread_refracted(within, d, -h.n, bend, n);
  within = spread_mirrored(within, d, -h.n, bend);
  return outside;
}
#else
Spread spread_in_mirror(Hit front) { return spread_mirrored(sight_spread, front.n); }

Spread spread_within(Hit front, float n) { return spread_refracted(sight_spread, sight, front.n, 1.0 / n); }

Spread spread_outside(InnerHit h, vec3 p, vec3 d, float n, inout Spread within) {
  Spread outside = spread_refracted(within, d, -h.n, n);
  within = spread_mirrored(within, h.n);
  return outside;
}
#endif

// What is seen along a ray that leaves p on the refractor.
vec3 seen_outside(vec3 p, vec3 d, Spread spread) {
  bool met;
  vec3 radiance = seen(p, d, spread, -touch * refractor_bounds.w, 1e30, met);
#ifdef HAZE_BEYOND
  float metres = haze_begun;
  vec3 scattered = haze_beyond(p, d, met ? seen_at : HAZE_FAR, metres);
  radiance = radiance * haze_behind(metres) + scattered;
#endif
  return radiance;
}

// What a path has passed: the depth of its band's parts, or metres.
#ifdef PLEOCHROIC
#define Passed Depth
#define PASSED(metres) ((metres) * wave_attenuation(crystal, along_axes, ray.wave, ray.k))
#define WEIGHT_AFTER(passed) band_left(passed)
#define DEPTH_OF(passed) (passed)
#else
#define Passed float
#define PASSED(metres) (metres)
#ifdef BAND_PARTS
#define WEIGHT_AFTER(metres) band_left((metres) * per_m)
#define DEPTH_OF(metres) ((metres) * per_m)
#else
#define WEIGHT_AFTER(metres) (exp(-per_m * (metres)) * band_weight)
#endif
#endif

#ifdef CRYSTALS
int wave;             // that is followed
float wave_share, wave_mirrored;  // what of unpolarised light has become it, and what the first face mirrors of that
#endif

// XYZ of what the band that is taken shows, from interface to interface. What is left when the path ends shows what
// the rest has shown, in its own colour: what is still inside goes on by as much as from interface to interface. Its
// loops have two exits, with values of their own for what is used after them: of what the last turn alone has
// made, lanes that took fewer turns may find another's (Mesa 22's llvmpipe).
vec3 through(Hit front, vec3 d) {
  vec2 spectrum = refractor_spectrum(refractor);
  float n = spectrum.x;
  Passed path = Passed(0.0);
#ifdef PLEOCHROIC
  AxisDepths along_axes = axis_depths(refractor);
#endif
#ifdef BAND_PARTS
  Depth per_m = attenuation_of(refractor);
  float least_per_m = least_of(per_m);
#else
  float per_m = spectrum.y, least_per_m = per_m;
#endif
#ifdef CRYSTALS
  InnerRay ray = enter_crystal(refractor, wave, front.p, front.n, front.facet, d, wave_mirrored);
  wave_share = ray.share;
  n = length(ray.k);
#else
  InnerRay ray = InnerRay(front.p, d, front.facet, face_shares(refractor, front.facet, true, -dot(d, front.n), n).y);
#endif
  vec3 light = vec3(0), glow = vec3(0);
#ifdef KEEPS_SIGHTS
  sight_tail = vec3(0);
#endif
#ifdef CRYSTALS
  if (ray.share <= 0.0) return light;
#else
  if (!refract_direction(d, front.n, 1.0 / n, ray.d)) return light;
#endif
  // Shares of what went in: where nearly all is mirrored, the rest is followed too; and of what is
  // there when it first shows something, because dark bands have their part in the colour.
  float limit = share_limit * ray.share;
  float left = 0.0;  // share of what is left, and times its path inside
  Passed left_path = Passed(0.0);
  vec3 shown = vec3(0);
  Spread within = spread_within(front, n), outside = within;
  for (int order = 0; order < counts.exits;) {
    Outgoing leaving = Outgoing(ray.p, vec3(0), ray.d, 0.0);
    bool shows = false;
    while (order < counts.exits) {
      InnerHit h = next_inner_hit(refractor, ray);
#ifdef GLOWS
      float metres = distance(h.p, ray.p);
      glow += glow_along(refractor, ray.share, n, ray.p, ray.d, metres, DEPTH_OF(path), DEPTH_OF(PASSED(metres)));
#endif
#ifdef ABSORBING
      path += PASSED(distance(h.p, ray.p));
      limit *= shown != vec3(0) ? exp(least_per_m * distance(h.p, ray.p)) : 1.0;
#endif
#ifdef KEEPS_SPREAD
      outside = spread_outside(h, ray.p, ray.d, n, within);
#endif
      leaving = leave(refractor, h, n, ray);
      shows = leaving.share > 0.5 * limit;
      order++;
      float further = ray.share < limit || order == counts.exits ? ray.share : 0.0;
      float given_up = shows ? 0.0 : leaving.share;
      left += given_up + further;
      left_path += given_up * path + further * (path + path / float(order));
      if (!CHEAP_INTERFACES || shows || ray.share < limit) break;
    }
    if (shows) {
      vec3 weight = leaving.share * WEIGHT_AFTER(path);
      light += weight * (colour_from_rgb * seen_outside(leaving.p, leaving.d, outside));
#ifdef KEEPS_SIGHTS
      if (sight_waits) note_sight(weight, band_of_all_sets());
#endif
      shown += weight;
    }
    if (ray.share < limit) break;
  }
  vec3 tail = tail_of(shown, left * WEIGHT_AFTER(left_path / max(left, 1e-30)));
#ifdef KEEPS_SIGHTS
  sight_tail = tail;
#endif
  return light * tail + glow;
}

// On a refractor without an exact surface the ray meets what the front layer shows.
void look_at_layer(ivec2 at) {
  vec4 layer = texelFetch(eye_layers, ivec3(at, 0), 0);
  found = true;
  front.t = layer.w;
  front.p = eye + layer.w * sight;
  front.n = normalize(layer.xyz);
  float c = dot(front.n, sight);
  if (c > -1e-3) front.n = normalize(front.n - (c + 1e-3) * sight);
  front.facet = -1;
}

void look(ivec2 at) {
  aim_at(at);
  front.t = 1e30;
  found = exact_front(eye, sight, front) && front.refractor == refractor;
  if (refractors[refractor].info.x == MODEL_LAYERS) look_at_layer(at);
#ifdef HAZE_BEYOND
  begin_haze(eye, sight, front.t);
#endif
}
