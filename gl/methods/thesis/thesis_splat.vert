// A photon of the hierarchy, as its place in the light's view.
#include "photon_list.glsl"
uniform int grid;
out vec2 photon_uv;

void main() {
  uint cell = photon_cell[gl_VertexID];
  photon_uv = (vec2(cell & 0xffffu, cell >> 16) + 0.5) / float(grid);
  gl_Position = vec4(0, 0, 0, 1);
}
