/* Outlines: disks and bands of known place, moved, scaled, tinted and noisy. */
#include "tests/check.h"

#include "validation/measure/outline.h"

enum { SIDE = 128, COUNT = SIDE * SIDE };
static double picture[2][COUNT][3];

static const abbe_outline_options all = {.share = 1, .blur = -1};

static void clear(int which) {
  memset(picture[which], 0, sizeof picture[which]);
}

static void add_disk(int which, double x, double y, double radius, const double rgb[3]) {
  for (int i = 0; i < COUNT; i++)
    if (hypot(i % SIDE + 0.5 - x, i / SIDE + 0.5 - y) <= radius)
      for (int c = 0; c < 3; c++) picture[which][i][c] += rgb[c];
}

static abbe_outline outline(int which, const abbe_outline_options *options) {
  abbe_outline o;
  abbe_error error = {0};
  if (abbe_outline_make((const double(*)[3])picture[which], SIDE, SIDE, options, &o, &error) !=
      ABBE_OK)
    fail_msg("%s", error.text);
  return o;
}

static abbe_outline_agreement agreement(const abbe_outline_options *options) {
  OWNED(abbe_outline, a) = outline(0, options), b = outline(1, options);
  abbe_outline_agreement out;
  OK(abbe_outline_compare(&a, &b, &out, &error));
  return out;
}

static const double white[3] = {1, 1, 1};

TEST(equal_pictures_agree) {
  static const double tint[3] = {3, 1, 0.5};
  for (int i = 0; i < 2; i++) {
    clear(i);
    add_disk(i, 50, 60, 20, white);
    add_disk(i, 80, 60, 10, tint);
  }
  for (int i = 0; i < 2; i++) {
    const abbe_outline_agreement a = agreement(i == 0 ? NULL : &all);
    assert_near(a.light_ratio, 1, 0);
    assert_near(a.overlap, 1, 0);
    assert_near(a.mean_apart, 0, 0);
    assert_near(a.p95_apart, 0, 0);
    assert_near(a.hue[ABBE_OUTLINE_RED].apart, 0, 0);
    assert_near(a.hue[ABBE_OUTLINE_RED].overlap, 1, 1e-12);
    assert_true(isnan(a.hue[ABBE_OUTLINE_BLUE].apart));
    assert_near(a.hue[ABBE_OUTLINE_BLUE].overlap, 0, 0);
  }
}

/* A disk that moves by d keeps of two circles' lens what geometry says, and its rim is |d cos| of
 * the angle away, 2 d / pi in the mean, where d is small against the radius. */
TEST(a_moved_disk) {
  const double pi = 3.14159265358979, r = 30, d = 6;
  clear(0);
  clear(1);
  add_disk(0, 60, 64, r, white);
  add_disk(1, 60 + d, 64, r, white);
  const abbe_outline_agreement a = agreement(&all);
  const double lens = 2 * r * r * acos(d / (2 * r)) - 0.5 * d * sqrt(4 * r * r - d * d);
  assert_near(a.overlap, lens / (2 * pi * r * r - lens), 0.01); /* pixels at 190 of rim */
  assert_near(a.mean_apart, 2 * d / pi, 0.3);
  assert_true(a.p95_apart > 0.9 * d && a.p95_apart <= d);
  assert_near(a.light_ratio, 1, 0);
}

/* Brightness leaves place alone; smoothing keeps light, also at the picture's edge. */
TEST(brightness_does_not_matter) {
  static const double bright[3] = {64, 64, 64};
  clear(0);
  clear(1);
  add_disk(0, 3, 64, 20, white);
  add_disk(1, 3, 64, 20, bright);
  const abbe_outline_options wide = {.blur = 5};
  const abbe_outline_agreement a = agreement(&wide);
  assert_near(a.light_ratio, 64, 1e-9);
  assert_near(a.overlap, 1, 0);
  OWNED(abbe_outline, o) = outline(0, &wide);
  double sum = 0;
  for (int i = 0; i < COUNT; i++) sum += picture[0][i][1];
  assert_near(o.light, sum, 1e-9 * sum); /* white: Y is its red, its green, its blue */
  assert_near(o.tinted, 0, 1e-12);
}

TEST(the_outline_holds_its_share) {
  static const double core[3] = {9, 9, 9};
  clear(0);
  add_disk(0, 64, 64, 40, white);
  add_disk(0, 64, 64, 10, core);
  /* the core: 10 of 10 per pixel on 1 / 16 of the disk: 40 % of the light */
  const abbe_outline_options inner = {.share = 0.39, .blur = -1};
  OWNED(abbe_outline, o) = outline(0, &inner);
  assert_true(o.mask.inside <= 318 && o.mask.inside > 290); /* 100 pi pixels */
  abbe_outline_free(&o);
  o = outline(0, &all);
  assert_near((double)o.mask.inside, 1600 * 3.14159265, 40);
}

/* A band of each hue of its own, in rows from the top: their centres are known. */
TEST(hues_have_their_places) {
  static const double rgb[6][3] = {{2, 1, 1}, {2, 2, 1}, {1, 2, 1},
                                   {1, 2, 2}, {1, 1, 2}, {2, 1, 2}};
  clear(0);
  for (int i = 0; i < COUNT; i++)
    if (i / SIDE < 120) memcpy(picture[0][i], rgb[i / SIDE / 20], sizeof *rgb);
  OWNED(abbe_outline, o) = outline(0, &all);
  for (int h = 0; h < ABBE_OUTLINE_HUE_COUNT; h++) {
    assert_near(o.place[h].share, 1 / 6.0, 1e-12);
    assert_near(o.place[h].x, SIDE / 2.0, 1e-9);
    assert_near(o.place[h].y, 20 * h + 10, 1e-9);
    /* of a uniform rectangle of whole pixels */
    assert_near(o.place[h].spread, sqrt((SIDE * SIDE - 1 + 399) / 12.0), 1e-6);
  }
  assert_near(o.tinted, 1 / 4.5, 1e-12); /* 1 in 4 or in 5, in equal parts over unequal sums */
}

TEST(hues_at_the_sectors_borders) {
  static const struct {
    double rgb[3];
    int hue;
  } rows[] = {{{1, 0.49, 0}, ABBE_OUTLINE_RED},     {{1, 0.51, 0}, ABBE_OUTLINE_YELLOW},
              {{0.51, 1, 0}, ABBE_OUTLINE_YELLOW},  {{0.49, 1, 0}, ABBE_OUTLINE_GREEN},
              {{0, 1, 0.51}, ABBE_OUTLINE_CYAN},    {{0, 0.49, 1}, ABBE_OUTLINE_BLUE},
              {{0.51, 0, 1}, ABBE_OUTLINE_MAGENTA}, {{1, 0, 0.51}, ABBE_OUTLINE_MAGENTA},
              {{1, 0, 0.49}, ABBE_OUTLINE_RED},     {{1, -0.1, -0.2}, ABBE_OUTLINE_RED},
              {{-0.2, 0.9, 1}, ABBE_OUTLINE_CYAN}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    clear(0);
    add_disk(0, 64, 64, 9, rows[i].rgb);
    OWNED(abbe_outline, o) = outline(0, &all);
    assert_near(o.place[rows[i].hue].share, 1, 1e-12);
  }
}

/* Half of a hue stays, half goes 40 pixels to the right: half of it overlaps, 20 pixels apart. */
TEST(hues_that_move_in_part) {
  static const double blue[3] = {0, 0, 5};
  for (int i = 0; i < 2; i++) {
    clear(i);
    add_disk(i, 64, 64, 60, white);
    add_disk(i, 40, 40, 8, blue);
    add_disk(i, 40 + 40 * i, 80, 8, blue);
  }
  const abbe_outline_agreement a = agreement(&all);
  assert_near(a.hue[ABBE_OUTLINE_BLUE].overlap, 0.5, 1e-9);
  assert_near(a.hue[ABBE_OUTLINE_BLUE].apart, 20, 1e-9);
}

TEST(awkward_pictures) {
  abbe_outline o;
  clear(0);
  REFUSED(ABBE_INVALID_ARGUMENT, "dark",
          abbe_outline_make((const double(*)[3])picture[0], SIDE, SIDE, NULL, &o, &error));
  picture[0][7][1] = NAN;
  picture[0][8][2] = INFINITY;
  picture[0][SIDE + 9][0] = 1;
  o = outline(0, &all);
  assert_int_equal(o.mask.inside, 1);
  OWNED(abbe_outline, one) = outline(0, &all);
  abbe_outline_agreement a;
  OK(abbe_outline_compare(&o, &one, &a, &error));
  assert_near(a.mean_apart, 0, 0);
  abbe_outline_free(&one);
  OK(abbe_outline_make((const double(*)[3])picture[0], SIDE, SIDE / 2, &all, &one, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "128 x 128 and 128 x 64",
          abbe_outline_compare(&o, &one, &a, &error));
  abbe_outline_free(&o);
  static const abbe_outline_options wrong[] = {
      {.share = 1.01}, {.share = -1}, {.share = NAN}, {.blur = 65}, {.blur = NAN}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    assert_int_equal(
        abbe_outline_make((const double(*)[3])picture[0], SIDE, SIDE, &wrong[i], &o, NULL),
        ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_outline_make((const double(*)[3])picture[0], 0, SIDE, NULL, &o, NULL),
                   ABBE_INVALID_ARGUMENT);
  abbe_outline_free(NULL);
}
