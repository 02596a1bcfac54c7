#include "validation/lab/volume_sums.h"

#include "base/maths.h"

#include <stdlib.h>

/* Sums of a pass of unit irradiance: to 2^-33 of it. */
static const double most = 0x1p28;

static void weigh(abbe_volume_sums *s, const float *share, const double beam[3]) {
  for (size_t i = 0; i < s->region->cells; i++) {
    const double part = share != NULL && !s->printed ? (double)share[i] : 1;
    const double size = s->printed ? abbe_volume_region_across(s->region, i, beam)
                                   : part * abbe_volume_region_volume(s->region, i);
    s->weight[i] = part < (double)ABBE_VOLUME_SUMS_LEAST_SPACE ? 0 : 1 / size;
  }
}

abbe_result abbe_volume_sums_make(const abbe_volume_region *region, bool printed,
                                  const float *share, const double beam[3], size_t threads,
                                  abbe_volume_sums *out, abbe_error *error) {
  *out = (abbe_volume_sums){.region = region, .printed = printed, .channels = printed ? 3 : 9};
  abbe_result result =
      abbe_accumulator_make(region->cells * out->channels, threads, most, &out->sums, error);
  if (result != ABBE_OK) return result;
  out->weight = malloc(region->cells * sizeof *out->weight);
  out->piece = malloc(threads * ABBE_REGION_MOST_PIECES * sizeof *out->piece);
  if (out->weight == NULL || out->piece == NULL) {
    abbe_volume_sums_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the sums of %zu cells",
                          region->cells);
  }
  weigh(out, share, beam);
  return ABBE_OK;
}

void abbe_volume_sums_free(abbe_volume_sums *s) {
  if (s == NULL) return;
  abbe_accumulator_free(&s->sums);
  free(s->weight);
  free(s->piece);
  *s = (abbe_volume_sums){0};
}

/* Whether the cell of piece i is new to the ray. */
static bool is_new(const abbe_region_piece *piece, size_t i) {
  for (size_t k = i; k-- > 0;)
    if (piece[k].cell == piece[i].cell) return false;
  return true;
}

static void add_printed(abbe_volume_sums *s, size_t thread, const abbe_region_piece *piece,
                        size_t count, const double d[3], const float flux[3]) {
  for (size_t i = 0; i < count; i++) {
    double p[3];
    if (!is_new(piece, i)) continue;
    abbe_volume_region_middle(s->region, piece[i].cell, p);
    const double away = abbe_vector_dot(p, d) / abbe_vector_length(p);
    if (!(away > 0)) continue; /* it comes from behind */
    const double weight = away * s->weight[piece[i].cell];
    for (size_t c = 0; c < 3; c++)
      abbe_accumulator_add(&s->sums, thread, 3 * piece[i].cell + c,
                           (float)(weight * (double)flux[c]));
  }
}

void abbe_volume_sums_add(abbe_volume_sums *s, size_t thread, const double o[3], const double d[3],
                          double length, const float flux[3]) {
  abbe_region_piece *piece = s->piece + thread * ABBE_REGION_MOST_PIECES;
  const size_t count = abbe_volume_region_walk(s->region, o, d, length, piece);
  if (s->printed) {
    add_printed(s, thread, piece, count, d, flux);
    return;
  }
  for (size_t i = 0; i < count; i++) {
    const double weight = piece[i].length * s->weight[piece[i].cell];
    for (size_t c = 0; c < 9; c++)
      abbe_accumulator_add(&s->sums, thread, 9 * piece[i].cell + c,
                           (float)(weight * (double)flux[c / 3] * d[c % 3]));
  }
}

double abbe_volume_sums_mean(const abbe_volume_sums *s, size_t cell, size_t channel) {
  return abbe_accumulator_mean(&s->sums, cell * s->channels + channel);
}

double abbe_volume_sums_error(const abbe_volume_sums *s, size_t cell, size_t channel) {
  return abbe_accumulator_error(&s->sums, cell * s->channels + channel);
}

double abbe_volume_sums_relative_error(const abbe_volume_sums *s) {
  const size_t first = s->printed ? 1 : 3, count = s->printed ? 1 : 3;
  double values = 0, errors = 0;
  for (size_t i = 0; i < s->region->cells; i++)
    for (size_t c = first; c < first + count; c++) {
      values += pow(abbe_volume_sums_mean(s, i, c), 2);
      errors += pow(abbe_volume_sums_error(s, i, c), 2);
    }
  return values > 0 ? sqrt(errors / values) : 0;
}

double abbe_volume_sums_outflow(const abbe_volume_sums *s, size_t shell) {
  const abbe_volume_region *r = s->region;
  double sum = 0;
  for (size_t i = shell * r->row; i < (shell + 1) * r->row; i++) {
    double p[3];
    abbe_volume_region_middle(r, i, p);
    const double radius = abbe_vector_length(p);
    /* the mean over the shell's thickness of the flux through a sphere */
    const double area = abbe_volume_region_volume(r, i) / (r->radius[shell + 1] - r->radius[shell]);
    for (size_t k = 0; k < 3; k++) sum += area * p[k] / radius * abbe_volume_sums_mean(s, i, 3 + k);
  }
  return sum;
}
