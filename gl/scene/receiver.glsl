// Receivers and the light on them. They are hit exactly, from anywhere: parallelograms, and
// RECEIVER_HIERARCHY: triangles of all others.

#include "receiver_pages.glsl"

uniform sampler2DArray spectral_map;   // XYZ flux over window area, one layer a light; then irradiance
                                       // on receivers, one layer for the pages of a light
#ifdef TEXTURED
uniform sampler2DArray surface_texture;
#endif
#ifdef FRONT_LAYER
uniform sampler2DArray light_layers;   // refractor front (2 * light) and back (+ 1): n, distance
#endif

uniform mat3 rgb_from_xyz;
uniform vec3 ambient;     // rgb irradiance
uniform vec3 background;  // rgb radiance
uniform vec4 refractor_bounds;  // centre, radius of all refractors
uniform float scene_size;

// How far behind a refractor's wall a receiver may lie to be lit by what leaves there: a refractor
// that stands on a receiver touches it to a rounding. In radii of the refractors' bounds.
const float touch = 1e-5;

void meet_parallelogram(int i, Receiver r, vec3 o, vec3 d, float t_min, inout float t, inout int found) {
  float s = dot(r.normal.xyz, r.corner.xyz - o) / dot(r.normal.xyz, d);
  vec3 x = o + s * d - r.corner.xyz;
  vec2 uv = vec2(dot(x, r.du.xyz), dot(x, r.dv.xyz));
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
  if (hierarchy_hit(RECEIVER_ROOT, o, d, 0.0, t_min, false, h)) {
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
  return hierarchy_hit(RECEIVER_ROOT, o, d, 0.0, t_min, true, h);
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

#ifdef PAGES
// The side of a receiver's chart at which light of direction d arrives, as pages are found by it.
int chart_side(int receiver, vec3 d) {
  int chart = receiver;
  vec3 n = receivers[min(receiver, RECEIVER_ROOM - 1)].normal.xyz;
#ifdef RECEIVER_HIERARCHY
  if (receiver >= RECEIVERS) {
    int i = 3 * (receiver - RECEIVERS);
    vec4 e2 = hierarchy_triangle(i + 2);
    n = cross(hierarchy_triangle(i + 1).xyz, e2.xyz);
    chart = floatBitsToInt(e2.w);
  }
#endif
  return 2 * chart + (dot(n, d) > 0.0 ? 1 : 0);
}
#endif

#ifdef RECEIVER_HIERARCHY
vec3 face_n;  // of the face that is shaded, towards the viewer

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

// Light's direction of travel to p and its distance (directional: far beyond the scene).
void light_to(Light l, vec3 p, out vec3 d, out float distance_m) {
  if (int(l.position.w) == 2) {
    d = l.direction.xyz;
    distance_m = 4.0 * scene_size;
  } else {
    d = p - l.position.xyz;
    distance_m = length(d);
    d /= distance_m;
  }
}

// No other receiver stands between the light and p.
bool receiver_lit(int light, vec3 p, vec3 d, float distance_m) {
#ifndef RECEIVER_SHADOWS
  return true;
#else
  return !receiver_between(p - distance_m * d, d, 0.0, distance_m * (1.0 - 2e-5));
#endif
}

#ifdef SHADOW_PLANES
// In the shadow of a convex refractor: within all its planes.
bool convex_shadow(int light, int refractor, vec3 p) {
  vec3 x = int(LIGHT(light).position.w) == 2 ? p : p - LIGHT(light).position.xyz;
#ifdef ONE_SHADOW
  const int first = 0, count = SHADOW_PLANES;
#else
  ivec2 range = shadow_range[light * REFRACTORS + refractor].xy;
  int first = range.x, count = range.y;
#endif
  float most = -1e30;
#define CROSS(i) most = max(most, dot(SHADOW_PLANE(i).xyz, x) - SHADOW_PLANE(i).w);
  OF_SHADOW_PLANES(CROSS)
  return count > 0 && most < 0.0;
}
#endif

// A refractor with an exact surface stands between the light and p, or around p.
bool exact_shadow(int light, vec3 p, vec3 d, float distance_m) {
  Hit h;
  h.t = distance_m;
#ifndef SHADOW_PLANES
  return exact_front(p - distance_m * d, d, h);
#else
  bool hidden = false;
  for (int r = 0; r < REFRACTORS; r++) {
    hidden = convex_shadow(light, r, p) || hidden;
#ifdef SPHERES
    if (refractors[r].info.x == MODEL_SPHERE)
      hidden = sphere_front(refractors[r].sphere, p - distance_m * d, d, h) || hidden;
#endif
  }
  return hidden;
#endif
}

// Share of direct light that no refractor takes away on its way to p.
float refractor_shadow(int light, vec3 p, vec3 d, float distance_m) {
  if (LIGHT(light).misc.w == 0.0) return 1.0;
  if (exact_shadow(light, p, d, distance_m)) return 0.0;
#ifdef FRONT_LAYER
  vec3 uvz;
  View v = LIGHT(light).near_view;
  if (!project(v, p, uvz)) return 1.0;
  ivec2 size = textureSize(light_layers, 0).xy;
  vec2 at = uvz.xy * vec2(size) - 0.5;
#ifdef CUBES
  // What a refractor shows beyond the seam of two faces is another face's.
  if (int(LIGHT(light).cube.x) != ALL_FACES && inside(uvz.xy)) at = clamp(at, vec2(0), vec2(size - 1));
#endif
  ivec2 base = ivec2(floor(at));
  vec2 f = at - vec2(base);
  float lit = 0.0;
  for (int k = 0; k < 4; k++) {
    ivec2 o = ivec2(k & 1, k >> 1), texel = base + o;
    bool outside = any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size));
    float front = outside ? 0.0 : textureLod(light_layers, vec3((vec2(texel) + 0.5) / vec2(size), float(2 * light)), 0.0).w;
    float w = (o.x == 1 ? f.x : 1.0 - f.x) * (o.y == 1 ? f.y : 1.0 - f.y);
    lit += front <= 0.0 || front > uvz.z ? w : 0.0;
  }
  return lit;
#else
  return 1.0;
#endif
}

const float MOST_TAPS = 4.0;

// The mean of a layer over what lies between `at` and the neighbouring samples, `a` and `b` away: taps
// along the longer way, in a level whose texels are half as wide as the shorter one; of nothing outside
// rect: left, bottom, right, top, which the filter keeps to where that is the `whole` layer. All in parts
// of the layer.
vec3 layer_mean(int layer, vec2 at, vec2 a, vec2 b, vec4 rect, const bool whole) {
  // Of a neighbour that the layer does not hold nothing is known.
  a = all(lessThan(abs(a), vec2(1))) ? a : vec2(0);
  b = all(lessThan(abs(b), vec2(1))) ? b : vec2(0);
  vec2 longer = dot(a, a) > dot(b, b) ? a : b, shorter = dot(a, a) > dot(b, b) ? b : a;
  float side = float(textureSize(spectral_map, 0).x);
  float wide = length(longer) * side, narrow = max(length(shorter) * side, wide / MOST_TAPS);
  float level = max(log2(max(narrow, 1e-6)) - 0.8, 0.0);
  float taps = clamp(ceil(wide / max(narrow, 1.0) - 0.2), 1.0, MOST_TAPS);
  vec2 low = vec2(0), high = vec2(1);
  if (!whole) {
    vec2 rim = vec2(0.5 * exp2(ceil(level)) / side), middle = 0.5 * (rect.xy + rect.zw);
    low = min(rect.xy + rim, middle);
    high = max(rect.zw - rim, middle);
  }
  // No compiler can tell how often this turns, and so unroll it: a software rasteriser takes every tap of
  // an unrolled loop for all lanes, and of this one only as many as some lane wants.
  vec3 sum = vec3(0);
  float tap = 1.0 / taps, k = 0.5 * tap;
  do {
    vec2 here = at + longer * (k - 0.5);
    sum += textureLod(spectral_map, vec3(whole ? here : clamp(here, low, high), layer), level).xyz;
    k += tap;
  } while (k < 1.0);
  return sum * tap;
}

// Whether the side of a receiver at p that n points from looks to the refractors. Where its plane cuts
// their bounds, that is also the side that the light is on.
bool is_before(vec3 n, float facing, vec3 p) {
  float before = dot(n, refractor_bounds.xyz - p);
  return before > 0.0 || (before > -refractor_bounds.w && facing > 0.0);
}

// The same of a parallelogram.
bool takes_refracted(vec3 n, float facing, vec3 p) {
#ifdef CUBES
  return is_before(n, facing, p);  // they stand all around the light
#else
  return dot(n, refractor_bounds.xyz - p) > 0.0;
#endif
}

// rgb irradiance from one light on p (n faces the viewer), on a side of a chart: straight, and through
// refractors.
void light_irradiance(int light, vec3 p, vec3 n, int side, out vec3 direct, out vec3 caustic) {
  Light l = LIGHT(light);
  vec3 d;
  float distance_m;
  direct = vec3(0);
  caustic = vec3(0);
  light_to(l, p, d, distance_m);
  float facing = -dot(n, d);
#ifdef CAUSTICS
  vec3 uvz;
  bool held = project(l.map_view, p, uvz) && inside(uvz.xy);
  vec2 at = warp(light, uvz.xy);
#ifdef SEEN_BY_PIXELS
  vec2 to_right = dFdx(at), to_above = dFdy(at);  // before any pixel of the four goes its own way
#else
  const vec2 to_right = vec2(0), to_above = vec2(0);
#endif
#ifdef PAGES
  // Pages hold what reaches that side of the chart, whatever the light sees of it.
  int page = page_of_side(light, side);
  vec4 rect = page_rect(light, max(page, 0)), across = page_across(light, max(page, 0));
  vec2 texels = place_on_page(light, max(page, 0), p);
  float layer_side = float(textureSize(spectral_map, 0).x);
  vec2 on_page = texels / layer_side;
#ifdef SEEN_BY_PIXELS
  vec2 page_right = dFdx(on_page), page_above = dFdy(on_page);
#else
  const vec2 page_right = vec2(0), page_above = vec2(0);
#endif
  if (l.misc.w != 0.0 && page >= 0 && is_within(rect, texels)) {
#ifdef RECEIVER_HIERARCHY
    float steep = abs(dot(face_n, across.xyz));
#else
    const float steep = 1.0;
#endif
    caustic = rgb_from_xyz * layer_mean(page_layer(light), on_page, page_right, page_above,
                                        rect / layer_side, false) * steep;
  }
#endif
#endif
  if (!receiver_lit(light, p, d, distance_m)) return;
  bool directional = int(l.position.w) == 2;
  float falloff = directional ? 1.0 : 1.0 / (distance_m * distance_m);
  if (facing > 0.0) {
    float e = l.white.w * light_profile(l, d) * facing * falloff;
    if (e > 0.0) direct = l.white.rgb * (e * refractor_shadow(light, p, d, distance_m));
  }
#ifdef CAUSTICS
  if (l.misc.w == 0.0) return;
  // The map holds the light of the side that faces the refractors.
#ifdef RECEIVER_HIERARCHY
  facing = -dot(face_n, d);
  if (!is_before(face_n, facing, p)) return;
#else
  if (!takes_refracted(n, facing, p)) return;
#endif
  if (!held) return;
  vec3 flux = layer_mean(light, at, to_right, to_above, vec4(0, 0, 1, 1), true);
  caustic += rgb_from_xyz * flux * (abs(facing) * falloff / window_measure(l.map_view, d));
#endif
}

vec3 surface_reflectance(int surface, vec2 uv) {
  Surface s = surfaces[surface];
#ifdef TEXTURED
  if (s.texture_info.x >= 0.0)
    return s.reflectance.rgb *
           textureLod(surface_texture, vec3(uv * s.texture_info.yz, s.texture_info.x), 0.0).rgb;
#endif
  return s.reflectance.rgb;
}

struct Shading {
  vec3 direct, caustic, fill;  // radiance towards the viewer, by origin
};

// side: chart_side, where there are PAGES.
Shading shade(vec3 p, vec3 n, int surface, vec2 uv, int side) {
  Shading s;
  s.direct = s.caustic = vec3(0);
  vec3 brdf = surface_reflectance(surface, uv) / PI;
#ifndef UNLIT
  vec3 direct, caustic;
#define SHINE(i)                                             \
  {                                                          \
    light_irradiance(i, p, n, side, direct, caustic);        \
    s.direct += brdf * direct;                               \
    s.caustic += brdf * caustic;                             \
  }
  OF_LIGHTS(SHINE)
#endif
  s.fill = brdf * ambient;
  return s;
}
