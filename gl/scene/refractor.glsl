// Rays meeting refractors: the exact quadric of a sphere, the planes of a convex solid, or the
// front and back layers that a view sees of any other closed mesh.

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
// First hit of a ray from outside. The nearer root without cancellation.
bool sphere_front(vec4 s, vec3 o, vec3 d, inout Hit h) {
  vec3 oc = o - s.xyz;
  float b = dot(oc, d);
  vec3 across = oc - b * d;
  float disc = s.w * s.w - dot(across, across);
  if (disc <= 0.0 || b >= 0.0) return false;
  float t = -b - sqrt(disc);
  if (t <= 0.0 || t >= h.t) return false;
  h.t = t;
  h.n = normalize(across - sqrt(disc) * d);
  h.p = s.xyz + s.w * h.n;
  h.facet = 0;
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

// From within the solid, on its facet `from`: how much of the way to the plane is done in a metre, and
// the plane for which that is most. No way has that much of a plane that it goes away from.
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

#ifdef LAYERS
// Layers are sampled at their nearest texel, not fetched by its number: for that a software rasteriser
// works out the sizes of the level for each lane.

// Normal of a layer at the point's projection, bilinear over texels on the same surface.
vec3 layer_normal(View v, sampler2DArray layers, float layer, vec3 p, vec3 fallback) {
  vec3 uvz;
  project(v, p, uvz);
  ivec2 size = textureSize(layers, 0).xy;
  vec2 at = uvz.xy * vec2(size) - 0.5;
  ivec2 base = ivec2(floor(at));
  vec2 f = at - vec2(base);
  vec3 sum = vec3(0);
  for (int k = 0; k < 4; k++) {
    ivec2 o = ivec2(k & 1, k >> 1);
    vec4 texel = textureLod(layers, vec3((vec2(base + o) + 0.5) / vec2(size), layer), 0.0);
    if (texel.w <= 0.0 || abs(texel.w - uvz.z) > 0.02 * uvz.z) continue;
    sum += texel.xyz * ((o.x == 1 ? f.x : 1.0 - f.x) * (o.y == 1 ? f.y : 1.0 - f.y));
  }
  return dot(sum, sum) > 1e-8 ? normalize(sum) : fallback;
}

#ifndef LAYER_STEPS
#define LAYER_STEPS 14
#endif
#ifndef LAYER_BISECTIONS
#define LAYER_BISECTIONS 3
#endif

// How deep x lies between front and back (layers front, front + 1), along the view's ray; negative
// outside, and behind the rim of what the view sees.
float layer_depth(View v, sampler2DArray layers, float front, vec3 x, out bool at_front) {
  vec3 uvz;
  at_front = false;
  if (!project(v, x, uvz) || !inside(uvz.xy)) return -1e9;
  float near = textureLod(layers, vec3(uvz.xy, front), 0.0).w;
  float far = textureLod(layers, vec3(uvz.xy, front + 1.0), 0.0).w;
  if (near <= 0.0 || far <= 0.0) return -1e9;
  at_front = uvz.z - near < far - uvz.z;
  return min(uvz.z - near, far - uvz.z);
}

// The next wall of a solid known by its front and back layers; `size` bounds the search. The ray
// starts on a wall, so a little outside counts as inside.
void layers_inner(View v, sampler2DArray layers, float front, float size, vec3 p, vec3 d,
                  out vec3 q, out vec3 n) {
  float slack = 2e-3 * size, low = 0.0, high = -1.0;
  float above = slack, below = -1e9;  // depths there, from -slack on
  bool at_front;
  for (int i = 1; i <= LAYER_STEPS && high < 0.0; i++) {
    // Short steps first: thin parts are crossed near the start.
    float t = size * float(i * i) / float(LAYER_STEPS * LAYER_STEPS);
    float depth = layer_depth(v, layers, front, p + t * d, at_front) + slack;
    bool out_now = depth < 0.0;
    high = out_now ? t : high;
    low = out_now ? low : t;
    below = out_now ? depth : below;
    above = out_now ? above : depth;
  }
  if (high < 0.0) high = size;
  for (int k = 0; k < LAYER_BISECTIONS; k++) {
    float m = 0.5 * (low + high);
    float depth = layer_depth(v, layers, front, p + m * d, at_front) + slack;
    bool out_now = depth < 0.0;
    high = out_now ? m : high;
    low = out_now ? low : m;
    below = out_now ? depth : below;
    above = out_now ? above : depth;
  }
  // The last step is along a line, unless the ray is lost behind the rim.
  low += below < -1e8 ? 0.0 : (high - low) * clamp(above / (above - below), 0.0, 1.0);
  q = p + low * d;
  layer_depth(v, layers, front, q, at_front);
  // Past the rim the ray leaves through the side.
  vec3 side = d - dot(d, v.forward.xyz) * v.forward.xyz;
  n = layer_normal(v, layers, at_front ? front : front + 1.0, q,
                   dot(side, side) > 1e-8 ? normalize(side) : d);
  float c = dot(n, d);
  if (c < 1e-3) n = normalize(n + (1e-3 - c) * d);
}
#endif

// From p on refractor r (facet: the one that p lies on) along d inside it to the next wall.
void inner_hit(int r, int facet, vec3 p, vec3 d,
#ifdef LAYERS
               View v, sampler2DArray layers, float front_layer,
#endif
               out vec3 q, out vec3 n, out int next) {
  q = p;
  n = d;
  next = 0;
#ifdef SPHERES
  if (refractors[r].info.x == MODEL_SPHERE) {
    vec4 s = refractors[r].sphere;
    vec3 from = (p - s.xyz) / s.w;
    n = normalize(from - 2.0 * dot(from, d) * d);
    q = s.xyz + s.w * n;
    return;
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
    return;
  }
#endif
#ifdef LAYERS
  layers_inner(v, layers, front_layer, 2.0 * refractors[r].sphere.w, p, d, q, n);
#endif
}
