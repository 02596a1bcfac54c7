// Rough mirrors on paths of receivers and of the camera. A path goes on by one facet, which lobe_u chooses; of lights it shows what the lobe makes of their light (rough_lamps.glsl). Who includes this sets lobe_u and
// lobe_ways and clears lobe_width before a path.

const int LOBE_WAYS = 8;
uniform vec4 rough_facets[REFRACTORS];  // roughness along the grooves and across, 0: smooth; 1: they run
uniform vec3 rough_axis[REFRACTORS];    // around the axis through the centre, 0: along it
uniform vec3 rough_centre[REFRACTORS];

#ifndef LOBE_STATE
#define LOBE_STATE
vec2 lobe_u;
float lobe_width;  // root of the solid angle for which the path stands, rad; 0: it met no rough mirror
float lobe_ways;   // that are taken off a mirror
#endif

bool is_rough(int r) { return rough_facets[r].x > 0.0; }

// The direction of number k, of LOBE_WAYS; `shift` is of the place: multiples of generalised golden ratios [Roberts2018].
vec2 lobe_way(int k, float shift) {
  return fract(vec2(0.7548776662, 0.5698402910) * float(k) + vec2(0.5, 0.25) + vec2(shift, 0.6180339887 * shift));
}

// That of a number among all that need one.
vec2 lobe_way_of(uint number) { return vec2(uvec2(3242174889u, 2447445414u) * number >> 8) * exp2(-24.0); }

// Where light comes to a rough mirror: x along the grooves, y across; wo: back along it, in x, y and n.
struct RoughHit {
  vec3 x, y, n, wo, face_n;
  vec2 facets;
};

RoughHit rough_hit(PathState w, Interface h) {
  int r = h.hit.refractor;
  float side = dot(w.d, h.face_n) < 0.0 ? 1.0 : -1.0;
  vec3 n = side * h.hit.n, face_n = side * h.face_n;
  if (dot(w.d, n) >= 0.0) n = face_n;
  vec3 along = rough_facets[r].z > 0.0 ? cross(rough_axis[r], h.hit.p - rough_centre[r]) : rough_axis[r];
  vec3 x = along - dot(along, n) * n, least = abs(n);
  vec3 other = least.x < min(least.y, least.z) ? vec3(1, 0, 0) : least.y < least.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
  x = dot(x, x) > 1e-10 * dot(along, along) ? normalize(x) : normalize(other - dot(other, n) * n);
  vec3 y = cross(n, x);
  vec3 wo = normalize(vec3(-dot(w.d, x), -dot(w.d, y), max(-dot(w.d, n), 1e-4)));
  return RoughHit(x, y, n, wo, face_n, rough_facets[r].xy);
}

// One branch goes on; returns the share that is not reflected.
float scatter_off(inout PathState w, Interface h) {
  RoughHit m = rough_hit(w, h);
  vec3 facet, wi;
  float before = w.share;
  float share = facets_sample(m.facets, m.wo, lobe_u, facet, wi);
  float pdf = facets_pdf(m.facets, m.wo, wi);
  w.share *= share;
  absorb_at_mirror(w, h.hit.refractor, min(dot(m.wo, facet), 1.0));
  w.d = keep_side(m.face_n, normalize(wi.x * m.x + wi.y * m.y + wi.z * m.n));
  w.facet = dot(w.d, h.face_n) < 0.0 ? -1 : 1;
  lobe_width = max(lobe_width, min(inversesqrt(max(pdf, 1e-6) * lobe_ways), 1.0));
  lobe_u = fract(lobe_u + vec2(0.7548776662, 0.5698402910));
  return before - w.share;
}
