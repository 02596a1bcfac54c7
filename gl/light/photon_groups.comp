// Turns a list's count into the arguments of the dispatch and the draw that consume it.
layout(local_size_x = 1) in;
#include "photon_list.glsl"
uniform uint group_size;

void main() {
  // No dimension may have more than 65535 groups.
  uint groups = (photon_count + group_size - 1u) / group_size;
  groups_y = (groups + 65534u) / 65535u;
  groups_x = groups_y > 0u ? (groups + groups_y - 1u) / groups_y : 0u;
  groups_z = 1u;
  draw_count = photon_count;
  draw_instances = 1u;
  draw_first = 0u;
  draw_base = 0u;
}
