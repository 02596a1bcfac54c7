/* A thread that paints what rests: to the byte as the display's transform of the whole picture, and
 * nothing once it is stopped. */
#include "tests/check.h"

#include "base/clock.h"
#include "cli/view/picture/view_show.h"

#include <time.h>

enum { WIDTH = 301, HEIGHT = 207, PIXELS = WIDTH * HEIGHT };

typedef struct case_ {
  abbe_view_painter *painter;
  abbe_display *display;
  abbe_view_pictures pictures;
  abbe_view_painting painting;
} case_;

static void begin(case_ *c) {
  static const char *const names[] = {"R", "G", "B", "A"};
  const abbe_display_desc desc = {.display = "sRGB", .view = "Looking"};
  *c = (case_){0};
  OK(abbe_display_make(&desc, &c->display, &error));
  OK(abbe_view_painter_make(NULL, &c->painter, &error));
  OK(abbe_image_make(WIDTH, HEIGHT, 4, names, &c->pictures.rendered, &error));
  for (size_t i = 0; i < 4 * PIXELS; i++)
    c->pictures.rendered.data[i] = (float)exp2(0.01 * (double)(i * 7919 % 1200) - 9);
  c->painting = (abbe_view_painting){&c->pictures, ABBE_VIEW_RENDERED_PICTURE, 1, c->display};
}

static void end(case_ *c) {
  abbe_view_painter_free(c->painter);
  abbe_view_pictures_free(&c->pictures);
  abbe_display_free(c->display);
}

static unsigned char *wait_for(case_ *c) {
  const struct timespec time = {.tv_nsec = 1000000};
  unsigned char *pixels = NULL;
  abbe_result result = ABBE_CANCELLED;
  while (!abbe_view_painter_take(c->painter, &pixels, &result, NULL)) nanosleep(&time, NULL);
  assert_int_equal(result, ABBE_OK);
  assert_null(abbe_view_painter_has(c->painter));
  return pixels;
}

TEST(it_is_the_whole_picture_transformed) {
  static const char *const names[] = {"R", "G", "B"};
  case_ c;
  begin(&c);
  MADE(abbe_image, whole, abbe_image_make(WIDTH, HEIGHT, 3, names, &whole, &error));
  for (size_t i = 0; i < 3 * PIXELS; i++)
    whole.data[i] = 2 * c.pictures.rendered.data[4 * (i / 3) + i % 3]; /* a stop */
  OK(abbe_display_apply(c.display, &whole, &error));
  abbe_view_painter_give(c.painter, &c.painting);
  assert_true(abbe_view_painter_has(c.painter)->exposure == 1);
  FREED unsigned char *pixels = wait_for(&c);
  for (size_t i = 0; i < 3 * PIXELS; i++) {
    const double seen = fmin(fmax((double)whole.data[i], 0), 1);
    assert_int_equal(pixels[4 * (i / 3) + i % 3], (int)(255 * seen + 0.5));
  }
  end(&c);
}

/* What is stopped takes a small part of the time, is dropped, and looks at nothing any more. */
TEST(what_is_stopped_is_nothing) {
  case_ c;
  FREED unsigned char *pixels = NULL;
  abbe_result result;
  begin(&c);
  abbe_view_painter_stop(c.painter); /* of nothing */
  const double begun = abbe_clock_process_seconds();
  abbe_view_painter_give(c.painter, &c.painting);
  free(wait_for(&c));
  const double whole_s = abbe_clock_process_seconds() - begun;
  for (int i = 0; i < 8; i++) {
    abbe_view_painter_give(c.painter, &c.painting);
    abbe_view_painter_stop(c.painter);
    assert_null(abbe_view_painter_has(c.painter));
    assert_false(abbe_view_painter_take(c.painter, &pixels, &result, NULL));
  }
  const double all_s = abbe_clock_process_seconds() - begun;
  assert_true(all_s - whole_s < 0.5 * 8 * whole_s);
  memset(c.pictures.rendered.data, 0, 4 * PIXELS * sizeof(float));
  abbe_view_painter_give(c.painter, &c.painting); /* and it goes on with another */
  pixels = wait_for(&c);
  for (size_t i = 0; i < PIXELS; i++) assert_true(pixels[4 * i] < 8 && pixels[4 * i + 3] == 255);
  abbe_view_painter_give(c.painter, &c.painting);
  end(&c); /* nor does the end wait for it */
}
