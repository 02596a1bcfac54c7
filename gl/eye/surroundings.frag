// What lies behind the scene, over the whole picture.
#include "common.glsl"
uniform vec3 background;
#include "surroundings.glsl"
uniform vec4 eye_view[6];
uniform vec2 receiver_samples;  // across and up
layout(location = 0) out vec4 radiance;  // w: distance from the camera, 0: nothing is there

void main() {
  View view = View(eye_view[0], eye_view[1], eye_view[2], eye_view[3], eye_view[4], eye_view[5]);
  vec3 o, d, right, above;
  view_ray(view, gl_FragCoord.xy / receiver_samples, o, d);
  view_ray(view, (gl_FragCoord.xy + vec2(1, 0)) / receiver_samples, o, right);
  view_ray(view, (gl_FragCoord.xy + vec2(0, 1)) / receiver_samples, o, above);
  radiance = vec4(surroundings_over(d, right - d, above - d), 0);
}
