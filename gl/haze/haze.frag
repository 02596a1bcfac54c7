// The camera's path through a medium, metres, in alpha; IN_AIR: and the light that lights send straight to it along
// that path, added to the photon beams.
#include "refractor.glsl"
#include "receiver.glsl"
uniform sampler2D picture;  // w: distance from the camera, 0: nothing is there
uniform vec4 eye_view[6];
uniform vec2 size;  // pixels
layout(location = 0) out vec4 radiance;

#ifdef IN_AIR
uniform int steps_along;
#define STEPS_ALONG steps_along
#include "lamp_haze.glsl"
#endif

#ifdef SHAFTS_AROUND
#include "shafts.glsl"
#endif

void main() {
  vec3 o, d, rgb = vec3(0);
  view_ray(View(eye_view[0], eye_view[1], eye_view[2], eye_view[3], eye_view[4], eye_view[5]),
           gl_FragCoord.xy / size, o, d);
  float seen = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).w, from = 0.0;
  float way = seen > 0.0 ? seen : HAZE_FAR;
#ifdef IN_AIR
  way = haze_way(o, d, 0.0, way, from);
#define SHINE_ON_WAY(i) rgb += lamp_light(i, o, d, from, from + way, 0.0);
  OF_LIGHTS(SHINE_ON_WAY)
#endif
#ifdef SHAFTS_AROUND
  vec3 left = haze_eye_tint(way), per_m = -log(max(left, vec3(1e-30))) / max(way, 1e-30);
  if (way > 0.0 && way < HAZE_FAR) rgb += shafts_along(shaft_of(SHAFTS_AROUND), o + from * d, d, way, per_m);
#endif
  radiance = vec4(way > 0.0 ? rgb : vec3(0), way);
}
