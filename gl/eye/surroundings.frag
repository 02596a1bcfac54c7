// What lies behind the scene, over the whole picture.
#include "common.glsl"
uniform vec3 background;
#include "surroundings.glsl"
uniform vec4 eye_view[6];
uniform vec2 samples;  // of the picture, across and down
layout(location = 0) out vec4 radiance;  // w: distance from the eye, 0: nothing is there

void main() {
  vec3 o, d;
  view_ray(View(eye_view[0], eye_view[1], eye_view[2], eye_view[3], eye_view[4], eye_view[5]),
           gl_FragCoord.xy / samples, o, d);
  radiance = vec4(surroundings(d), 0);
}
