/* Flicker and ghosts of series that are made up: a still error does not flicker, a changing one
 * does by what it changes, and light in the dark is a ghost. */
#include "validation/measure/frame_flicker.h"

#include "tests/check.h"

enum { SIDE = 8 };

static abbe_image make(bool caustic, float even, float odd) {
  static const char *const rgb[] = {"R", "G", "B"};
  static const char *const layers[] = {"R", "G", "B", "caustic.R", "caustic.G", "caustic.B"};
  abbe_image image;
  OK(abbe_image_make(SIDE, SIDE, caustic ? 6 : 3, caustic ? layers : rgb, &image, &error));
  for (size_t i = 0; i < SIDE * SIDE; i++)
    for (size_t k = 0; k < image.channels; k++)
      image.data[i * image.channels + k] = k + 3 < image.channels ? 99.0f : i % 2 ? odd : even;
  return image;
}

static abbe_frame_error add(abbe_frame_flicker *f, abbe_image frame, abbe_image reference) {
  abbe_frame_error out;
  const bool known = reference.data != NULL;
  OK(abbe_frame_flicker_add(f, &frame, known ? &reference : NULL, &out, &error));
  abbe_image_free(&frame);
  abbe_image_free(&reference);
  return out;
}

TEST(errors_that_stay_do_not_flicker) {
  OWNED(abbe_frame_flicker, f) = {0};
  abbe_frame_error e = add(&f, make(false, 3, 2), make(false, 2, 2));
  assert_near(e.error, sqrt(0.5 * 1 / 4), 1e-7);
  assert_true(isnan(e.change));
  e = add(&f, make(false, 5, 4), make(false, 4, 4)); /* the light moves, the error stays */
  assert_near(e.change, 0, 1e-7);
  assert_near(e.error, sqrt(0.5 / 16), 1e-7);
  e = add(&f, make(false, 4, 5), make(false, 4, 4)); /* now it goes to the others */
  assert_near(e.change, sqrt(1.0 / 16), 1e-7);
  assert_int_equal(f.count, 3);
  const abbe_frame_error first = {1, NAN, 0.25}, row[] = {first, {0.5, 0.3, 0}, e};
  abbe_frame_error most;
  abbe_frame_flicker_largest(row, 3, &most);
  assert_near(most.error, 1, 0);
  assert_near(most.change, 0.3, 0);
  assert_near(most.ghost, 0.25, 0);
  abbe_frame_flicker_largest(row, 1, &most);
  assert_true(isnan(most.change));
}

TEST(light_in_the_dark_is_a_ghost) {
  OWNED(abbe_frame_flicker, f) = {.caustic = true};
  abbe_frame_error e = add(&f, make(true, 0.5f, 2), make(true, 0, 2));
  assert_near(e.ghost, 0.25, 1e-7);
  assert_near(e.error, sqrt(0.25 / 4), 1e-7); /* of the caustic alone */
  e = add(&f, make(true, 0, 1), make(true, 0, 2));
  assert_near(e.ghost, 0, 0);
}

TEST(without_references) {
  OWNED(abbe_frame_flicker, f) = {0};
  abbe_frame_error e = add(&f, make(false, 1, 1), (abbe_image){0});
  assert_true(isnan(e.error) && isnan(e.ghost) && isnan(e.change));
  e = add(&f, make(false, 2, 2), (abbe_image){0});
  assert_near(e.change, 0.5, 1e-7);
}

TEST(what_does_not_fit_is_refused) {
  static const char *const y[] = {"Y"};
  abbe_frame_flicker f = {0};
  abbe_frame_error out;
  add(&f, make(false, 1, 1), (abbe_image){0});
  MADE(abbe_image, small, abbe_image_make(2, 2, 1, y, &small, &error));
  MADE(abbe_image, grey, abbe_image_make(SIDE, SIDE, 1, y, &grey, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "frame 2 has 2 x 2",
          abbe_frame_flicker_add(&f, &small, NULL, &out, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "has no channels R, G, B",
          abbe_frame_flicker_add(&f, &grey, NULL, &out, &error));
  abbe_frame_flicker_free(&f);
  abbe_frame_flicker_free(NULL);
}
