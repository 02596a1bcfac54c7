/* volumes.h: caustic volumes of made-up values, for tests. */
#ifndef ABBE_TESTS_SCENES_VOLUME_VOLUMES_H
#define ABBE_TESTS_SCENES_VOLUME_VOLUMES_H

#include "scenes/volume/caustic_volume.h"
#include "scenes/volume/half.h"
#include "tests/check.h"

/* The field of a ball in light that comes from `to_light`: along it, and outwards, by how far to
 * the side: it turns with the light. */
static inline void ball_field(const double to_light[3], const double p[3], double f[9]) {
  double along = 0, square = 0;
  for (int k = 0; k < 3; k++) {
    along += to_light[k] * p[k];
    square += p[k] * p[k];
  }
  const double side = square - along * along;
  for (int k = 0; k < 9; k++)
    f[k] = (1 + k / 3) * (p[k % 3] * (0.3 + side) - to_light[k % 3] * (1 + along));
}

/* Every cell has the field at its middle; of unit size, of a ball or of some solid. */
static inline void make_volume(abbe_volume_kind kind, abbe_region_desc region, size_t nodes,
                               bool ball, abbe_caustic_volume *out) {
  *out = (abbe_caustic_volume){
      .kind = kind,
      .body = FIELDS(.name = "stone", .material = "glass", .ball = ball, .radius = 1,
                     .vertices = 12, .faces = 20, .anchor = {0, 3, 11},
                     .anchor_at = {{1, 0, 0}, {0, 0.9, 0}, {0, 0.1, -0.8}}),
      .white = {0.95, 1, 1.09},
      .min_nm = 380,
      .max_nm = 780,
      .byte = 0.03125,
      .error = 0.125};
  OK(abbe_volume_region_make(&region, &out->region, &error));
  OK(abbe_light_nodes_make(nodes, (const double[3]){0, 0, 1}, &out->nodes, &error));
  OK(abbe_caustic_volume_allocate(out, &error));
  const size_t channels = abbe_caustic_volume_channels(out);
  for (size_t i = 0; i < nodes * out->region.cells; i++) {
    double p[3], f[9];
    abbe_volume_region_middle(&out->region, i % out->region.cells, p);
    ball_field(out->nodes.direction[i / out->region.cells], p, f);
    for (size_t c = 0; c < channels; c++)
      out->value[i * channels + c] =
          abbe_half_of(kind == ABBE_VOLUME_PRINTED ? floor(fmin(fabs(f[3 * c]) * 30, 255)) : f[c]);
  }
}

#endif
