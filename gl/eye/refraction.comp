// Refractors as the eye sees them: one direction a wavelength, each exit that carries enough
// energy followed to what it shows, and the reflection on the outside. Opaque things in front win
// by the depth test. Threads are of listed pixels: triangles smaller than a pixel cost nothing more.
// REFINES: bands are joined first, and listed where what they show differs from what their neighbours
// show; REFINED: the listed bands by all their samples, added to the picture.
layout(local_size_x = 256) in;
#include "refractor.glsl"
#include "receiver.glsl"

// Pixel as below; joined bands (a bit each), level (four bits) whose bands are wanted, and how many
// levels above it they were joined.
#ifdef REFINED
layout(std430, binding = 15) readonly buffer RefineList {
  uint refine_count, refine_groups[3];
  uvec2 refine[];
};
layout(rgba32f, binding = 0) uniform image2D picture;
#else
layout(std430, binding = 15) readonly buffer PixelList {
  uint pixel_count, pixel_groups[3];
  uint pixel[];  // x | y << 16
};
#ifdef REFINES
layout(std430, binding = 7) buffer RefineList {
  uint refine_count, refine_groups[3];
  uvec2 refine[];
};
#endif
layout(rgba32f, binding = 0) writeonly uniform image2D picture;  // rgb, distance from the eye
#endif
uniform sampler2DArray eye_layers;    // 0: front, 1: back; normal, distance
uniform usampler2D eye_owner;         // refractor + 1
uniform vec4 eye_view[6];
uniform uint pixel_first;

// The samples grouped, and grouped again by twos: level 0 holds every sample, level k every 2^k as
// one. XYZ weight (sum 1) and mean index; attenuation at [i].y of the row after. Levels one after
// another.
struct Band {
  vec4 weight_n;     // XYZ, n
  vec4 attenuation;  // 1/m in x
};
#ifdef BANDS_IN_STORAGE
layout(std430, binding = 14) readonly buffer Bands { Band bands[]; };
#else
layout(std140, binding = 6) uniform Bands { Band bands[BAND_ROOM]; };
#endif
uniform vec3 eye;
uniform float share_limit;
uniform mat3 xyz_from_rgb;
uniform float pixel_angle;  // rad

int refractor;  // that this thread's pixel shows

ivec2 pixel_of(uint listed) {
  return ivec2(listed & 0xffffu, listed >> 16);
}

View eye_as_view() {
  return View(eye_view[0], eye_view[1], eye_view[2], eye_view[3], eye_view[4], eye_view[5]);
}

// Radiance along the ray from p, refractors taken away, of a receiver no farther than t_max; met:
// there is one.
vec3 seen(vec3 p, vec3 d, float t_min, float t_max, out bool met) {
  float t;
  met = false;
  int r = receiver_hit(p, d, t_min, t_max, t);
  if (r < 0) return background;
  met = true;
#ifdef RECEIVER_HIERARCHY
  Receiver rc = receivers[min(r, RECEIVER_ROOM - 1)];
#else
  Receiver rc = receivers[r];
#endif
  vec3 x = p + t * d, n = rc.normal.xyz;
  vec2 uv = vec2(dot(x - rc.corner.xyz, rc.du.xyz), dot(x - rc.corner.xyz, rc.dv.xyz));
  n = dot(n, d) > 0.0 ? -n : n;
  int surface = int(rc.corner.w);
#ifdef RECEIVER_HIERARCHY
  face_n = n;
  if (r >= RECEIVERS) triangle_at(r - RECEIVERS, x, -d, n, surface, uv);
#endif
#ifdef PAGES
  Shading s = shade(x, n, surface, uv, chart_side(r, d));
#else
  Shading s = shade(x, n, surface, uv, 0);
#endif
  return s.direct + s.caustic + s.fill;
}

#ifdef SPHERES
// How far apart in pixels the ends of the spectrum leave the first back wall, as the eye would see
// what they show; large where they show different things.
float sphere_spread(Hit front, vec3 d, int first, int last) {
  vec3 at[2];
  int what[2];
  for (int k = 0; k < 2; k++) {
    float n = bands[k == 0 ? first : last].weight_n.w;
    vec3 inner, wall_n, outer;
    refract_direction(d, front.n, 1.0 / n, inner);
    vec4 s = refractors[refractor].sphere;
    wall_n = normalize(front.n - 2.0 * dot(front.n, inner) * inner);
    refract_direction(inner, -wall_n, n, outer);
    vec3 wall = s.xyz + s.w * wall_n;
    at[k] = wall + scene_size * outer;
    what[k] = 0;
    float t;
    what[k] = receiver_hit(wall, outer, -touch * refractor_bounds.w, 1e30, t);
    if (what[k] >= 0) what[k] = receiver_part(what[k]);
    at[k] = wall + min(t, scene_size) * outer;
  }
  return what[0] != what[1] ? 1e9 : distance(at[0], at[1]) / (pixel_angle * distance(eye, at[0]));
}
#endif

// As many bands as the spread asks for, one for every pixel and a half of it. For layers it is
// estimated from the first interface alone; in facets inner reflections spread light further than
// the first exit shows, so a convex solid gets every sample.
float wanted_bands(Hit front, vec3 d, int first, int last) {
  int model = refractors[refractor].info.x;
#ifdef SPHERES
  if (model == MODEL_SPHERE) return sphere_spread(front, d, first, last) / 1.5;
#endif
  if (model == MODEL_CONVEX) return 1e9;
  float c = clamp(-dot(d, front.n), 0.05, 1.0), n = bands[last].weight_n.w;
  float turn = abs(bands[first].weight_n.w - n) * (0.2 + sqrt(1.0 - c * c) / c) / n;
  return turn * scene_size / (4.0 * front.t * pixel_angle) / 1.5;
}

#ifdef WALK
#include "refraction_walk.glsl"
#else
#include "refraction_inner.glsl"
#endif

// What the pixel's ray meets first.
bool found;
vec3 sight;
Hit front;
#ifdef WALK
Way start;
Interface first;
#endif

void look(ivec2 at) {
  vec3 o;
  refractor = int(texelFetch(eye_owner, at, 0).x) - 1;
  vec4 layer = texelFetch(eye_layers, ivec3(at, 0), 0);
  view_ray(eye_as_view(), (vec2(at) + 0.5) / vec2(textureSize(eye_owner, 0)), o, sight);
#ifdef WALK
  start = Way(eye, sight, 1.0, 0u, 0u, -1, -1, -1);
  first.hit.t = 1e30;
  found = next_interface(start, first);
  front = first.hit;
  if (found) refractor = front.refractor;
#else
  front.t = 1e30;
  found = exact_front(eye, sight, front) && front.refractor == refractor;
  if (refractors[refractor].info.x == MODEL_LAYERS) {
    found = true;
    front.t = layer.w;
    front.p = eye + layer.w * sight;
    front.n = normalize(layer.xyz);
    float c = dot(front.n, sight);
    if (c > -1e-3) front.n = normalize(front.n - (c + 1e-3) * sight);
    front.facet = -1;
  }
#endif
}

#ifndef WALK
// XYZ of what a band shows through the first interface; the share that is mirrored there.
vec3 band_light(int band, out float mirrored) {
  mirrored = fresnel(-dot(sight, front.n), 1.0 / bands[band].weight_n.w);
  return xyz_from_rgb * through(front, sight, band);
}
#endif

// The first band of the next level, where each of `count` is two of this one's.
void coarsen(bool coarser, inout int base, inout int count) {
  base += coarser ? count : 0;
  count = coarser ? (count + 1) / 2 : count;
}

#ifdef REFINED
// Where the bands that a list entry wants begin, and how many there are on its level.
void wanted_level(uint what, out int base, out int count) {
  int level = int(what >> 8 & 15u);
  base = refractor * BAND_COUNT;
  count = WAVELENGTHS;
  for (int k = 0; k < BAND_LEVELS - 1; k++) coarsen(k < level, base, count);
}

void add_to_picture(ivec2 at, vec3 sum) {
  vec4 others = imageLoad(picture, at);
  imageStore(picture, at, vec4(others.rgb + rgb_from_xyz * sum, others.w));
}
#else
#ifdef REFINES
// Of a pixel's light, what a joined band may show wrong.
const float MOST_WRONG = 0.05;

int level = 0, joined = 0;
vec3 shown_by[COARSE_BANDS];
#endif

// Those that the pixel takes: `count` from `base` on.
void choose_bands(out int base, out int count) {
  base = refractor * BAND_COUNT;
  count = WAVELENGTHS;
  float wanted = wanted_bands(front, sight, base, base + WAVELENGTHS - 1);
  for (int k = 0; k < BAND_LEVELS - 1; k++) {
    bool coarser = float((count + 1) / 2) >= wanted;
    coarsen(coarser, base, count);
#ifdef REFINES
    level += coarser ? 1 : 0;
#endif
  }
#ifdef REFINES
  for (int k = 0; k < BAND_LEVELS - 1; k++) {
    bool coarser = count > COARSE_BANDS;
    coarsen(coarser, base, count);
    joined += coarser ? 1 : 0;
  }
#endif
}

// XYZ that all of the pixel's bands show.
void write_pixel(uint where, int base, int count, vec3 sum) {
#ifdef REFINES
  // Within a band the light is taken to change by half of the way to its neighbours.
  uint asked = 0u;
  float most = MOST_WRONG * dot(sum, vec3(1)) * 2.0;
  vec3 left = sum;
  for (int i = 0; i < COARSE_BANDS; i++) {
    bool there = i < count && joined > 0 && found;
    vec3 light = shown_by[i], weight = bands[base + min(i, count - 1)].weight_n.xyz;
    vec3 before = abs(light - shown_by[max(i - 1, 0)]), after = abs(light - shown_by[min(i + 1, count - 1)]);
    bool wrong = there && dot(max(before, after), weight) > most;
    asked |= wrong ? 1u << uint(i) : 0u;
    left -= wrong ? light * weight : vec3(0);
  }
  sum = left;
  if (asked != 0u)
    refine[atomicAdd(refine_count, 1u)] = uvec2(where, asked | uint(level) << 8 | uint(joined) << 12);
#endif
  // At the rim an exact surface may miss the pixel that its triangles cover: what lies behind shows.
  if (found) imageStore(picture, pixel_of(where), vec4(rgb_from_xyz * sum, front.t));
}
#endif

#ifdef WALK
#include "refraction_ways.glsl"
#elif defined(REFINED)
void main() {
  copy_tables();
  uint listed = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (listed >= refine_count) return;
  uint what = refine[listed].y;
  ivec2 at = pixel_of(refine[listed].x);
  look(at);
  int base, count, joined = int(what >> 12 & 15u);
  wanted_level(what, base, count);
  vec3 sum = vec3(0);
  uint wanted = what & 255u;
  while (wanted != 0u) {
    int band = findLSB(wanted), end = min((band + 1) << joined, count);
    for (int i = band << joined; i < end; i++) {
      float mirrored;
      sum += band_light(base + i, mirrored) * bands[base + i].weight_n.xyz;
    }
    wanted &= wanted - 1u;
  }
  add_to_picture(at, sum);
}
#else
void main() {
  copy_tables();
  uint listed = pixel_first + gl_GlobalInvocationID.x;
  if (listed >= pixel_count) return;
  look(pixel_of(pixel[listed]));
  int base, count;
  choose_bands(base, count);
  vec3 sum = vec3(0), mirror = vec3(0);
  for (int i = 0; i < count; i++) {
    float mirrored;
    vec3 light = band_light(base + i, mirrored), weight = bands[base + i].weight_n.xyz;
    mirror += mirrored * weight;
    sum += light * weight;
#ifdef REFINES
    shown_by[i] = light;
#endif
  }
  bool met;
  sum += mirror * (xyz_from_rgb * seen(front.p, reflect(sight, front.n), -touch * refractor_bounds.w, 1e30, met));
  write_pixel(pixel[listed], base, count, sum);
}
#endif
