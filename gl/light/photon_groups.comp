// Turns a list's count into the arguments of the dispatch and the draw that consume it.
layout(local_size_x = 1) in;
#include "photon_list.glsl"
uniform uint group_size;
uniform uint rows;

void main() {
  groups_x = (photon_count + group_size - 1u) / group_size;
  groups_y = rows;
  groups_z = 1u;
  draw_count = photon_count;
  draw_instances = 1u;
  draw_first = 0u;
  draw_base = 0u;
}
