// Refractors as the eye sees them: one direction a wavelength, each exit that carries enough
// energy followed to what it shows, and the reflection on the outside. Opaque things in front win
// by the depth test. One thread a listed pixel: triangles smaller than a pixel cost nothing more.
layout(local_size_x = 256) in;
#include "refractor.glsl"
#include "receiver.glsl"

layout(std430, binding = 15) readonly buffer PixelList {
  uint pixel_count, pixel_groups[3];
  uint pixel[];  // x | y << 16
};
layout(rgba32f, binding = 0) writeonly uniform image2D picture;  // rgb, distance from the eye
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
  Shading s = shade(x, n, surface, uv);
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
// Through the refractor alone, from wall to wall: the light of one band.
vec3 through(Hit front, vec3 d, int band) {
  float n = bands[band].weight_n.w;
  vec3 inner, p = front.p, light = vec3(0);
  if (!refract_direction(d, front.n, 1.0 / n, inner)) return light;
  float share = 1.0 - fresnel(-dot(d, front.n), 1.0 / n);
  int facet = front.facet;
  bool met;
  for (int order = 0; order < EXITS; order++) {
    vec3 wall, wall_n, outer;
    int next;
    inner_hit(refractor, facet, p, inner,
#ifdef LAYERS
              eye_as_view(), eye_layers, 0.0,
#endif
              wall, wall_n, next);
#ifdef ABSORBING
    share *= exp(-bands[band].attenuation.x * distance(wall, p));
#endif
    float kept = fresnel(dot(inner, wall_n), n);
    float out_share = share * (1.0 - kept);
    bool leaves = refract_direction(inner, -wall_n, n, outer);
    if (leaves && out_share > 0.5 * share_limit)
      light += out_share * seen(wall, outer, -touch * refractor_bounds.w, 1e30, met);
    share *= leaves ? kept : 1.0;
    if (share < share_limit) break;
    p = wall;
    facet = next;
    inner = reflect(inner, wall_n);
  }
  return light;
}
#endif

void main() {
  uint listed = pixel_first + gl_GlobalInvocationID.x;
  if (listed >= pixel_count) return;
  ivec2 at = ivec2(pixel[listed] & 0xffffu, pixel[listed] >> 16);
  refractor = int(texelFetch(eye_owner, at, 0).x) - 1;
  vec4 layer = texelFetch(eye_layers, ivec3(at, 0), 0);
  vec3 o, d;
  view_ray(eye_as_view(), (vec2(at) + 0.5) / vec2(textureSize(eye_owner, 0)), o, d);
#ifdef WALK
  Way start = Way(eye, d, 1.0, 0u, 0u, -1, -1, -1);
  Interface first;
  first.hit.t = 1e30;
  bool found = next_interface(start, first);
  Hit front = first.hit;
  if (found) refractor = front.refractor;
#else
  Hit front;
  front.t = 1e30;
  bool found = exact_front(eye, d, front) && front.refractor == refractor;
  if (refractors[refractor].info.x == MODEL_LAYERS) {
    found = true;
    front.t = layer.w;
    front.p = eye + layer.w * d;
    front.n = normalize(layer.xyz);
    float c = dot(front.n, d);
    if (c > -1e-3) front.n = normalize(front.n - (c + 1e-3) * d);
    front.facet = -1;
  }
#endif

  int base = refractor * BAND_COUNT, count = WAVELENGTHS;
  float wanted = wanted_bands(front, d, base, base + WAVELENGTHS - 1);
  for (int k = 0; k < BAND_LEVELS - 1; k++) {
    bool coarser = float((count + 1) / 2) >= wanted;
    base += coarser ? count : 0;
    count = coarser ? (count + 1) / 2 : count;
  }
  vec3 sum = vec3(0), mirror = vec3(0);
  for (int i = 0; i < count; i++) {
    vec4 band = bands[base + i].weight_n;
#ifdef WALK
    Way mirrored;
    vec3 light = through(start, first, base + i - refractor * BAND_COUNT, mirrored);
    mirror += mirrored.share * band.xyz;
#else
    vec3 light = through(front, d, base + i);
    mirror += fresnel(-dot(d, front.n), 1.0 / band.w) * band.xyz;
#endif
    sum += (xyz_from_rgb * light) * band.xyz;
  }
#ifdef WALK
  sum += mirror * (xyz_from_rgb * in_the_mirror(start, first, base + count / 2 - refractor * BAND_COUNT));
#else
  bool met;
  sum += mirror * (xyz_from_rgb * seen(front.p, reflect(d, front.n), -touch * refractor_bounds.w, 1e30, met));
#endif
  sum = rgb_from_xyz * sum;
  // At the rim an exact surface may miss the pixel that its triangles cover: what lies behind shows.
  imageStore(picture, at, found ? vec4(sum, front.t) : vec4(0));
}
