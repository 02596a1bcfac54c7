// Haze in the air that the camera's ray runs through behind a refractor or in a mirror.
const int STEPS_ALONG = 16;
#include "lamp_haze.glsl"

float haze_begun;       // metres of it before, on the camera's own path
vec3 haze_begun_tint;  // what these leave of white: the pass that lays haze over the picture takes it off

void begin_haze(vec3 o, vec3 d, float length_m) {
  float first;
  haze_begun = haze_way(o, d, 0.0, length_m, first);
  haze_begun_tint = max(haze_air_tint(haze_begun), vec3(1e-9));
}

vec3 haze_behind(float metres) { return haze_air_tint(metres) / haze_begun_tint; }

// What it scatters along length_m from p; metres of it before, and then behind.
vec3 haze_beyond(vec3 p, vec3 d, float length_m, inout float metres) {
  float first, way = haze_way(p, d, 0.0, length_m, first), before = metres;
  vec3 sum = vec3(0);
  metres += way;
  if (way <= 0.0) return sum;
#define SHINE_BEYOND(i) sum += lamp_light(i, p, d, first, first + way, before);
  OF_LIGHTS(SHINE_BEYOND)
#ifdef SHAFTS
  int k = shaft_of(-1);
  vec3 left = haze_air_tint(before), per_m = log(max(left, vec3(1e-30)) / max(haze_air_tint(metres), vec3(1e-30))) / way;
  if (k >= 0) sum += left * shafts_along(k, p + first * d, d, way, per_m);
#endif
  return sum / haze_begun_tint;
}
