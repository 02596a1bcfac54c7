/* A table of a display's transform against the transform. */
#include "colorimetry/image/display_table.h"

#include "tests/check.h"
#include "tests/random.h"

enum { SIDE = 128, COLOURS = SIDE * SIDE };

static void make_display(const char *name, const char *view, abbe_display **out) {
  const abbe_display_desc desc = {.display = name, .view = view};
  OK(abbe_display_make(&desc, out, &error));
}

static void make_image(abbe_image *out) {
  static const char *const names[] = {"R", "G", "B"};
  OK(abbe_image_make(SIDE, SIDE, 3, names, out, &error));
}

/* Both ways. */
static void show(const abbe_display *display, const abbe_image *image, abbe_image *exact,
                 abbe_image *quick) {
  abbe_display_table *table = NULL;
  make_image(exact);
  make_image(quick);
  memcpy(exact->data, image->data, 3 * COLOURS * sizeof *image->data);
  memcpy(quick->data, image->data, 3 * COLOURS * sizeof *image->data);
  OK(abbe_display_table_make(display, &table, &error));
  OK(abbe_display_apply(display, exact, &error));
  OK(abbe_display_table_apply(table, quick, &error));
  abbe_display_table_free(table);
}

static double step_of(float value) {
  return 255 * fmin(1, fmax(0, (double)value));
}

/* Colours from black to far above white, most of them of some hue: as a screen of 255 steps has
 * them. */
TEST(colours_are_nearly_those_of_the_transform) {
  static const char *const shown[][2] = {
      {"sRGB", "Looking"}, {"sRGB", "Plain"}, {"Display P3", "Looking"}, {"Rec.2100 PQ", "Plain"}};
  for (size_t d = 0; d < sizeof shown / sizeof *shown; d++) {
    abbe_display *display = NULL;
    OWNED(abbe_image, image) = {0}, exact = {0}, quick = {0};
    uint64_t random = d;
    double sum = 0, most = 0;
    size_t far = 0;
    make_display(shown[d][0], shown[d][1], &display);
    make_image(&image);
    for (size_t i = 0; i < COLOURS; i++) {
      const double bright = exp2(random_between(&random, -10, 4));
      for (size_t k = 0; k < 3; k++)
        image.data[3 * i + k] = (float)(bright * random_between(&random, 0.3, 1));
    }
    show(display, &image, &exact, &quick);
    for (size_t i = 0; i < (size_t)3 * COLOURS; i++) {
      const double apart = fabs(step_of(exact.data[i]) - step_of(quick.data[i]));
      sum += apart;
      most = fmax(most, apart);
      far += apart > 2;
    }
    if (getenv("SAY") || most >= 8 || far >= 3 * COLOURS / 100)
      print_error("%s %s: off by %g steps, %zu by more than 2\n", shown[d][0], shown[d][1], most,
                  far);
    assert_true(sum / (3 * COLOURS) < 0.5);
    assert_true(far < 3 * COLOURS / 100);
    assert_true(most < 8);
    abbe_display_free(display);
  }
}

/* What the table does not hold goes through the transform itself, bit for bit. */
TEST(colours_beyond_it_are_exact) {
  static const float beyond[][3] = {
      {-0.01F, 0.2F, 0.5F},   {70, 1, 1},        {1e30F, 1, 0},
      {0.1F, 0.1F, INFINITY}, {NAN, 0.5F, 0.5F}, {0, 0, 0}}; /* the last one is its own node */
  abbe_display *display = NULL;
  OWNED(abbe_image, image) = {0}, exact = {0}, quick = {0};
  make_display(NULL, NULL, &display);
  make_image(&image);
  for (size_t i = 0; i < COLOURS; i++)
    memcpy(image.data + 3 * i, beyond[i % (sizeof beyond / sizeof *beyond)], sizeof *beyond);
  show(display, &image, &exact, &quick);
  assert_memory_equal(exact.data, quick.data, 3 * COLOURS * sizeof *exact.data);
  abbe_display_free(display);
}
