// What a ray that meets nothing shows: rgb radiance. `background` is whoever's includes this.
#ifdef ENVIRONMENT
layout(binding = UNIT_ENVIRONMENT) uniform sampler2D environment;  // by longitude and latitude, as scenes/environment/radiance_map.h
uniform mat3 environment_from_world;
uniform float environment_scale;  // from W/(m2 sr) to the scene's own units
#endif

vec3 surroundings(vec3 d) {
#ifdef ENVIRONMENT
  vec3 e = normalize(environment_from_world * d);
  vec2 uv = vec2(0.5 - atan(e.y, e.x) / (2.0 * PI), acos(clamp(e.z, -1.0, 1.0)) / PI);
  return background + environment_scale * textureLod(environment, uv, 0.0).rgb;
#else
  return background;
#endif
}
