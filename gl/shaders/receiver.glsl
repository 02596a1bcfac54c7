// Receivers and the light on them.

#include "receiver_atlas.glsl"

uniform sampler2DArray spectral_map;   // XYZ flux over window area, one layer a light; then irradiance
                                       // on receivers, one layer for the tiles of a light
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

#ifdef COPIES_TABLES
// Read as late as these are asked for, numbers cost as much as tables (copies.glsl).
mat3 own_rgb_from_xyz;
vec3 own_ambient, own_background;
vec4 own_refractor_bounds;
float own_scene_size;

void copy_surroundings() {
  own_rgb_from_xyz = read_now(rgb_from_xyz);
  own_ambient = read_now(ambient);
  own_background = read_now(background);
  own_refractor_bounds = read_now(refractor_bounds);
  own_scene_size = read_now(scene_size);
}

#define rgb_from_xyz own_rgb_from_xyz
#define ambient own_ambient
#define background own_background
#define refractor_bounds own_refractor_bounds
#define scene_size own_scene_size
#endif

#include "surroundings.glsl"

// How far behind a refractor's interface a receiver may lie to be lit by what leaves there: a refractor
// that stands on a receiver touches it to a rounding. In radii of the refractors' bounds.
const float touch = 1e-5;

// Sums of light that comes to a receiver. RECEIVER_COLOURS: X, Y, Z, whose band is found before it
// is reflected.
#ifdef RECEIVER_COLOURS
vec3 caustic_colour(vec3 xyz) { return xyz; }
#else
vec3 caustic_colour(vec3 xyz) { return rgb_from_xyz * xyz; }
#endif

#ifdef HAZE
#include "haze.glsl"
#endif

#include "receiver_hit.glsl"
#include "area_irradiance.glsl"
#include "receiver_shadow.glsl"
#include "caustic_lookup.glsl"
#ifdef VOLUME_PAGES
#include "volume_pages.glsl"
#elif defined(VOLUME)
#include "volume_lookup.glsl"
#endif

// Irradiance from one light on p (n faces the viewer), on a side of a chart: straight, rgb, and through
// refractors, as caustic_colour.
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
  // Before any pixel of the four takes its own branch.
  vec2 at = warp(light, uvz.xy);
  vec2 to_right = STEP_RIGHT(PLACE_ON_MAP, at), to_above = STEP_ABOVE(PLACE_ON_MAP, at);
#ifdef TILES
  caustic = tile_irradiance(light, p, side, l.misc.w != 0.0);
#endif
#endif
#if defined(VOLUME_PRINTED)
  caustic = volume_irradiance(light, p, n, l.white.rgb);
#elif defined(VOLUME)
  caustic = caustic_colour(volume_irradiance(light, p, n));
#endif
#ifdef RECEIVER_HIERARCHY
  if (!receiver_lit(light, p, face_n, d, distance_m)) return;
#else
  if (!receiver_lit(light, p, n, d, distance_m)) return;
#endif
  bool directional = int(l.position.w) == 2;
  float falloff = directional ? 1.0 : 1.0 / (distance_m * distance_m);
  float e = l.white.w * light_profile(l, d) * facing * falloff;
  bool seen = facing > 0.0;
#ifdef AREA_LIGHTS
  int area_light = area_light_of(light);
  float share = area_light < 0 ? 1.0 : area_shares[area_light];
  e = share < 0.0 ? -share * l.white.w : e * share;
  seen = seen || share < 0.0;
#endif
  if (seen) {
#ifdef HAZE
    float unused;
    vec3 white = haze_light(light, haze_way(p, -d, 0.0, directional ? HAZE_FAR : distance_m, unused));
#else
    vec3 white = l.white.rgb;
#endif
    if (e > 0.0 && (facing <= 0.0 || area_lights_lit(light, p, d, distance_m)))
      direct = white * (e * (facing > 0.0 ? refractor_shadow(light, p, d, distance_m) : 1.0));
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
  caustic += caustic_colour(flux) * (abs(facing) * falloff / window_measure(l.map_view, d));
#endif
}

// What a surface makes of the rgb irradiance of a light (LIGHTS: ambient light, + 1: the environment), as
// columns; TEXTURED: of each of the texture's channels.
#ifdef REFLECTIONS_IN_STORAGE
layout(std430, binding = BINDING_REFLECTIONS) readonly buffer Reflections { vec4 reflections[]; };
#else
layout(std140, binding = BINDING_REFLECTIONS) uniform Reflections { vec4 reflections[REFLECTION_ROOM]; };
#endif

mat3 reflection_at(int row) {
  return mat3(reflections[row].xyz, reflections[row + 1].xyz, reflections[row + 2].xyz);
}

#ifdef TEXTURED
const int REFLECTION_ROWS = 9;

vec3 texture_share(int surface, vec2 uv) {
  Surface s = surfaces[surface];
  if (s.texture_info.x < 0.0) return vec3(1);
  return textureLod(surface_texture, vec3(uv * s.texture_info.yz, s.texture_info.x), 0.0).rgb;
}

mat3 reflection_of(int surface, vec3 share, int light) {
  int row = (surface * (LIGHTS + 2) + light) * REFLECTION_ROWS;
  return share.r * reflection_at(row) + share.g * reflection_at(row + 3) + share.b * reflection_at(row + 6);
}
#else
const int REFLECTION_ROWS = 3;

vec3 texture_share(int surface, vec2 uv) { return vec3(1); }

mat3 reflection_of(int surface, vec3 share, int light) {
  return reflection_at((surface * (LIGHTS + 2) + light) * REFLECTION_ROWS);
}
#endif

#ifdef RECEIVER_COLOURS
#include "receiver_colours.glsl"
#else
vec3 reflect_caustic(int surface, vec3 share, int light, mat3 reflection, vec3 rgb) { return reflection * rgb; }
#endif

#include "soft_light.glsl"
#ifdef PINHOLES
#include "pinhole_lookup.glsl"
#endif

#ifdef GLOWS
uniform vec4 glow_ball[REFRACTORS];   // what glows, as a ball that is as large from all sides: centre, radius
uniform vec3 glow_light[REFRACTORS];  // its rgb radiance

// Irradiance of all of a ball that is as bright everywhere.
vec3 glow_irradiance(vec3 p, vec3 n) {
  vec3 sum = vec3(0);
  for (int r = 0; r < REFRACTORS; r++) {
    vec3 to = glow_ball[r].xyz - p;
    float distance2 = max(max(dot(to, to), glow_ball[r].w * glow_ball[r].w), 1e-30);
    sum += glow_light[r] * (PI * glow_ball[r].w * glow_ball[r].w / distance2 * max(dot(n, to) * inversesqrt(distance2), 0.0));
  }
  return sum;
}
#endif

struct Shading {
  vec3 direct, caustic, fill;  // radiance towards the viewer, by origin
};

// side: chart_side, where there are CHART_SIDES.
Shading shade(vec3 p, vec3 n, int surface, vec2 uv, int side) {
  Shading s;
  s.direct = s.caustic = vec3(0);
  vec3 share = texture_share(surface, uv);
#ifndef UNLIT
#ifdef AREA_LIGHTS
  set_area_shares(p, n);
#endif
  vec3 direct, caustic;
#define SHINE(i)                                             \
  {                                                          \
    light_irradiance(i, p, n, side, direct, caustic);        \
    mat3 reflection = reflection_of(surface, share, i);      \
    s.direct += reflection * direct / PI;                    \
    s.caustic +=                                             \
        reflect_caustic(surface, share, i, reflection, caustic) * (LIGHT(i).white.w / PI); \
  }
  OF_LIGHTS(SHINE)
#endif
  s.fill = reflection_of(surface, share, LIGHTS) * ambient / PI;
#ifdef GLOWS
  s.fill += reflection_of(surface, share, LIGHTS) * glow_irradiance(p, n) / PI;
#endif
#ifdef ENVIRONMENT
  s.fill += reflection_of(surface, share, LIGHTS + 1) * soft_irradiance(n) / PI;
#endif
#ifdef PINHOLES
  s.caustic += reflection_of(surface, share, LIGHTS + 1) * pinhole_irradiance(p, n, surface, side) / PI;
#endif
  return s;
}
