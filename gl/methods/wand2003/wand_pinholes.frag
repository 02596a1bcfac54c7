// What some pinholes show to a pixel of a receiver, whatever stands between, added to the picture.
#include "common.glsl"
#include "pinholes.glsl"
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;
uniform vec3 eye, reflectance;
uniform vec3 texture_info;  // layer or -1, repeats
uniform sampler2DArray surface_texture;
uniform float environment_scale;
uniform int first_pinhole, end_pinhole;
uniform float softening;  // m2, added to squares of distances
layout(location = 0) out vec4 radiance;

void main() {
  vec3 n = normalize(world_normal), sum = vec3(0);
  if (dot(n, eye - world) < 0.0) n = -n;
  for (int i = first_pinhole; i < end_pinhole; i++) {
    Pinhole s = pinhole_at(i, world);
    vec3 d = s.p - world;
    float d2 = max(dot(d, d), 1e-30);
    d *= inversesqrt(d2);
    float weight = s.area * max(dot(n, d), 0.0) * max(-dot(s.n, d), 0.0) / (d2 + softening);
    vec3 r = reflect(d, s.n);
#ifdef FOOTPRINTS
    vec3 by_u, by_v;
    footprint(s, world, r, by_u, by_v);
    vec3 light = weight > 0.0 ? sky_over(r, by_u, by_v, true) : vec3(0);
#else
    vec3 light = weight > 0.0 ? sky_at(r, 0.0) : vec3(0);
#endif
    sum += weight * s.colour * light;
  }
  sum *= environment_scale * reflectance / PI;
  if (texture_info.x >= 0.0)
    sum *= textureLod(surface_texture, vec3(surface_uv * texture_info.yz, texture_info.x), 0.0).rgb;
  radiance = vec4(sum, 0);
}
