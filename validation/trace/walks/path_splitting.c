#include "validation/trace/walks/path_splitting.h"

#include <math.h>

unsigned abbe_path_splitting_best(const abbe_photon_hit *hit, size_t count) {
  unsigned best = 0;
  double least = INFINITY;
  for (unsigned splits = 0; splits < 1u << ABBE_PHOTON_SPLITS; splits++) {
    double squares = 0, rays = 1;
    for (int k = 0; k < ABBE_PHOTON_SPLITS; k++) rays *= splits >> k & 1 ? 2 : 1;
    for (size_t i = 0; i < count; i++) {
      double weight = 1;
      for (int k = 0; k < ABBE_PHOTON_SPLITS; k++)
        weight *= splits >> k & 1 ? (double)hit[i].chance[k] : 1;
      squares += weight * (double)hit[i].flux * (double)hit[i].flux;
    }
    if (squares * rays < least) {
      least = squares * rays;
      best = splits;
    }
  }
  return best;
}
