// Receivers by what is all around, as if nothing hid it, and by ambient light.
#include "common.glsl"
uniform vec3 background;
#include "surroundings.glsl"
#include "soft_light.glsl"
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;
uniform vec3 eye, ambient, reflectance;
uniform vec3 texture_info;  // layer or -1, repeats
uniform sampler2DArray surface_texture;
layout(location = 0) out vec4 radiance;  // w: distance from the camera

void main() {
  vec3 n = normalize(world_normal);
  if (dot(n, eye - world) < 0.0) n = -n;
  vec3 sum = reflectance * (soft_irradiance(n) + ambient) / PI;
  if (texture_info.x >= 0.0)
    sum *= textureLod(surface_texture, vec3(surface_uv * texture_info.yz, texture_info.x), 0.0).rgb;
  radiance = vec4(sum, distance(eye, world));
}
