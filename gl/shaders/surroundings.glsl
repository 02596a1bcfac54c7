// What a ray that meets nothing shows: rgb radiance. `background` is whoever's includes this.
#ifdef ENVIRONMENT
#include "cube_mean.glsl"
layout(binding = UNIT_ENVIRONMENT) uniform sampler2D environment;  // by longitude and latitude, as scenes/environment/radiance_map.h
layout(binding = UNIT_ENVIRONMENT_CUBE) uniform sampler2D environment_cube;  // means of it over wider and wider texels
uniform mat3 environment_from_world;
uniform float environment_scale;  // from W/(m2 sr) to the scene's own units

vec3 environment_at(vec3 e) {
  vec2 at = sphere_angles(e) / PI;
  return textureLod(environment, vec2(0.5 - 0.5 * at.x, at.y), 0.0).rgb;
}
#endif

vec3 surroundings(vec3 d) {
#ifdef ENVIRONMENT
  return background + environment_scale * environment_at(normalize(environment_from_world * d));
#else
  return background;
#endif
}

// Taps of one look-up at the most, along its footprint.
#ifdef ENVIRONMENT
const int FOOTPRINT_TAPS = 8;
#else
const int FOOTPRINT_TAPS = 0;
#endif

// The mean over what is as wide as a and b around d: as it is, where a texel is wider than both.
vec3 surroundings_over(vec3 d, vec3 a, vec3 b) {
#ifdef ENVIRONMENT
  // A box as wide as w has the variance w^2 / 12, a bilinear cube of means over texels of s has s^2 / 4.
  const float WIDE_AS_BOX = 1.7320508;
  vec3 e = normalize(environment_from_world * d);
  a = environment_from_world * a;
  b = environment_from_world * b;
  float most = sqrt(max(dot(a, a), dot(b, b))), to_sphere = min(1.0, 2.0 / max(most, 1e-20));
  float texel = CUBE_TEXEL / cube_side(environment_cube);
  float finest = max(texel, PI / float(textureSize(environment, 0).y));
  float share = clamp(log2(max(most, 1e-20) / finest), 0.0, 1.0);
  vec3 wide = cube_mean(environment_cube, WIDE_AS_BOX * texel, e, to_sphere * a, to_sphere * b,
                        float(FOOTPRINT_TAPS), share > 0.0);
  return background + environment_scale * mix(environment_at(e), wide, share);
#else
  return background;
#endif
}
