// Refractors as the camera sees them: one direction a wavelength, each exit that carries enough
// energy followed to what it shows, and the reflection on the outside. Opaque things in front win
// by the depth test. Threads are of listed pixels: triangles smaller than a pixel cost nothing more.
// KEEPS_SIGHTS: what it finds of receivers are places, whose light sights.comp looks up.
// GLOW_RAYS: of rays that are listed what makes a refractor glow (glow_rays.glsl).
// REFINES: bands are joined first, and listed where what they show differs from what their neighbours
// show; REFINED: the listed bands by all their samples, added to the picture.
layout(local_size_x = 256) in;
#include "thread.glsl"
#define COPIES_TABLES
#include "refractor.glsl"
#include "receiver.glsl"
#include "receiver_sight.glsl"
#ifdef ENVIRONMENT
#define KEEPS_SPREAD
#endif
#include "ray_spread.glsl"
#ifdef KEEPS_SPREAD
#define SPREAD_OF(path) (path).spread
#else
#define SPREAD_OF(path) no_spread()
#endif

#ifdef LAYERS
#undef SHOWN_RECEIVERS
#endif
// Pixel as below; joined bands (a bit each), level (four bits) whose bands are wanted, and how many
// levels above it they were joined.
#ifdef REFINED
layout(std430, binding = BINDING_REFINED_PIXELS) readonly buffer RefineList {
  uint refine_count, refine_groups[3];
  uvec2 refine[];
};
layout(rgba32f, binding = 0) uniform image2D picture;
#else
layout(std430, binding = BINDING_PIXELS) readonly buffer PixelList {
  uint pixel_count, pixel_groups[3];
  uint pixel[];  // x | y << 16
};
#ifdef REFINES
layout(std430, binding = BINDING_REFINED_PIXELS) buffer RefineList {
  uint refine_count, refine_groups[3];
  uvec2 refine[];
};
#endif
#ifdef KEEPS_SIGHTS
#define SIGHTS_ACCESS
#include "sights.glsl"
#else
layout(rgba32f, binding = 0) writeonly uniform image2D picture;  // rgb, distance from the camera
#endif
#endif
uniform sampler2DArray eye_layers;    // 0: front, 1: back; normal, distance
uniform usampler2D eye_owner;         // refractor + 1
uniform vec4 eye_view[6];
uniform vec2 eye_samples;              // across and up
uniform uint pixel_first, pixel_end;  // those of the list that are looked at

uniform vec3 eye;
uniform float share_limit;
uniform mat3 xyz_from_rgb;
uniform float pixel_angle;  // rad
#ifdef SHOWN_RECEIVERS
uniform sampler2DArray eye_receivers;  // what the camera sees of them, refractors taken away; w: how far off
uniform vec2 receiver_samples;
#endif

// As in receiver.glsl.
vec4 own_eye_view[6];
vec3 own_eye;
vec2 own_eye_samples;
float own_share_limit, own_pixel_angle;
#ifdef SHOWN_RECEIVERS
vec2 own_receiver_samples;
#endif
mat3 own_xyz_from_rgb;

void copy_all() {
  copy_tables();
  copy_surroundings();
  for (int i = 0; i < 6; i++) own_eye_view[i] = read_now(eye_view[i]);
  own_eye = read_now(eye);
  own_eye_samples = read_now(eye_samples);
  own_share_limit = read_now(share_limit);
  own_pixel_angle = read_now(pixel_angle);
  own_xyz_from_rgb = read_now(xyz_from_rgb);
#ifdef SHOWN_RECEIVERS
  own_receiver_samples = read_now(receiver_samples);
#endif
}

#define eye_view own_eye_view
#define eye own_eye
#define eye_samples own_eye_samples
#define share_limit own_share_limit
#define pixel_angle own_pixel_angle
#define xyz_from_rgb own_xyz_from_rgb

int refractor;  // that this thread's pixel shows

#include "optical_depth.glsl"
#ifdef CRYSTALS
#include "crystals.glsl"
#endif
#ifdef WALK
#ifdef HAZE_BEYOND
#define KEEPS_HAZE
#endif
#include "walk.glsl"
#endif
#ifdef GLOW_RAYS
#include "wide_sum.glsl"
#endif
#include "camera_bands.glsl"

// SHARES_SPECTRUM: the samples of a pixel share the spectrum, each with wavelengths of its own. Neighbours
// take places far from each other.
#ifdef SHARES_SPECTRUM
uniform ivec2 sample_turn;  // above 0: of a picture of a mean, all of whose samples have that share
#define SAMPLE_AT(at) (sample_turn.x > 0 ? sample_turn : (at))
#else
#define SAMPLE_AT(at) (at)
#endif

int band_set_of(ivec2 at) {
#ifdef SHARES_SPECTRUM
  int x = SAMPLE_AT(at).x & 1, y = SAMPLE_AT(at).y & 1;
  return 1 + 2 * x + 3 * y - 4 * x * y;
#else
  return 0;
#endif
}

#ifdef CRYSTALS
// Waves that a ray is followed as, from the first. SHARES_WAVES: the samples of a pixel take one each.
#ifdef SHARES_WAVES
const int WAVES = 1;
int first_wave_of(ivec2 at) { return SAMPLE_AT(at).y & 1; }
#else
const int WAVES = 2;
int first_wave_of(ivec2 at) { return 0; }
#endif
int first_wave = 0;  // of what comes from no pixel as well
#endif

ivec2 pixel_of(uint listed) {
  return ivec2(listed & 0xffffu, listed >> 16);
}

View camera_view() {
  return View(eye_view[0], eye_view[1], eye_view[2], eye_view[3], eye_view[4], eye_view[5]);
}

#ifdef ROUGH
#ifndef LOBE_STATE
#define LOBE_STATE
vec2 lobe_u;  // as in walk.glsl
float lobe_width, lobe_ways;
#endif
#ifdef ENVIRONMENT
#define TURNS_SKY
#include "pinhole_sky.glsl"
#endif
#endif
float seen_at;  // how far off what was seen last is, where it is a receiver or light

#ifdef SHOWN_RECEIVERS
// A receiver shows the same from everywhere: what the camera has seen of it, where it sees that side, not too
// flatly, and no less sharply than the ray that comes along d after t.
bool shown_to_camera(Sighting at, vec3 d, float t, Spread spread, out vec3 radiance) {
  const float LEAST_FACING = 0.15, FAR_OFF = 2.0;  // FAR_OFF: samples that the place may lie off what is seen there
  View view = camera_view();
  vec3 uvz;
  bool before = project(view, at.p, uvz) && inside(uvz.xy), perspective = view.origin.w > 0.5;
  vec4 there = texelFetch(eye_receivers, ivec3(before ? uvz.xy * own_receiver_samples : vec2(0), 0), 0);
  float far = distance(eye, at.p), facing = dot(at.n, perspective ? (eye - at.p) / far : -view.forward.xyz);
  float sample_m = pixel_angle * (perspective ? far : 1.0) * eye_samples.y / own_receiver_samples.y;
  radiance = there.rgb;
#if defined(WALK) || defined(SPHERES)
  vec3 x = spread.place_x + t * spread.turn_x, y = spread.place_y + t * spread.turn_y;
  float wide = min(length(x - dot(x, d) * d), length(y - dot(y, d) * d));
  if (wide < 0.5 * sample_m) return false;
#endif
  return before && facing > LEAST_FACING && abs(there.w - far) * facing < FAR_OFF * sample_m;
}
#endif

// Radiance along the ray from p, refractors taken away, of a receiver no farther than t_max; met:
// there is one. spread: of the ray, where it meets none.
vec3 seen(vec3 p, vec3 d, Spread spread, float t_min, float t_max, out bool met) {
  float t;
  Sighting at;
#ifdef KEEPS_SIGHTS
  sight_waits = false;
#endif
  met = receiver_seen(p, d, t_min, t_max, t, at);
#ifdef ROUGH
  bool blurred = lobe_width > 0.0;  // a rough mirror shows lights itself, also those that stand for the surroundings
#else
  const bool blurred = false;
#endif
  seen_at = t;
#ifdef GLOW_RAYS
  return vec3(0);
#endif
#ifdef AREA_LIGHTS
  vec3 lamp;
  float lamp_at = met ? t : t_max;
  if (!blurred && area_light_seen(p, d, t_min, lamp_at, lamp)) {
    seen_at = lamp_at;
    met = true;
    return lamp;
  }
#endif
#if defined(ROUGH) && defined(ENVIRONMENT)
  if (!met && blurred) return background + environment_scale * sky_at(d, sky_level(lobe_width));
#endif
  if (!met) return surroundings_over(d, spread.turn_x, spread.turn_y);
#ifdef KEEPS_SIGHTS
  sight_waits = true;
  waiting_sheet = at.sheet;
  waiting_place = at.place;
  return vec3(0);
#endif
  vec3 radiance = vec3(0);
  int shown = 0;
#ifdef SHOWN_RECEIVERS
  if (shown_to_camera(at, d, t, spread, radiance)) shown = 1;
#endif
  while (shown < 1) {  // not a branch: a software rasteriser follows those for all lanes
    Shading s = shade(at.p, at.n, at.surface, at.uv, at.side);
    radiance = s.direct + s.caustic + s.fill;
    shown++;
  }
  return radiance;
}

// What the pixel's ray meets first; look() says.
bool found;
vec3 sight;
Spread sight_spread;
Hit front;
void look(ivec2 at);

void aim_at(ivec2 at) {
  vec3 o, beside;
  refractor = int(texelFetch(eye_owner, at, 0).x) - 1;
#ifdef CRYSTALS
#ifdef SHARES_SPECTRUM
  path_place = vec2(at + sample_turn);
#else
  path_place = vec2(at);
#endif
  first_wave = first_wave_of(at);
#endif
  band_set = band_set_of(at);
  view_ray(camera_view(), (vec2(at) + 0.5) / eye_samples, o, sight);
  sight_spread = no_spread();
#ifdef KEEPS_SPREAD
  view_ray(camera_view(), (vec2(at) + vec2(1.5, 0.5)) / eye_samples, o, beside);
  sight_spread.turn_x = beside - sight;
  view_ray(camera_view(), (vec2(at) + vec2(0.5, 1.5)) / eye_samples, o, beside);
  sight_spread.turn_y = beside - sight;
#endif
}

#ifdef SHAFTS
#include "shafts.glsl"
#endif
#ifdef HAZE_BEYOND
#include "haze_beyond.glsl"
#endif

#ifdef WALK
#include "refraction_walk.glsl"
#else
#include "refraction_inner.glsl"
#endif
#include "bands_wanted.glsl"

#ifdef REFINED
void add_to_picture(ivec2 at, vec3 sum) {
  vec4 others = imageLoad(picture, at);
  imageStore(picture, at, vec4(others.rgb + rgb_from_xyz * sum, others.w));
}
#else
#ifdef KEEPS_SIGHTS
// sum: XYZ of what is no receiver.
void keep_pixel(uint listed, vec3 sum, vec3 mirror) {
  uint word = listed * SIGHT_WORDS;
  for (int k = 0; k < 3; k++) {
    sight_pixels[word + uint(k)] = floatBitsToUint(sum[k]);
    sight_pixels[word + 4u + uint(k)] = floatBitsToUint(mirror[k]);
  }
  sight_pixels[word + 3u] = floatBitsToUint(found ? front.t : 0.0);
}
#endif
#ifdef REFINES
vec3 by_weight(int base, int i) { return shown_by[i] / max(bands[base + i].weight_n.xyz, 1e-12); }
#endif

// XYZ that all of the pixel's bands show.
void write_pixel(uint where, int base, int count, vec3 sum) {
#ifdef REFINES
  // Within a band the light is taken to change by half of the difference to its neighbours.
  uint asked = 0u;
  float most = MOST_WRONG * dot(sum, vec3(1)) * 2.0;
  vec3 left = sum;
  for (int i = 0; i < COARSE_BANDS; i++) {
    bool there = i < count && joined > 0 && found;
    vec3 light = shown_by[i], weight = bands[base + min(i, count - 1)].weight_n.xyz;
    vec3 before = abs(light - weight * by_weight(base, max(i - 1, 0)));
    vec3 after = abs(light - weight * by_weight(base, min(i + 1, count - 1)));
    bool wrong = there && dot(max(before, after), vec3(1)) > most;
    asked |= wrong ? 1u << uint(i) : 0u;
    left -= wrong ? light : vec3(0);
  }
  sum = left;
  if (asked != 0u)
    refine[atomicAdd(refine_count, 1u)] = uvec2(where, asked | uint(level) << 8 | uint(joined) << 12);
#endif
  // At the rim an exact surface may miss the pixel that its triangles cover: what lies behind shows.
#ifndef KEEPS_SIGHTS
  if (found) imageStore(picture, pixel_of(where), vec4(rgb_from_xyz * sum, front.t));
#endif
}
#endif

#ifdef WALK
#include "refraction_threads.glsl"
#else
#include "refraction_pixels.glsl"
#endif
#ifdef GLOW_RAYS
#include "glow_rays.glsl"
#endif
