// Photons as points of one pixel.
#include "wyman_target.glsl"
uniform sampler2D photon_places, photon_directions;
uniform int grid;
uniform vec3 colour;
uniform float strength;  // pixels that a cell of the grid has the window area of
flat out vec4 light;     // solid angle by a pixel's window area; how many
flat out vec3 direction;

void main() {
  ivec2 cell = ivec2(gl_VertexID % grid, gl_VertexID / grid);
  vec4 place = texelFetch(photon_places, cell, 0), incident = texelFetch(photon_directions, cell, 0);
  vec3 uvz;
  light = vec4(0);
  direction = vec3(0);
  gl_PointSize = 1.0;
  gl_Position = vec4(2, 2, 2, 1);  // outside
  if (place.w <= 0.0 || !project(drawn_view(), place.xyz, uvz) || !inside(uvz.xy)) return;
#ifdef IN_CAMERA
  if (!shows(place.xyz, ivec2(uvz.xy * vec2(textureSize(drawn_places, 0))))) return;
#endif
  float share = strength * place.w * incident.w;
  light = vec4(share * colour, 1);
  direction = share * incident.xyz;
  gl_Position = vec4(2.0 * uvz.xy - 1.0, 0, 1);
}
