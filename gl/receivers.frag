// Receivers as the eye sees them: light, shadow and spectral map in one.
// UNLIT: no light reaches what is drawn.
#define SEEN_BY_PIXELS  // neighbouring fragments are neighbouring samples
#include "refractor.glsl"
#include "receiver.glsl"
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;
uniform vec3 eye;
uniform int surface;
layout(location = 0) out vec4 radiance;  // w: distance from the eye
#ifdef LIGHT_LAYERS_OUT
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 caustic;
#endif

void main() {
  vec3 n = normalize(world_normal);
#ifdef RECEIVER_HIERARCHY
  vec3 face = cross(normalize(dFdx(world)), normalize(dFdy(world)));
  n = seen_normal(world_normal, dot(face, face) > 0.0 ? normalize(face) : n, eye - world);
#else
  if (dot(n, eye - world) < 0.0) n = -n;
#endif
  Shading s = shade(world, n, surface, surface_uv);
  radiance = vec4(s.direct + s.caustic + s.fill, distance(eye, world));
#ifdef LIGHT_LAYERS_OUT
  direct = vec4(s.direct, 1);
  caustic = vec4(s.caustic, 1);
#endif
}
