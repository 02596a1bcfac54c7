/* How far the mean colour of a picture's region is from a target's. */
#include "base/maths.h"
#include "cli/base/command.h"
#include "cli/derive/derive.h"
#include "colorimetry/difference.h"
#include "validation/measure/compare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = ABBE_DERIVATIVE_PARTS };

void abbe_derive_take_region(abbe_derive_request *q, const char *text, const char *program) {
  size_t *r = q->region;
  char more;
  if (strspn(text, "0123456789,") == strlen(text) &&
      sscanf(text, "%6zu,%6zu,%6zu,%6zu%c", &r[0], &r[1], &r[2], &r[3], &more) == 4 && r[2] > 0 &&
      r[3] > 0)
    return;
  fprintf(stderr,
          "%s: --region %s: X,Y,W,H is wanted, the column and the row of its upper left pixel, and "
          "its width and height in pixels, such as 10,20,8,8\n",
          program, text);
  exit(ABBE_EXIT_USAGE);
}

static abbe_result check_region(const abbe_derive_request *q, size_t width, size_t height,
                                abbe_error *error) {
  const size_t *r = q->region;
  if (r[2] == 0 || (r[0] + r[2] <= width && r[1] + r[3] <= height)) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "--region %zu,%zu,%zu,%zu: the picture has %zu x %zu pixels", r[0], r[1],
                        r[2], r[3], width, height);
}

/* The mean of the field's region. */
static void mean_of(const abbe_derive_request *q, const abbe_field *field, double mean[3]) {
  const bool all = q->region[2] == 0;
  const size_t wide = all ? field->width : q->region[2], high = all ? field->height : q->region[3];
  for (int c = 0; c < 3; c++) mean[c] = 0;
  for (size_t i = 0; i < wide * high; i++) {
    double xyz[3];
    const size_t x = q->region[0] + i % wide, y = q->region[1] + i / wide;
    abbe_field_xyz(field, y * field->width + x, xyz, NULL);
    for (int c = 0; c < 3; c++) mean[c] += xyz[c] / (double)(wide * high);
  }
}

abbe_result abbe_derive_read_target(const abbe_derive_request *q, size_t width, size_t height,
                                    abbe_derive_target *out, abbe_error *error) {
  ABBE_OWNED(abbe_field, field) = {0};
  double mean[3];
  ABBE_TRY(check_region(q, width, height, error));
  if (q->target == NULL) return ABBE_OK;
  ABBE_TRY(abbe_field_load(q->target, &field, error));
  if (field.colour.channels == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "--target %s has no colours", q->target);
  if (field.width != width || field.height != height)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--target %s has %zu x %zu pixels and the picture %zu x %zu; give --size "
                          "%zux%zu",
                          q->target, field.width, field.height, width, height, field.width,
                          field.height);
  mean_of(q, &field, mean);
  ABBE_TRY(abbe_compare_white(&field, NULL, out->white, error));
  if (!(out->white[1] > 0) || !isfinite(mean[0] + mean[1] + mean[2]))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--target %s is black, or has values in the region that are no numbers",
                          q->target);
  abbe_rgb_space_to_xyz(q->space, out->to_xyz);
  abbe_difference_lab(mean, out->white, out->lab);
  return ABBE_OK;
}

static double difference(const abbe_derive_target *t, const double rgb[3]) {
  double xyz[3], lab[3];
  abbe_rgb_space_apply(t->to_xyz, rgb, xyz);
  abbe_difference_lab(xyz, t->white, lab);
  return abbe_difference_ciede2000(lab, t->lab);
}

/* Of the mean of all parts but one (PARTS: of all). */
static double without(const abbe_derive_target *t, size_t row, size_t part) {
  double mean[3] = {0}, change[3] = {0}, near[2][3], size = 0, most = 0;
  for (size_t p = 0; p < PARTS; p++)
    for (int c = 0; c < 3 && p != part; c++) {
      mean[c] += t->pixels->mean[0][p][c] / (double)(part < PARTS ? PARTS - 1 : PARTS);
      change[c] += t->pixels->mean[row][p][c] / (double)(part < PARTS ? PARTS - 1 : PARTS);
    }
  if (row == 0) return difference(t, mean);
  for (int c = 0; c < 3; c++) {
    most = fmax(most, fabs(mean[c]));
    size = fmax(size, fabs(change[c]));
  }
  if (!(size > 0)) return 0;
  const double by = 1e-6 * most / size;
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < 2; i++) near[i][c] = mean[c] + (i == 0 ? -by : by) * change[c];
  return (difference(t, near[1]) - difference(t, near[0])) / (2 * by);
}

double abbe_derive_difference(const abbe_derive_target *t, size_t row, double *error) {
  const double all = without(t, row, PARTS);
  double square = 0;
  for (size_t p = 0; p < PARTS; p++) square += pow(without(t, row, p) - all, 2);
  *error = sqrt(square * (PARTS - 1) / PARTS);
  return all;
}
