// Rays meeting refractors with an exact surface: the quadric of a sphere, the planes of a convex solid.

#include "common.glsl"
#include "optics.glsl"
#if defined(HIERARCHY) || defined(RECEIVER_HIERARCHY)
#include "hierarchy.glsl"
#endif

struct Hit {
  vec3 p, n;  // n points outwards
  float t;
  int refractor, facet;
};

#ifdef SPHERES
// What of the ray lies in the sphere: from `middle` on it half its length to either side; across: from the centre to
// there.
bool sphere_chord(vec4 s, vec3 o, vec3 d, out vec3 across, out float middle, out float half_length) {
  vec3 oc = o - s.xyz;
  float b = dot(oc, d);
  across = oc - b * d;
  float disc = s.w * s.w - dot(across, across);
  middle = -b;
  half_length = sqrt(max(disc, 0.0));
  return disc > 0.0;
}

void set_sphere_hit(vec4 s, float t, vec3 radius, inout Hit h) {
  h.t = t;
  h.n = normalize(radius);
  h.p = s.xyz + s.w * h.n;
  h.facet = 0;
}

// First hit of a ray from outside. The nearer root without cancellation.
bool sphere_front(vec4 s, vec3 o, vec3 d, inout Hit h) {
  vec3 across;
  float middle, half_length;
  bool meets = sphere_chord(s, o, d, across, middle, half_length);
  float t = middle - half_length;
  if (!meets || middle <= 0.0 || t <= 0.0 || t >= h.t) return false;
  set_sphere_hit(s, t, across - half_length * d, h);
  return true;
}
#endif

#ifdef CONVEX
void enter_plane(int i, vec4 plane, vec3 o, vec3 d, inout float enter, inout float leave, inout int facet) {
  float slope = dot(plane.xyz, d), gap = plane.w - dot(plane.xyz, o);
  float t = gap / slope;
  bool in_ = slope < 0.0, out_ = slope > 0.0, beside = slope == 0.0 && gap < 0.0;
  bool nearer = in_ && t > enter;
  enter = nearer ? t : enter;
  facet = nearer ? i : facet;
  leave = beside ? -1.0 : out_ ? min(leave, t) : leave;
}

// From within the solid, on its facet `from`: how much of the distance to the plane is done in a metre, and
// the plane for which that is most. No ray has that much of a plane that it goes away from.
void leave_plane(int i, vec4 plane, int from, vec3 p, vec3 d, inout float most, inout int facet) {
  float rate = dot(plane.xyz, d) / max(plane.w - dot(plane.xyz, p), 1e-30);
  bool nearer = rate > most && i != from;
  most = nearer ? rate : most;
  facet = nearer ? i : facet;
}

bool convex_front(ivec4 info, vec3 o, vec3 d, inout Hit h) {
  float enter = 0.0, leave = h.t;
  int facet = -1;
#define ENTER(i) enter_plane(i, PLANE(i), o, d, enter, leave, facet);
  OF_PLANES(ENTER)
  if (facet < 0 || enter >= leave) return false;
  h.t = enter;
  h.p = o + enter * d;
  h.n = planes[PLANE_FIRST + facet].xyz;
  h.facet = facet;
  return true;
}
#endif

// Nearest refractor with an exact surface; h.t is the farthest that counts.
bool exact_front(vec3 o, vec3 d, inout Hit h) {
  bool found = false;
  for (int r = 0; r < REFRACTORS; r++) {
    bool hit = false;
#ifdef SPHERES
    if (refractors[r].info.x == MODEL_SPHERE) hit = sphere_front(refractors[r].sphere, o, d, h);
#endif
#ifdef CONVEX
    if (refractors[r].info.x == MODEL_CONVEX) hit = convex_front(refractors[r].info, o, d, h);
#endif
    if (hit) {
      h.refractor = r;
      found = true;
    }
  }
  return found;
}

// From p on refractor r (facet: the one that p lies on) along d inside it to the next interface.
// False where r has no exact surface.
bool inner_hit(int r, int facet, vec3 p, vec3 d, out vec3 q, out vec3 n, out int next) {
  q = p;
  n = d;
  next = 0;
#ifdef SPHERES
  if (refractors[r].info.x == MODEL_SPHERE) {
    vec4 s = refractors[r].sphere;
    vec3 from = (p - s.xyz) / s.w;
    n = normalize(from - 2.0 * dot(from, d) * d);
    q = s.xyz + s.w * n;
    return true;
  }
#endif
#ifdef CONVEX
  if (refractors[r].info.x == MODEL_CONVEX) {
    ivec4 info = refractors[r].info;
    float most = 0.0;
#define LEAVE(i) leave_plane(i, PLANE(i), facet, p, d, most, next);
    OF_PLANES(LEAVE)
    q = p + (most > 0.0 ? 1.0 / most : 0.0) * d;
    n = planes[PLANE_FIRST + next].xyz;
    return true;
  }
#endif
  return false;
}

#ifdef FILMS
// Thin films on faces of refractors (gl/scene/spectra/camera_bands.h): shares of unpolarised light, by the angle in
// air. Who follows a wavelength or a band sets film_row.
layout(binding = UNIT_FILMS) uniform samplerBuffer film_texels;
int film_row;
const int BARE = -1;

// The film on a facet that is known by its number.
int film_on(int r, int facet) {
  int whole = int(texelFetch(film_texels, r).x);
  if (whole >= BARE) return whole;
  return facet < 0 ? BARE : int(texelFetch(film_texels, REFRACTORS + refractors[r].info.y + facet).x);
}

// What it reflects, and what it passes, of light that comes to a refractor of index n from outside, or from inside.
vec2 film_shares(int film, bool outside, float cos_i, float n) {
  float c = clamp(cos_i, 0.0, 1.0), in_air = outside ? c * c : cos2_refracted(c, n);
  float deep = (n - 1.0) * (n + 1.0), beyond = sqrt(clamp(-in_air / deep, 0.0, 1.0));  // of total reflection
  float rest = min(n * c * inversesqrt(deep), 1.0);                                    // root of 1 less its square
  float x = float(FILM_ANGLES) * (1.0 + (in_air > 0.0 ? sqrt(min(in_air, 1.0)) : -beyond / (1.0 + rest)));
  int at = clamp(int(x), 0, 2 * FILM_ANGLES - 1);
  int row = film * (counts.wavelengths + BAND_SETS * counts.bands) + film_row;
  int texel = REFRACTORS + PLANE_ROOM + row * (2 * FILM_ANGLES + 1) + at;
  vec4 shares = mix(texelFetch(film_texels, texel), texelFetch(film_texels, texel + 1), x - float(at));
  return vec2(outside ? shares.x : shares.y, shares.z);
}
#endif
