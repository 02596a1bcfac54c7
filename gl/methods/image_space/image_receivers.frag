// Receivers: a light with a shadow map, and a caustic map that the light projects. AS_PRINTED: caustic colour,
// with diffuse shading and shadow beside it; else in units, as receiver.glsl has them. CAUSTIC_RATIOS: the map
// holds what the caustic's light is of the light's, by the window's area; with CAUSTICS_SEEN in the camera's pixels
// instead of the light's, or with CAUSTICS_WHOLE the ratio itself.
// LIT_CUBE: the light's maps are the faces of a cube around it.
#include "view.glsl"
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;
#ifdef LIT_CUBE
const int LIT_FACES = 6;
uniform sampler2DArray shadow_map;
#else
const int LIT_FACES = 1;
uniform sampler2D shadow_map;
#endif
#if defined(LIT_CUBE) && !defined(CAUSTICS_SEEN)
uniform sampler2DArray caustic_map;
#else
uniform sampler2D caustic_map;
#endif
uniform sampler2DArray surface_texture;
uniform vec4 lit_from[6 * LIT_FACES];  // the light's views
uniform float shadow_bias;  // m
uniform vec3 eye;
uniform vec4 spot;  // world direction, cosine of the cone
uniform float spot_inner;
uniform vec3 spot_colour;
uniform vec3 reflectance;
uniform vec3 texture_info;  // layer or -1, repeats
layout(location = 0) out vec4 radiance;
#ifndef AS_PRINTED
uniform mat3 rgb_from_xyz;
uniform vec3 white;     // XYZ of the light
uniform float power;    // W/sr or W/m2
uniform float ambient;  // W/m2
const float PI = 3.14159265358979;
#else
const float SCENE_AMBIENT = 0.1;
#endif
#ifdef CAUSTIC_RATIOS
uniform vec4 camera_view[6];
uniform sampler2D caustic_directions;  // sums of what arrives by direction, in the map's unit

// The caustic's irradiance, relative to what the light gives what faces it there: of a unit of the map.
float caustic_scale(View light, vec3 n, vec3 along) {
  float facing = abs(dot(n, along));
#if defined(CAUSTICS_WHOLE)
  return facing;
#elif defined(CAUSTICS_SEEN)
  View camera = View(camera_view[0], camera_view[1], camera_view[2], camera_view[3], camera_view[4], camera_view[5]);
  vec3 to = world - camera.origin.xyz, from = world - light.origin.xyz, d = normalize(to);
  return abs(dot(n, d)) * dot(from, from) / (window_measure(camera, d) * dot(to, to));
#else
  return facing / window_measure(light, along);
#endif
}

vec4 caustic_texel(sampler2D map, vec2 uv) {
#ifdef CAUSTICS_SEEN
  return texelFetch(map, ivec2(gl_FragCoord.xy), 0);
#else
  return texture(map, uv);
#endif
}

// As printed: the light's shading, along the light's own direction or that of photons.
vec3 shaded_caustic(View light, vec3 n, vec3 along, vec2 uv) {
  vec3 sum = caustic_texel(caustic_map, uv).rgb * caustic_scale(light, n, along);
#ifdef DIRECTIONS
  vec3 d = caustic_texel(caustic_directions, uv).xyz;
  float facing = max(abs(dot(n, along)), 1e-3), light_of = max(sum.y, 1e-30);
#ifdef NORMALISED_DIRECTIONS
  if (dot(d, d) > 0.0) d = caustic_texel(caustic_map, uv).y * normalize(d);
#endif
  if (dot(d, d) > 0.0) sum *= max(-dot(n, d), 0.0) * caustic_scale(light, n, along) / (facing * light_of);
#endif
  return sum;
}
#endif

// Looks up the light's view that shows a place: a number of its map, and its depth there.
#ifdef LIT_CUBE
int lit_face() { return cube_face(world - lit_from[0].xyz); }
float nearest_depth(vec2 uv, int face) { return textureLod(shadow_map, vec3(uv, face), 0.0).x; }
#else
int lit_face() { return 0; }
float nearest_depth(vec2 uv, int face) { return texture(shadow_map, uv).x; }
#endif
#ifndef CAUSTIC_RATIOS
#ifdef LIT_CUBE
vec3 caustic_light(vec2 uv, int face) { return textureLod(caustic_map, vec3(uv, face), 0.0).rgb; }
#else
vec3 caustic_light(vec2 uv, int face) { return texture(caustic_map, uv).rgb; }
#endif
#endif

void main() {
  int face = lit_face(), k = 6 * face;
  View light = View(lit_from[k], lit_from[k + 1], lit_from[k + 2], lit_from[k + 3], lit_from[k + 4], lit_from[k + 5]);
  bool perspective = light.origin.w > 0.5;
  vec3 n = normalize(world_normal), uvz;
  if (dot(n, eye - world) < 0.0) n = -n;
  vec3 along = perspective ? normalize(world - light.origin.xyz) : light.forward.xyz;
  bool seen = project(light, world, uvz) && inside(uvz.xy);
  // A depth back to what the light sees: the bias is in metres along its axis.
  float depth = nearest_depth(uvz.xy, face), near = light.range.x, far = light.range.y;
  float nearest = perspective ? near * far / (far - depth * (far - near)) : mix(near, far, depth);
  bool shaded = seen && nearest < dot(world - light.origin.xyz, light.forward.xyz) - shadow_bias;
  float c = dot(along, spot.xyz);
  float beam = spot_inner > spot.w ? smoothstep(spot.w, spot_inner, c) : step(spot.w, c);
  float facing = -dot(n, along);
#ifdef CAUSTICS_SEEN
  seen = true;
#endif
#ifdef CAUSTIC_RATIOS
  vec3 caustic = seen ? caustic_texel(caustic_map, uvz.xy).rgb : vec3(0);
#else
  vec3 caustic = seen ? caustic_light(uvz.xy, face) : vec3(0);
#endif
#ifdef AS_PRINTED
#ifdef CAUSTIC_RATIOS
  caustic = seen ? spot_colour * shaded_caustic(light, n, along, uvz.xy) : vec3(0);
#endif
  vec3 direct = shaded ? vec3(0) : spot_colour * (beam * max(facing, 0.0));
  vec3 sum = reflectance * (direct + SCENE_AMBIENT + caustic);
#else
  float falloff = perspective ? 1.0 / dot(world - light.origin.xyz, world - light.origin.xyz) : 1.0;
  vec3 xyz = shaded ? vec3(0) : white * (max(facing, 0.0) * beam);
#ifdef CAUSTIC_RATIOS
  xyz += caustic * caustic_scale(light, n, along);
#else
  xyz += caustic * (abs(facing) / window_measure(light, along));
#endif
  vec3 sum = (rgb_from_xyz * xyz * (power * falloff) + ambient) * reflectance / PI;
#endif
  if (texture_info.x >= 0.0)
    sum *= textureLod(surface_texture, vec3(surface_uv * texture_info.yz, texture_info.x), 0.0).rgb;
  radiance = vec4(sum, distance(eye, world));
}
