#include "scenes/export/volume_vdb.h"

#include "base/file.h"
#include "base/number.h"
#include "scenes/export/vdb_bytes.h"

#include <stdlib.h>

static const char *const names[3] = {"X", "Y", "Z"};

static void fill(const abbe_caustic_volume *v, const double to_light[3], float *value[3]) {
  abbe_volume_sight sight;
  abbe_caustic_volume_look(v, ABBE_VOLUME_LOOKUP_AUTO, to_light, &sight);
#pragma omp parallel for
  for (size_t i = 0; i < v->region.cells; i++) { /* x runs fastest in both */
    double p[3], f[3][3];
    abbe_volume_region_middle(&v->region, i, p);
    abbe_caustic_volume_flux(v, &sight, p, f);
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) value[c][3 * i + (size_t)k] = (float)f[c][k];
  }
}

abbe_result abbe_volume_vdb_write(const char *path, const abbe_caustic_volume *v,
                                  const double to_light[3], abbe_error *error) {
  const abbe_region_desc *r = &v->region.desc;
  if (v->kind != ABBE_VOLUME_VECTOR || r->kind != ABBE_REGION_GRID || v->value == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: OpenVDB takes a grid of vectors (--grid N), not shells, rays or "
                          "bytes",
                          path);
  abbe_result result = abbe_vdb_bytes_check(error);
  if (result != ABBE_OK) return result;
  const size_t count = 3 * v->region.cells;
  float *all = calloc(3 * count, sizeof *all), *value[3];
  char note[200], *bytes = NULL;
  size_t size = 0;
  if (all == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu cells", count);
  for (int c = 0; c < 3; c++) value[c] = all + (size_t)c * count;
  fill(v, to_light, value);
  abbe_number_format(note, sizeof note, "vector irradiance of unit light from %.9g %.9g %.9g, m",
                     to_light[0], to_light[1], to_light[2]);
  const abbe_vdb_desc desc = {.side = r->side,
                              .cell = 2 * r->outer / (double)r->side,
                              .grids = 3,
                              .name = names,
                              .value = (const float *const *)value,
                              .note = note};
  abbe_error why = {0};
  result = abbe_vdb_bytes_make(&desc, &bytes, &size, &why);
  if (result != ABBE_OK) abbe_error_set(error, result, "%s: %s", path, why.text);
  if (result == ABBE_OK) result = abbe_file_write(path, bytes, size, error);
  free(bytes);
  free(all);
  return result;
}
