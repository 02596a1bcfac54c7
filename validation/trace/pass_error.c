#include "validation/trace/pass_error.h"

#include "colorimetry/difference.h"
#include "validation/measure/compare.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { BLOCK = 8 };

/* One-sided, nine of ten of a normal number. */
static const double nine_of_ten = 1.2816;
/* No mean of a filter's window takes more of the noise away. */
static const double least_left = 0.1;

/* From such a mean difference on most pixels are dark or far too bright, and differences no longer
 * add in squares: measured in a brilliant's specks, where errors of filtered pictures came out too
 * small above it and right below. */
static const double most_that_adds = 12;

static const char name[] = "the picture";

/* Colours alone: standard errors of channels are not asked. */
static abbe_result take(const abbe_image *image, abbe_field *out, abbe_error *error) {
  ABBE_TRY(abbe_field_make(image, name, out, error));
  free(out->colour.error);
  out->colour.error = NULL;
  if (out->colour.channels == 3) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s has no colours", name);
}

/* What the passes after the first made: the mean of all less the first's part. */
static void keep_the_others(const abbe_pass_pictures *p, const abbe_field *part,
                            abbe_field *whole) {
  const double all = (double)p->passes, first = (double)p->part_passes;
  float *value = whole->colour.value;
  for (size_t i = 0; i < 3 * whole->width * whole->height; i++)
    value[i] =
        (float)((all * (double)value[i] - first * (double)part->colour.value[i]) / (all - first));
}

/* Where the caustic is, and what is white there. */
typedef struct region {
  abbe_mask mask;
  double white[3];
} region;

static abbe_result find_region(const abbe_field *of, region *out, abbe_error *error) {
  abbe_comparison c;
  const abbe_compare_options options = {0};
  ABBE_TRY(abbe_compare(of, of, &options, &c, error));
  for (int k = 0; k < 3; k++) out->white[k] = c.white[k];
  abbe_comparison_free(&c);
  return abbe_mask_make_caustic(of, name, ABBE_MASK_CAUSTIC_SHARE, &out->mask, error);
}

/* A mean difference and its standard error. */
typedef struct distance {
  double mean, error;
} distance;

static bool is_finite(const double xyz[3]) {
  return isfinite(xyz[0]) && isfinite(xyz[1]) && isfinite(xyz[2]);
}

/* NaN where a side is not finite: for such a picture there is no error. */
static double difference(const abbe_field *a, const abbe_field *b, const region *r, size_t pixel) {
  double xyz[3], lab_a[3], lab_b[3];
  abbe_field_xyz(a, pixel, xyz, NULL);
  if (!is_finite(xyz)) return NAN;
  abbe_difference_lab(xyz, r->white, lab_a);
  abbe_field_xyz(b, pixel, xyz, NULL);
  if (!is_finite(xyz)) return NAN;
  abbe_difference_lab(xyz, r->white, lab_b);
  return abbe_difference_ciede2000(lab_a, lab_b);
}

/* Sums over pixels in the region: sum, sum of squares, number. */
typedef struct block {
  double sum, squares, count;
} block;

static block sum_block(const abbe_field *a, const abbe_field *b, const region *r, size_t x0,
                       size_t y0) {
  block s = {0, 0, 0};
  for (size_t y = y0; y < y0 + BLOCK && y < a->height; y++)
    for (size_t x = x0; x < x0 + BLOCK && x < a->width; x++)
      if (r->mask.in[y * a->width + x] != 0) {
        const double value = difference(a, b, r, y * a->width + x);
        s.sum += value;
        s.squares += value * value;
        s.count++;
      }
  return s;
}

/* The standard error is of chance alone: pixels of a block are about as noisy as each other, those
 * of different blocks are not. */
static distance measure(const abbe_field *a, const abbe_field *b, const region *r) {
  double sum = 0, count = 0, squares = 0;
  for (size_t y = 0; y < a->height; y += BLOCK)
    for (size_t x = 0; x < a->width; x += BLOCK) {
      const block s = sum_block(a, b, r, x, y);
      sum += s.sum;
      count += s.count;
      if (s.count > 1)
        squares += fmax(0, s.squares - s.sum * s.sum / s.count) * s.count / (s.count - 1);
      else
        squares += s.squares;
    }
  return (distance){sum / count, sqrt(squares) / count};
}

/* The error of the parts, whose differences add in squares: the first's share of it is the others'
 * share of all passes. */
static void tell_raw(const abbe_pass_pictures *p, distance d, abbe_pass_error *out) {
  const double first = (double)p->part_passes / (double)p->passes;
  out->bound = (d.mean + nine_of_ten * d.error) * sqrt(1 - first);
  out->estimate = d.mean * sqrt(1 - first) * sqrt(first);
}

/* The filtered part against the others, of which the others' own noise is taken off: what is left
 * is noise and blur together, for the others know nothing of the filter. Where squares do not add,
 * the filtered part is taken to be no nearer than the part itself. */
static void tell_filtered(const abbe_pass_pictures *p, distance raw, distance d,
                          abbe_pass_error *out) {
  const double first = (double)p->part_passes / (double)p->passes;
  const double others = raw.mean * raw.mean * first;
  const double least = pow(least_left * raw.mean, 2) * (1 - first);
  double square = d.mean * d.mean - others;
  if (raw.mean > most_that_adds) square = fmax(square, raw.mean * raw.mean * (1 - first));
  const double chance = 2 * hypot(d.mean * d.error, first * raw.mean * raw.error);
  out->bound = sqrt(fmax(square + nine_of_ten * chance, least));
  out->estimate = sqrt(fmax(square, least)) * pow(first, 0.25);
}

/* A picture against all passes, without their noise. */
static void tell_picture(const abbe_pass_pictures *p, distance raw, distance d,
                         abbe_pass_error *out) {
  const double first = (double)p->part_passes / (double)p->passes;
  const double noise = first * (1 - first) * raw.mean * raw.mean;
  const double square = d.mean * d.mean - noise;
  const double chance = 2 * hypot(d.mean * d.error, first * (1 - first) * raw.mean * raw.error);
  if (raw.mean > most_that_adds) return;
  out->estimate = sqrt(fmax(square, 0));
  out->bound = sqrt(fmax(square, 0) + nine_of_ten * chance);
}

static bool is_known(distance d) {
  return isfinite(d.mean) && isfinite(d.error);
}

/* A dark caustic and a black picture are no errors of the caller's: there is no estimate then. */
static abbe_result tell(const abbe_pass_pictures *p, const abbe_field *part, abbe_field *whole,
                        const abbe_field *filtered_part, const abbe_field *filtered,
                        abbe_pass_error *out, abbe_error *error) {
  region r = {0};
  const bool is_raw = p->filtered == NULL;
  const abbe_result result = find_region(is_raw ? whole : filtered, &r, error);
  if (result == ABBE_OK) {
    keep_the_others(p, part, whole);
    const distance raw = measure(part, whole, &r);
    const distance filter = is_raw ? raw : measure(filtered_part, whole, &r);
    if (is_raw)
      tell_raw(p, raw, out);
    else if (isfinite(filter.mean) && isfinite(raw.mean))
      tell_filtered(p, raw, filter, out);
  }
  abbe_mask_free(&r.mask);
  return result == ABBE_NO_MEMORY ? result : ABBE_OK;
}

static abbe_result tell_of_picture(const abbe_pass_pictures *p, const abbe_field *part,
                                   const abbe_field *whole, const abbe_field *picture,
                                   abbe_pass_error *out, abbe_error *error) {
  region r = {0};
  abbe_field others = {0};
  abbe_result result = find_region(picture, &r, error);
  const bool is_lit = result == ABBE_OK;
  if (is_lit) result = take(p->whole, &others, error);
  if (is_lit && result == ABBE_OK) {
    keep_the_others(p, part, &others);
    const distance raw = measure(part, &others, &r), d = measure(picture, whole, &r);
    if (is_known(raw) && is_known(d)) tell_picture(p, raw, d, out);
  }
  abbe_field_free(&others);
  abbe_mask_free(&r.mask);
  return result == ABBE_NO_MEMORY ? result : ABBE_OK;
}

static bool are_alike(const abbe_image *a, const abbe_image *b) {
  return a->width == b->width && a->height == b->height;
}

static abbe_result check(const abbe_pass_pictures *p, const abbe_image *other, abbe_error *error) {
  if (p->part_passes < 1 || p->part_passes >= p->passes)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu of %zu passes are not a part of them",
                          p->part_passes, p->passes);
  if (!are_alike(p->part, p->whole) || (other != NULL && !are_alike(other, p->whole)) ||
      (p->filtered != NULL &&
       !(are_alike(p->filtered, p->whole) && are_alike(p->filtered_part, p->whole))))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the pictures differ in size");
  return ABBE_OK;
}

abbe_result abbe_pass_error_make(const abbe_pass_pictures *p, abbe_pass_error *out,
                                 abbe_error *error) {
  assert(p->part && p->whole && !p->filtered == !p->filtered_part);
  abbe_field part = {0}, whole = {0}, filtered_part = {0}, filtered = {0};
  *out = (abbe_pass_error){NAN, NAN};
  abbe_result result = check(p, NULL, error);
  if (result == ABBE_OK) result = take(p->part, &part, error);
  if (result == ABBE_OK) result = take(p->whole, &whole, error);
  if (result == ABBE_OK && p->filtered != NULL) result = take(p->filtered, &filtered, error);
  if (result == ABBE_OK && p->filtered != NULL)
    result = take(p->filtered_part, &filtered_part, error);
  if (result == ABBE_OK) result = tell(p, &part, &whole, &filtered_part, &filtered, out, error);
  abbe_field_free(&part);
  abbe_field_free(&whole);
  abbe_field_free(&filtered_part);
  abbe_field_free(&filtered);
  return result;
}

abbe_result abbe_pass_error_of_picture(const abbe_pass_pictures *p, const abbe_image *picture,
                                       abbe_pass_error *out, abbe_error *error) {
  assert(p->part && p->whole && !p->filtered == !p->filtered_part);
  abbe_field part = {0}, whole = {0}, field = {0};
  *out = (abbe_pass_error){NAN, NAN};
  abbe_result result = check(p, picture, error);
  if (result == ABBE_OK) result = take(p->part, &part, error);
  if (result == ABBE_OK) result = take(p->whole, &whole, error);
  if (result == ABBE_OK) result = take(picture, &field, error);
  if (result == ABBE_OK) result = tell_of_picture(p, &part, &whole, &field, out, error);
  abbe_field_free(&part);
  abbe_field_free(&whole);
  abbe_field_free(&field);
  return result;
}
