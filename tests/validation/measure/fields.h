/* fields.h: small pictures for tests of comparisons, painted or drawn at random. */
#ifndef ABBE_TESTS_VALIDATION_MEASURE_FIELDS_H
#define ABBE_TESTS_VALIDATION_MEASURE_FIELDS_H

#include "validation/measure/compare.h"

#include "colorimetry/difference.h"
#include "colorimetry/rgb_space.h"
#include "tests/check.h"

enum { XYZ = 1, ERRORS = 2, BANDS = 4 };

static const double d65[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};

/* A black field of width x height: X, Y, Z, or R, G, B in ACEScg; two bands on request. */
static inline abbe_field field_of(size_t width, size_t height, int what) {
  static const char *const names[2][6] = {{"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"},
                                          {"X", "Y", "Z", "stderr.X", "stderr.Y", "stderr.Z"}};
  static const char *const bands[] = {"S0.450nm", "S0.650nm", "stderr.S0.450nm", "stderr.S0.650nm"};
  const char *const *of = what & BANDS ? bands : names[what & XYZ];
  size_t channels = (what & BANDS ? 2 : 3) * (size_t)(what & ERRORS ? 2 : 1);
  abbe_field field = {0};
  MADE(abbe_image, image, abbe_image_make(width, height, channels, of, &image, &error));
  OK(abbe_image_set_attribute(&image, "abbe:space", "acescg", &error));
  OK(abbe_field_make(&image, "it", &field, &error));
  return field;
}

/* Deterministic numbers, uniform in (0, 1) and normal by twelve of them. */
static inline double uniform(unsigned *state) {
  *state = *state * 1664525u + 1013904223u;
  return ((*state >> 8) + 0.5) / 16777216.0;
}

static inline double normal(unsigned *state) {
  double sum = -6;
  for (int i = 0; i < 12; i++) sum += uniform(state);
  return sum;
}

/* Bright and dark coloured light, positive. */
static inline void paint(abbe_field *field) {
  for (size_t i = 0; i < field->width * field->height; i++)
    for (size_t c = 0; c < 3; c++)
      field->colour.value[3 * i + c] =
          (float)(exp(2 * sin(0.37 * (double)i + (double)c)) * (c == 2 ? 0.5 : 1));
}

static inline abbe_comparison compare(const abbe_field *reference, const abbe_field *test,
                                      const abbe_compare_options *options) {
  abbe_comparison out = {0};
  OK(abbe_compare(reference, test, options, &out, &error));
  return out;
}

static inline double value(const abbe_compare_region *region, abbe_compare_metric metric) {
  return region->metric[metric].value;
}

/* REF is TEST and noise of a known size on top. */
static inline void make_noisy(abbe_field *reference, const abbe_field *exact, double share,
                              double bias, unsigned seed) {
  for (size_t i = 0; i < 3 * exact->width * exact->height; i++) {
    double v = (double)exact->colour.value[i], error = share * v;
    reference->colour.value[i] = (float)(v + error * (bias + normal(&seed)));
    reference->colour.error[i] = (float)error;
  }
}

#endif
