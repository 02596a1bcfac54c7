// Refractors and mirrors as the camera sees them: a ray a wavelength, and what lies on a receiver where it
// lands. What the camera does not see is as what lies at the edge of its view.
#include "image_places.glsl"
#include "image_search.glsl"
#include "image_path.glsl"
uniform sampler2D receivers_lit;
uniform sampler2D receiver_depths;
uniform mat4 eye_matrix;
uniform vec3 colour[WAVELENGTHS];
layout(location = 0) out vec4 radiance;
#ifndef AS_PRINTED
uniform mat3 rgb_from_xyz;
uniform mat3 xyz_from_rgb;
uniform float ambient;  // W/m2
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = texelFetch(receivers_lit, pixel, 0);
  vec4 front = texelFetch(object_places, ivec3(pixel, 0), 0);
  if (front.w < 0.5) return;
  vec4 clip = eye_matrix * vec4(front.xyz, 1);
  if (texelFetch(receiver_depths, pixel, 0).x < 0.5 * clip.z / clip.w + 0.5) return;
  vec3 sum = vec3(0);
  for (int i = 0; i < WAVELENGTHS; i++) {
    Ray ray;
    vec3 at, uvz, seen = vec3(0);
    if (!leave_object(pixel, i, ray)) continue;
    find_receiver(ray.o, ray.r, at);
    if (project(places_view(), at, uvz)) seen = textureLod(receivers_lit, clamp(uvz.xy, 0.0, 1.0), 0.0).rgb;
    float share = ray.share * (ray.inside > 0.0 ? exp(-ray.inside * distance(ray.o, at)) : 1.0);
#ifdef AS_PRINTED
    sum += seen * colour[i] * share;
#else
    // radiance over the squared index is the same on both sides of an interface
    sum += xyz_from_rgb * seen * colour[i] * (share / (ray.n * ray.n));
#endif
  }
#ifndef AS_PRINTED
  sum = rgb_from_xyz * sum;
#endif
  radiance = vec4(sum, distance(front.xyz, places_view().origin.xyz));
}
