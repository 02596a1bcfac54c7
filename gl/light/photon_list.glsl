// Photon cells: a list of grid cells (x | y << 16) with its count, and where each stands in it.
layout(std430, binding = BINDING_CELLS) buffer PhotonList {
  uint photon_count, groups_x, groups_y, groups_z;  // count, then an indirect dispatch
  uint draw_count, draw_instances, draw_first, draw_base;  // an indirect draw
  uint photon_cell[];
};
