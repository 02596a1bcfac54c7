// Receivers that rays meet, exactly and from anywhere: parallelograms, and RECEIVER_HIERARCHY: triangles
// of all others.

#include "area_lights.glsl"

void meet_parallelogram(int i, Receiver r, vec3 o, vec3 d, float t_min, inout float t, inout int found) {
  float s = (r.normal.w - dot(r.normal.xyz, o)) / dot(r.normal.xyz, d);
  vec2 uv = receiver_uv(r, o + s * d);
  // A ray within the plane gives no number, and every comparison with it is false.
  bool hit = s > t_min && s < t && min(uv.x, uv.y) >= 0.0 && max(uv.x, uv.y) <= 1.0;
  t = hit ? s : t;
  found = hit ? i : found;
}

// Nearest parallelogram on the ray; -1: none.
int parallelogram_hit(vec3 o, vec3 d, float t_min, float t_max, out float t) {
  int found = -1;
  t = t_max;
#define MEET(i) meet_parallelogram(i, RECEIVER(i), o, d, t_min, t, found);
  OF_RECEIVERS(MEET)
  return found;
}

// Nearest receiver on the ray: a parallelogram, or RECEIVERS and further a triangle; -1: none.
int receiver_hit(vec3 o, vec3 d, float t_min, float t_max, out float t) {
  int found = parallelogram_hit(o, d, t_min, t_max, t);
#ifdef RECEIVER_HIERARCHY
  TriangleHit h;
  h.t = t;
  if (hierarchy_hit(counts.receiver_root, o, d, 0.0, t_min, false, h)) {
    t = h.t;
    found = RECEIVERS + h.triangle;
  }
#endif
  return found;
}

bool receiver_between(vec3 o, vec3 d, float t_min, float t_max) {
  float t;
  if (parallelogram_hit(o, d, t_min, t_max, t) >= 0) return true;
#ifdef RECEIVER_HIERARCHY
  TriangleHit h;
  h.t = t_max;
  return hierarchy_hit(counts.receiver_root, o, d, 0.0, t_min, true, h);
#else
  return false;
#endif
}

// What is one surface to light that varies continuously: a parallelogram, a smooth part of meshes.
int receiver_part(int receiver) {
#ifdef RECEIVER_HIERARCHY
  if (receiver >= RECEIVERS)
    return RECEIVERS + floatBitsToInt(hierarchy_triangle(3 * (receiver - RECEIVERS)).w);
#endif
  return receiver;
}

// The normal of its plane, as its edges turn.
vec3 receiver_normal(int receiver) {
  vec3 n = receivers[min(receiver, RECEIVER_ROOM - 1)].normal.xyz;
#ifdef RECEIVER_HIERARCHY
  if (receiver >= RECEIVERS) {
    int i = 3 * (receiver - RECEIVERS);
    n = cross(hierarchy_triangle(i + 1).xyz, hierarchy_triangle(i + 2).xyz);
    n /= max(length(n), 1e-37);
  }
#endif
  return n;
}

#ifdef CHART_SIDES
// The side of a receiver's chart at which light of direction d arrives; tiles are found by it.
int chart_side(int receiver, vec3 d) {
  int chart = receiver;
#ifdef RECEIVER_HIERARCHY
  if (receiver >= RECEIVERS) chart = floatBitsToInt(hierarchy_triangle(3 * (receiver - RECEIVERS) + 2).w);
#endif
  return 2 * chart + (dot(receiver_normal(receiver), d) > 0.0 ? 1 : 0);
}
#endif

#ifdef RECEIVER_HIERARCHY
vec3 face_n;  // normal of the face that is shaded, towards the viewer

// The side of an interpolated normal that the viewer sees, to whom `view` points; the face's where
// that is bent away from the viewer. Sets face_n.
vec3 seen_normal(vec3 n, vec3 face, vec3 view) {
  face_n = dot(face, view) < 0.0 ? -face : face;
  vec3 side = dot(n, face_n) < 0.0 ? -n : n;
  return dot(side, view) > 0.0 ? normalize(side) : face_n;
}

// Normal, surface and texture coordinates of a triangle at x.
void triangle_at(int i, vec3 x, vec3 view, out vec3 n, out int surface, out vec2 uv) {
  vec3 from = x - hierarchy_triangle(3 * i).xyz;
  vec4 e1 = hierarchy_triangle(3 * i + 1);
  vec3 e2 = hierarchy_triangle(3 * i + 2).xyz, across_both = cross(e1.xyz, e2);
  float scale = 1.0 / dot(across_both, across_both);
  float u = dot(cross(from, e2), across_both) * scale;
  float v = dot(cross(e1.xyz, from), across_both) * scale, w = 1.0 - u - v;
  vec4 a = hierarchy_corner(4 * i), b = hierarchy_corner(4 * i + 1);
  vec4 c = hierarchy_corner(4 * i + 2), v_part = hierarchy_corner(4 * i + 3);
  n = seen_normal(w * a.xyz + u * b.xyz + v * c.xyz, normalize(across_both), view);
  surface = floatBitsToInt(e1.w);
  uv = vec2(w * a.w + u * b.w + v * c.w, w * v_part.x + u * v_part.y + v * v_part.z);
}
#endif
