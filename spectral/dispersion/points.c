#include "spectral/dispersion/points.h"

#include <stdbool.h>
#include <stdlib.h>

void abbe_points_free(abbe_points *points) {
  if (points == NULL) return;
  free(points->point);
  *points = (abbe_points){0};
}

abbe_result abbe_points_add(abbe_points *points, abbe_point point, abbe_error *error) {
  if (points->count >= ABBE_SPECTRUM_MAX_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "more than %d points",
                          ABBE_SPECTRUM_MAX_COUNT);
  if (points->count == points->capacity) {
    size_t wanted = points->capacity == 0 ? 32 : 2 * points->capacity;
    abbe_point *larger = realloc(points->point, wanted * sizeof *larger);
    if (larger == NULL)
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", wanted);
    points->point = larger;
    points->capacity = wanted;
  }
  points->point[points->count++] = point;
  return ABBE_OK;
}

/* qsort is not stable: a point's place among its equals is kept beside it. */
typedef struct placed {
  abbe_point point;
  size_t place;
} placed;

static int by_wavelength(const void *a, const void *b) {
  const placed *p = a, *q = b;
  double x = p->point.lambda_nm, y = q->point.lambda_nm;
  if (x != y) return x < y ? -1 : 1;
  return (p->place > q->place) - (p->place < q->place);
}

static bool in_order(const abbe_points *points) {
  for (size_t i = 1; i < points->count; i++)
    if (!(points->point[i - 1].lambda_nm < points->point[i].lambda_nm)) return false;
  return true;
}

abbe_result abbe_points_sort(abbe_points *points, size_t *dropped, abbe_error *error) {
  if (dropped != NULL) *dropped = 0;
  if (in_order(points)) return ABBE_OK;
  placed *list = malloc(points->count * sizeof *list);
  if (list == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to sort %zu points", points->count);
  for (size_t i = 0; i < points->count; i++) list[i] = (placed){points->point[i], i};
  qsort(list, points->count, sizeof *list, by_wavelength);
  size_t kept = 0;
  for (size_t i = 0; i < points->count; i++) {
    bool again =
        dropped != NULL && kept > 0 && list[i].point.lambda_nm == points->point[kept - 1].lambda_nm;
    if (!again) points->point[kept++] = list[i].point;
  }
  free(list);
  if (dropped != NULL) *dropped = points->count - kept;
  points->count = kept;
  return ABBE_OK;
}

abbe_result abbe_points_spectrum(const abbe_points *points, abbe_interpolation interpolation,
                                 abbe_spectrum **out, abbe_error *error) {
  ABBE_FREED double *lambda_nm = malloc((2 * points->count + 1) * sizeof *lambda_nm);
  if (lambda_nm == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", points->count);
  double *value = lambda_nm + points->count;
  for (size_t i = 0; i < points->count; i++) {
    lambda_nm[i] = points->point[i].lambda_nm;
    value[i] = points->point[i].value;
  }
  return abbe_spectrum_make(lambda_nm, value, points->count, interpolation, out, error);
}
