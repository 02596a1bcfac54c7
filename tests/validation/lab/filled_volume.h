/* filled_volume.h: volumes filled in tests. */
#ifndef ABBE_TESTS_VALIDATION_LAB_FILLED_VOLUME_H
#define ABBE_TESTS_VALIDATION_LAB_FILLED_VOLUME_H

#include "tests/validation/trace_scene.h"

#include "validation/lab/volume_fill.h"

static inline void fill_volume(const abbe_scene *scene, const abbe_volume_fill_desc *desc,
                               abbe_caustic_volume *out, abbe_volume_fill_statistics *done) {
  OK(abbe_volume_fill(scene, desc, out, done, &error));
}

#endif
