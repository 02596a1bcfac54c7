// Multi-refractor paths: light goes on from interface to interface of all refractors, each
// known by its own model, reflected and refracted at each. Where refractors overlap the one listed
// last is there. Who includes this gives refractor_spectrum(r): n and attenuation (1/m) of refractor
// r at the wavelength that is followed. MIRRORS: some of them are mirrors, which reflect on both sides and
// which no path is ever in; mirror_spectrum(r) gives what they reflect by. BAND_PARTS: attenuation_of(r) gives
// attenuation, 1/m, of the parts of the band that is followed, or of a mirror their factors; to photons
// (KEEPS_INTERFACE) what photon_tints.glsl says. ROUGH: some of those are rough; photons end there, and other paths go
// on by their lobe.

#if defined(TINTS) && defined(KEEPS_INTERFACE)
#define KEEPS_TINTS
#elif defined(BAND_PARTS) && !defined(KEEPS_INTERFACE)
#define KEEPS_PARTS
#include "optical_depth.glsl"
#endif
#define FOLLOWS_PATHS

struct PathState {
  vec3 p, d;
  float share;    // share of the light that it began with; BAND_PARTS: besides what `depth` has, or `passed`
  uint inside;    // bit r: within refractor r
  uint path;      // what it met and did so far, as one number
  int interfaces;  // met since the first; -1: none yet
  int refractor, facet;  // that p lies on; of a mirror, 1 or -1: on the side of its normals, or the other
#ifdef KEEPS_INTERFACE
  vec3 interface_n;      // the normal there, and whether it came through
  bool transmitted;
#endif
#ifdef KEEPS_SPREAD
  Spread spread;  // ray_spread.glsl, which comes before
#endif
#ifdef KEEPS_HAZE
  float haze_m;  // metres of the air's haze so far
#endif
#ifdef KEEPS_TINTS
  Passed passed;
  float least_depth;  // least depth of tints, in all of the band, which `share` has, and not the depth of `passed`
#endif
#ifdef KEEPS_PARTS
  Depth depth;  // depth of each part
#endif
#ifdef CRYSTALS
  int wave;  // within a crystal, or what it enters one as (crystals.glsl); and its vector. Above 1: it has left
  vec3 k;    // one, and k has the way of its field
#endif
};

struct Interface {
  Hit hit;      // n: interpolated, outwards
  vec3 face_n;  // normal of the face itself, outwards
#ifdef FILMS
  int film;
#endif
#ifdef KEEPS_SPREAD
  mat3 bend;    // how the normal turns along the face, 1/m
#endif
};

// A path of share 1, in free space.
PathState path_from(vec3 p, vec3 d) {
  PathState w;
  w.p = p;
  w.d = d;
  w.share = 1.0;
  w.inside = w.path = 0u;
  w.interfaces = w.refractor = w.facet = -1;
#ifdef KEEPS_INTERFACE
  w.interface_n = d;
  w.transmitted = false;
#endif
#ifdef KEEPS_SPREAD
  w.spread = no_spread();
#endif
#ifdef KEEPS_HAZE
  w.haze_m = 0.0;
#endif
#ifdef KEEPS_TINTS
  w.passed = none_passed();
  w.least_depth = 0.0;
#endif
#ifdef KEEPS_PARTS
  w.depth = Depth(0.0);
#endif
#ifdef CRYSTALS
  w.wave = 0;
  w.k = d;
#endif
  return w;
}

const int PENDING = 4;  // branches that wait, the strongest

vec2 refractor_spectrum(int r);

#ifdef MIRRORS
vec3 mirror_spectrum(int r);

bool is_mirror(int r) { return refractors[r].info.z < 0; }

// spectrum: a factor of what is absorbed, then a metal's n and k; k below 0: all but the factor is reflected.
float metal_reflectance(vec3 spectrum, float cos_i) {
  return spectrum.z < 0.0 ? 0.0 : fresnel_conductor(cos_i, spectrum.y, spectrum.z);
}
#else
const bool NO_MIRROR = false;
#define is_mirror(r) NO_MIRROR
#endif

int medium_of(uint inside) {
  return findMSB(inside);
}

#ifdef KEEPS_TINTS
// So much of refractor or mirror r. A path ends where all of its band is absorbed.
void pass_by(inout PathState w, int r, float amount) {
  Attenuation attenuation = attenuation_of(r);
  bool kept = add_tint(w.passed.tints, attenuation.tint, amount);
  float least = amount * (kept ? attenuation.least : 0.5 * (attenuation.parts.y + attenuation.parts.z));
  w.share *= exp(-least);
  w.least_depth += kept ? least : 0.0;
  w.passed.depth += kept ? amount * attenuation.parts - least : vec4(0);
}
#endif

#ifdef KEEPS_PARTS
// The camera's path follows what dark bands have, for they have their part in the colour.
Depth attenuation_of(int r);
#ifdef PLEOCHROIC
Depth wave_attenuation(Crystal c, int r, int wave, vec3 k);
#endif
#endif

#ifdef PLEOCHROIC
bool in_crystal(uint inside);

// Glass has no wave, whose field its axes could share.
void absorb_wave(inout PathState w, int r, float metres) {
#ifdef KEEPS_TINTS
  vec3 amount = metres * axis_shares(crystal_of(r), w.wave, w.k);
  for (int axis = 0; axis < 3; axis++) pass_by(w, r + (axis + 1) * REFRACTORS, amount[axis]);
#else
  w.depth += metres * wave_attenuation(crystal_of(r), r, w.wave, w.k);
#endif
}
#endif

// So many metres inside a refractor.
void absorb_inside(inout PathState w, float metres) {
  int r = medium_of(w.inside);
#ifdef PLEOCHROIC
  if (in_crystal(w.inside)) {
    absorb_wave(w, r, metres);
    return;
  }
#endif
#if defined(KEEPS_TINTS)
  pass_by(w, r, metres);
#elif defined(KEEPS_PARTS)
  w.depth += metres * attenuation_of(r);
#else
  w.share *= exp(-metres * refractor_spectrum(r).y);
#endif
}

#ifdef MIRRORS
void absorb_at_mirror(inout PathState w, int r, float cos_i) {
  vec3 spectrum = mirror_spectrum(r);
  float metal = metal_reflectance(spectrum, cos_i);
#if defined(KEEPS_TINTS)
  float straight = metal_reflectance(spectrum, 1.0);
  pass_by(w, r, straight > 0.0 && straight < 1.0 ? log(max(metal, 1e-30)) / log(straight) : 1.0);
#elif defined(KEEPS_PARTS)
  w.depth += mirror_depth(attenuation_of(r), metal);
#else
  w.share *= max(1.0 - spectrum.x * (1.0 - metal), 0.0);
#endif
}
#endif

// The first of refractors of one material; -1: air.
int stuff_of(uint inside) {
  return inside == 0u ? -1 : refractors[medium_of(inside)].info.w;
}

float medium_n(uint inside) {
  return inside == 0u ? 1.0 : refractor_spectrum(medium_of(inside)).x;
}

#ifdef SPHERES
// The interface of a sphere that p is in.
bool sphere_inside(vec4 s, vec3 p, vec3 d, inout Hit h) {
  vec3 across;
  float middle, half_length;
  bool meets = sphere_chord(s, p, d, across, middle, half_length);
  float t = half_length + middle;
  if (!meets || t >= h.t) return false;
  set_sphere_hit(s, max(t, 0.0), across + half_length * d, h);
  return true;
}
#endif

#ifdef CONVEX
// The interface of a convex solid that p is in; p lies on `facet`, or on none (-1).
bool convex_inside(ivec4 info, int facet, vec3 p, vec3 d, inout Hit h) {
  float nearest = h.t;
  int next = -1;
  for (int i = 0; i < PLANE_COUNT; i++) {
    vec4 plane = planes[PLANE_FIRST + i];
    float slope = dot(plane.xyz, d);
    float t = max((plane.w - dot(plane.xyz, p)) / slope, 0.0);
    bool nearer = slope > 0.0 && i != facet && t < nearest;
    nearest = nearer ? t : nearest;
    next = nearer ? i : next;
  }
  if (next < 0) return false;
  h.t = nearest;
  h.p = p + nearest * d;
  h.n = planes[PLANE_FIRST + next].xyz;
  h.facet = next;
  return true;
}
#endif

// The next surface of a refractor on the path, no farther than h.hit.t. Of each refractor only those
// faces count that lead in where the path is outside, and out where it is inside: so no path meets the
// face that it leaves, however it is rounded.
bool next_interface(PathState w, inout Interface h) {
  bool found = false;
#ifdef HIERARCHY
  TriangleHit triangle;
  triangle.t = h.hit.t;
  triangle.triangle = -1;
  int owner = -1;
#endif
  for (int r = 0; r < REFRACTORS; r++) {
    bool within = (w.inside >> r & 1u) != 0u, hit = false;
    ivec4 info = refractors[r].info;
#ifdef SPHERES
    if (info.x == MODEL_SPHERE)
      hit = within ? sphere_inside(refractors[r].sphere, w.p, w.d, h.hit)
                   : sphere_front(refractors[r].sphere, w.p, w.d, h.hit);
#endif
#ifdef CONVEX
    if (info.x == MODEL_CONVEX)
      hit = within ? convex_inside(info, w.refractor == r ? w.facet : -1, w.p, w.d, h.hit)
                   : convex_front(info, w.p, w.d, h.hit);
#endif
    if (hit) {
      h.hit.refractor = r;
      h.face_n = h.hit.n;
      found = true;
#ifdef KEEPS_SPREAD
      h.bend = mat3(info.x == MODEL_SPHERE ? 1.0 / refractors[r].sphere.w : 0.0);
#endif
#ifdef HIERARCHY
      owner = -1;
      triangle.t = h.hit.t;
#endif
    }
#ifdef HIERARCHY
    if (info.x == MODEL_HIERARCHY) {
      float least = -1e-6 * refractors[r].sphere.w;
      TriangleHit one = triangle;
#ifdef MIRRORS
      // A path that leaves a mirror meets its other side but far from where it began.
      float side = is_mirror(r) ? 0.0 : within ? -1.0 : 1.0;
      float lean = is_mirror(r) && w.refractor == r ? float(w.facet) : 0.0;
      bool met = hierarchy_hit(info.y, w.p, w.d, side, least, lean, -1e3 * least, false, one);
#else
      bool met = hierarchy_hit(info.y, w.p, w.d, within ? -1.0 : 1.0, least, false, one);
#endif
      owner = met ? r : owner;
      if (met) triangle = one;
      h.hit.t = met ? one.t : h.hit.t;
      found = found || met;
    }
#endif
  }
#ifdef HIERARCHY
  if (owner >= 0) {
    int i = triangle.triangle;
    vec4 corner = hierarchy_triangle(3 * i);
    vec3 e1 = hierarchy_triangle(3 * i + 1).xyz, e2 = hierarchy_triangle(3 * i + 2).xyz;
    vec3 n0 = hierarchy_corner(4 * i).xyz, n1 = hierarchy_corner(4 * i + 1).xyz, n2 = hierarchy_corner(4 * i + 2).xyz;
    vec3 n = (1.0 - triangle.u - triangle.v) * n0 + triangle.u * n1 + triangle.v * n2;
#ifdef KEEPS_SPREAD
    h.bend = triangle_bend(e1, e2, n0, n1, n2, n);
#endif
    h.face_n = normalize(cross(e1, e2));
    h.hit.n = dot(n, n) > 0.0 ? normalize(n) : h.face_n;
    h.hit.p = corner.xyz + triangle.u * e1 + triangle.v * e2;
    h.hit.t = max(triangle.t, 0.0);
    h.hit.facet = floatBitsToInt(corner.w);
    h.hit.refractor = owner;
  }
#endif
#ifdef FILMS
  h.film = found ? film_on(h.hit.refractor, h.hit.facet) : BARE;
#ifdef HIERARCHY
  if (owner >= 0) h.film = floatBitsToInt(hierarchy_triangle(3 * triangle.triangle + 2).w) - 1;
#endif
#endif
  return found;
}

#ifdef CRYSTALS
#include "crystal_paths.glsl"
#endif

// Both branches from an interface that w comes to; with what a film absorbs their shares add up to w's. False
// where the medium does not change: w goes on behind it.
bool split(inout PathState w, Interface h, out PathState mirrored, out float absorbed) {
  absorbed = 0.0;
  int r = h.hit.refractor;
  uint after = w.inside ^ 1u << r;
  bool entering = (w.inside >> r & 1u) == 0u;
#ifdef KEEPS_SPREAD
  w.spread = spread_at(w.spread, w.d, h.hit.t, h.face_n);
#endif
  w.p = h.hit.p;
  w.refractor = r;
  w.facet = h.hit.facet;
  mirrored = w;
  w.inside = after;
  if (stuff_of(mirrored.inside) == stuff_of(after)) return false;
  float eta = medium_n(mirrored.inside) / medium_n(after);
  vec3 n = entering ? h.hit.n : -h.hit.n, face_n = entering ? h.face_n : -h.face_n;
  if (dot(w.d, n) >= 0.0) n = face_n;
  float reflected = fresnel(-dot(w.d, n), eta);
  vec3 through;
  bool passes = refract_direction(w.d, n, eta, through), bare = true, bends = false;
  if (!passes) reflected = 1.0;
#ifdef FILMS
  // Tables have films between their refractor and air.
  if ((mirrored.inside | after) != 1u << r) h.film = BARE;
  bare = h.film == BARE;
#endif
#ifdef KEEPS_SPREAD
  mat3 bend = entering ? h.bend : -h.bend;
  mirrored.spread = spread_mirrored(w.spread, w.d, n, bend);
  w.spread = spread_refracted(w.spread, w.d, n, bend, eta);
#endif
#ifdef CRYSTALS
  bends = split_waves(after, n, h, w, mirrored, through, reflected, absorbed, passes);
#endif
#ifdef FILMS
  if (!bends && !bare) {
    vec2 shares = film_shares(h.film, entering, -dot(w.d, n), entering ? 1.0 / eta : eta);
    reflected = shares.x;
    absorbed = max(1.0 - shares.x - (passes ? shares.y : 0.0), 0.0);
  }
#endif
  absorbed *= w.share;
  mirrored.d = keep_side(face_n, bends ? mirrored.d : reflect(w.d, n));
  w.d = keep_side(-face_n, through);
  mirrored.share *= reflected;
  w.share = passes ? w.share - mirrored.share - absorbed : 0.0;
  w.interfaces = mirrored.interfaces = w.interfaces + 1;
#ifdef KEEPS_INTERFACE
  w.interface_n = mirrored.interface_n = n;
  w.transmitted = bare;  // by Fresnel's law
  mirrored.transmitted = false;
#endif
  w.path = w.path * 31u + uint(r * 2) + uint(h.hit.facet) * 7u + 1u;
  mirrored.path = w.path + 1u;
#ifdef CRYSTALS
  mirrored.path += 977u * uint(mirrored.wave);
#endif
  return true;
}

#ifdef ROUGH
#include "rough_paths.glsl"
#endif

#ifdef MIRRORS
// On from a mirror that w comes to; returns the share that the mirror absorbs.
float reflect_off(inout PathState w, Interface h) {
  int r = h.hit.refractor;
  float side = dot(w.d, h.face_n) < 0.0 ? 1.0 : -1.0, before = w.share;
  vec3 n = side * h.hit.n, face_n = side * h.face_n;
  if (dot(w.d, n) >= 0.0) n = face_n;
  w.facet = int(side);
#ifdef ROUGH
  bool rough = is_rough(r);
#ifdef KEEPS_INTERFACE
  if (rough) w.share = 0.0;
#else
  if (rough) scatter_off(w, h);
#endif
#else
  const bool rough = false;
#endif
  if (!rough) {
    absorb_at_mirror(w, r, -dot(w.d, n));
#ifdef KEEPS_SPREAD
    w.spread = spread_mirrored(spread_at(w.spread, w.d, h.hit.t, face_n), w.d, n, side * h.bend);
#endif
    w.d = keep_side(face_n, reflect(w.d, n));
  }
  w.p = h.hit.p;
  w.refractor = r;
  w.interfaces = max(w.interfaces, 0);
#ifdef KEEPS_INTERFACE
  w.interface_n = n;
  w.transmitted = false;
#endif
  w.path = w.path * 31u + uint(r * 2) + uint(h.hit.facet) * 7u + 2u;
  return before - w.share;
}
#endif

// Paths of one photon, whose functions these are. A processor's lanes index for themselves at a
// price; what a GPU indexes by no constant stays out of its registers, which four paths would fill.
PathState pending[PENDING];

// Keeps a branch for later, in the place of the weakest where there is none free; returns the share
// that is given up.
float keep_pending(PathState w) {
  int weakest = 0;
  float least = pending[0].share;
  for (int k = 1; k < PENDING; k++) {
    bool weaker = pending[k].share < least;
    least = weaker ? pending[k].share : least;
    weakest = weaker ? k : weakest;
  }
  if (w.share <= least) return w.share;
#ifdef SOFTWARE
  for (int k = 0; k < PENDING; k++)
    if (k == weakest) pending[k] = w;
#else
  pending[weakest] = w;
#endif
  return least;
}

// The strongest branch that waits; share 0: none does.
PathState take_pending() {
  int strongest = 0;
#ifdef SOFTWARE
  PathState w = pending[0];
  for (int k = 1; k < PENDING; k++) {
    bool stronger = pending[k].share > w.share;
    strongest = stronger ? k : strongest;
    if (stronger) w = pending[k];
  }
  for (int k = 0; k < PENDING; k++)
    if (k == strongest) pending[k].share = 0.0;
#else
  for (int k = 1; k < PENDING; k++) strongest = pending[k].share > pending[strongest].share ? k : strongest;
  PathState w = pending[strongest];
  pending[strongest].share = 0.0;
#endif
  return w;
}

// What may be reflected further: always at the first interface, then until too little is left or
// too many interfaces are met.
bool reflects_on(PathState mirrored) {
  return mirrored.interfaces <= 0 || (mirrored.interfaces < counts.exits && mirrored.share >= share_limit);
}

// At an interface: the stronger branch is left in w, the other waits, and of both only what carries
// `least`. Of what is not followed: the share that ends here, the one that gives its place up, and what a
// mirror or a film absorbs. A mirror has one branch, which goes on whatever it carries.
void branch(inout PathState w, Interface h, float least, out float ended, out float dropped, out float absorbed) {
  PathState mirrored;
  ended = dropped = absorbed = 0.0;
#ifdef MIRRORS
  if (is_mirror(h.hit.refractor)) {
    absorbed = reflect_off(w, h);
    return;
  }
#endif
  if (!split(w, h, mirrored, absorbed)) return;
  bool reflects = reflects_on(mirrored), passes = w.share >= least;
  ended = (reflects ? 0.0 : mirrored.share) + (passes ? 0.0 : w.share);
  if (!reflects) mirrored.share = 0.0;
  if (!passes) w.share = 0.0;
  PathState weaker = mirrored;
  if (mirrored.share > w.share) {
    weaker = w;
    w = mirrored;
  }
  dropped = keep_pending(weaker);
}
