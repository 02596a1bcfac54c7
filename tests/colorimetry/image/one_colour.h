/* one_colour.h: one colour through one display, without the caller's configuration. */
#ifndef ABBE_TESTS_COLORIMETRY_IMAGE_ONE_COLOUR_H
#define ABBE_TESTS_COLORIMETRY_IMAGE_ONE_COLOUR_H

#include "tests/check.h"

#include "colorimetry/image/display_ocio.h"

/* rgb is replaced. */
static inline void show(const abbe_display_desc *desc, double rgb[3]) {
  static const char *const names[] = {"R", "G", "B"};
  HELD(abbe_display, display) = NULL;
  OK(abbe_display_make(desc, &display, &error));
  MADE(abbe_image, image, abbe_image_make(1, 1, 3, names, &image, &error));
  for (int k = 0; k < 3; k++) image.data[k] = (float)rgb[k];
  OK(abbe_display_apply(display, &image, &error));
  for (int k = 0; k < 3; k++) rgb[k] = (double)image.data[k];
}

static inline void near(const double got[3], const double expected[3], double tolerance,
                        const char *what) {
  for (int k = 0; k < 3; k++)
    if (!(fabs(got[k] - expected[k]) <= tolerance))
      fail_msg("%s: component %d is %.7f, not %.7f", what, k, got[k], expected[k]);
}

static void begin(void) {
  unsetenv("OCIO");
}

GROUP(begin, NULL);

#endif
