// Receivers as the camera sees them: light, shadow and spectral map in one.
// UNLIT: no light reaches what is drawn.
#define SEEN_BY_PIXELS  // neighbouring fragments are neighbouring samples
#include "refractor.glsl"
#include "receiver.glsl"
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;
uniform vec3 eye;
uniform int surface;
#ifdef CHART_SIDES
layout(binding = UNIT_SIDE_OF_FACE) uniform isamplerBuffer side_of_face;  // chart's side that a face's normal points to
uniform int face_first;                                    // first face of the object that is drawn
#endif
layout(location = 0) out vec4 radiance;  // w: distance from the camera
#ifdef AOVS
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
  int side = 0;
#ifdef CHART_SIDES
  side = texelFetch(side_of_face, face_first + gl_PrimitiveID).x ^ (gl_FrontFacing ? 0 : 1);
#endif
  Shading s = shade(world, n, surface, surface_uv, side);
  radiance = vec4(s.direct + s.caustic + s.fill, distance(eye, world));
#ifdef AOVS
  direct = vec4(s.direct, 1);
  caustic = vec4(s.caustic, 1);
#endif
}
