// Paths that hit anywhere: (photon, or refined interval) * slots + order. LISTS_PATHS: who includes this
// lists them.
#include "counts.glsl"
#ifndef LISTS_PATHS
readonly
#endif
layout(std430, binding = BINDING_PATHS) buffer PathList {
  uint path_count, path_groups[3];
  uint path_list[];
};
