// Data that every pass shares. Lengths in metres, directions unit, world space.

#include "view.glsl"
#include "counts.glsl"

const float PI = 3.14159265358979;

struct Light {
  View near_view;  // tight around the refractors: photon grid, front and back layers
  View map_view;   // around what the photons reach: spectral map
  vec4 position;   // w: 0 point, 1 spot, 2 directional, 3 or 4 a point of a disk or rectangle
  vec4 direction;  // w: cosine of the cone's half angle
  vec4 white;      // rgb of unit power; w: power, W/sr or W/m2
  vec4 misc;       // cosine where the soft edge starts; flux of one map unit, of unit power; photons by window area;
                   // whether it meets a refractor
  vec4 cube;       // faces of the cube around it whose light this is, a bit each; number from 1 of the light with a
                   // size that it is a point of, or 0; radius of its part, m, of a directional light its tangent
};

struct Refractor {
  vec4 sphere;  // centre, radius
  ivec4 info;   // model, first plane or root of its hierarchy, planes (-1: it is a mirror), first of the
                // same material
};

struct Receiver {  // a parallelogram, known from a place of it, the anchor
  vec4 anchor, u, v, normal;  // anchor.w: surface; normal.w: dot(normal, x) in its plane
  vec4 du, dv;                // dual edges and the anchor's own coordinates: u is dot(x - anchor, du) + du.w
};

// How far x is from the anchor in parts of both edges, and its coordinates, from 0 to 1.
vec2 off_anchor(Receiver r, vec3 x) { return vec2(dot(x - r.anchor.xyz, r.du.xyz), dot(x - r.anchor.xyz, r.dv.xyz)); }
vec2 receiver_uv(Receiver r, vec3 x) { return off_anchor(r, x) + vec2(r.du.w, r.dv.w); }

struct Surface {
  vec4 texture_info; // layer or -1, repeat u, repeat v
};

const int MODEL_SPHERE = 0;
const int MODEL_CONVEX = 1;
const int MODEL_LAYERS = 2;
const int MODEL_HIERARCHY = 3;

// Tables of the scene. They are uniform blocks wherever they fit: a software rasteriser reads
// those far faster than storage. ROOM: the capacity, at least one element, whatever the count.
layout(std140, binding = BINDING_LIGHTS) uniform Lights { Light lights[LIGHT_ROOM]; };
layout(std140, binding = BINDING_REFRACTORS) uniform Refractors { Refractor refractors[REFRACTOR_ROOM]; };
#ifdef PLANES_IN_STORAGE
layout(std430, binding = BINDING_PLANES) readonly buffer Planes { vec4 planes[]; };
#else
layout(std140, binding = BINDING_PLANES) uniform Planes { vec4 planes[PLANE_ROOM]; };  // n . x <= w
#endif
layout(std140, binding = BINDING_RECEIVERS) uniform Receivers { Receiver receivers[RECEIVER_ROOM]; };
#ifdef SURFACES_IN_STORAGE
layout(std430, binding = BINDING_SURFACES) readonly buffer Surfaces { Surface surfaces[]; };
#else
layout(std140, binding = BINDING_SURFACES) uniform Surfaces { Surface surfaces[SURFACE_ROOM]; };
#endif
// n, attenuation and of that what is scattered (1/m) at [refractor * wavelengths + i], last of the air; of a mirror the n by which its light is laid, and
// from the second on what walk.glsl reflects by.
#ifdef SPECTRA_IN_STORAGE
layout(std430, binding = BINDING_SPECTRA) readonly buffer Spectra { vec4 spectra[]; };
#else
layout(std140, binding = BINDING_SPECTRA) uniform Spectra { vec4 spectra[SPECTRUM_ROOM]; };
#endif
#include "copies.glsl"

// The map's texels are finer where more light lands: each axis of its window is warped by a
// monotone polygon. Its corners at light * WARP_STEPS + k, and what follows them, from 0 to 1: x, y, x, y.
// As texels: a software rasteriser fetches four numbers at once, and blocks number by number.
const int WARP_STEPS = 128;
layout(binding = UNIT_WARPS) uniform samplerBuffer warps;

vec2 warp(int light, vec2 uv) {
  vec2 s = clamp(uv, vec2(0), vec2(1)) * float(WARP_STEPS);
  ivec2 k = min(ivec2(s), ivec2(WARP_STEPS - 1));
  vec2 f = s - vec2(k);
  vec4 x = texelFetch(warps, light * WARP_STEPS + k.x), y = texelFetch(warps, light * WARP_STEPS + k.y);
  return vec2(mix(x.x, x.z, f.x), mix(y.y, y.w, f.y));
}

#ifdef CUBES
const int ALL_FACES = 63;
#endif

float light_profile(Light l, vec3 direction) {
#ifdef CUBES
  if ((int(l.cube.x) >> cube_face(direction) & 1) == 0) return 0.0;
#endif
  int kind = int(l.position.w);
  float c = dot(direction, l.direction.xyz);
  if (kind >= 3) return max(c, 0.0);
  if (kind != 1) return 1.0;
  float outer = l.direction.w, inner = l.misc.x;
  if (inner <= outer) return c >= outer ? 1.0 : 0.0;
  return smoothstep(outer, inner, c);
}
