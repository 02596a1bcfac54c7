// The meshoptimizer bridge of edge_collapse.h: its C functions let the exceptions of new out.
#include "scenes/mesh/edge_collapse.h"

#include <new>

#include <meshoptimizer.h>

extern "C" bool abbe_edge_collapse(const uint32_t *index, size_t count, const float (*position)[3],
                                   size_t vertices, double distance_m, uint32_t *out,
                                   size_t *kept) {
  try {
    const float size_m = meshopt_simplifyScale(position[0], vertices, sizeof *position);
    const float share = size_m > 0 ? static_cast<float>(distance_m / size_m) : 0.0f;
    *kept = meshopt_simplify(out, index, count, position[0], vertices, sizeof *position, 0, share,
                             0, nullptr);
    return true;
  } catch (const std::bad_alloc &) {
    return false;
  }
}
