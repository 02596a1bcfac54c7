// Mirrors as the camera sees them: what is all around, reflected once.
#include "common.glsl"
#include "pinholes.glsl"
in vec3 world;
in vec3 world_normal;
uniform vec3 eye, mirror_colour;
uniform float environment_scale;
layout(location = 0) out vec4 radiance;

void main() {
  vec3 n = normalize(world_normal);
  if (dot(n, eye - world) < 0.0) n = -n;
  radiance = vec4(environment_scale * mirror_colour * sky_at(mirrored(eye, world, n), 0.0), distance(eye, world));
}
