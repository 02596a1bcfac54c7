// What a light with a size shows (area_lights.glsl).
#include "common.glsl"
#include "area_lights.glsl"
in vec3 world;
flat in int area_light;
uniform vec3 eye;
layout(location = 0) out vec4 radiance;  // w: distance from the camera
#ifdef AOVS
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 caustic;
#endif

void main() {
  vec4 place = area_light_place[area_light];
  if (place.w > 0.0 && distance(world, place.xyz) > place.w) discard;
  bool front = dot(eye - place.xyz, area_light_facing[area_light]) > 0.0;
  radiance = vec4(front ? area_light_radiance[area_light] : vec3(0), distance(eye, world));
#ifdef AOVS
  direct = vec4(radiance.rgb, 1);
  caustic = vec4(0, 0, 0, 1);
#endif
}
