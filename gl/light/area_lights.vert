// Lights with a size as the camera sees them: two triangles each.
#include "common.glsl"
#include "area_lights.glsl"
uniform mat4 view_projection;
out vec3 world;
flat out int area_light;

void main() {
  area_light = gl_VertexID / 6;
  int turn = gl_VertexID % 6, corner = turn < 3 ? turn : 6 - turn;  // corners 0 to 3: 0, 1, 2 and 3, 2, 1
  vec3 u = area_light_edge[2 * area_light], v = area_light_edge[2 * area_light + 1];
  world = area_light_place[area_light].xyz + ((corner & 1) != 0 ? u : -u) / dot(u, u) +
          ((corner & 2) != 0 ? v : -v) / dot(v, v);
  gl_Position = view_projection * vec4(world, 1);
}
