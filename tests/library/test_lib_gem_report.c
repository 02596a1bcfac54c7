/* A design judged by handle: shares that add up, a diamond above quartz, what is refused. */
#include "tests/check.h"

#include "library/lib_gem_report.h"

#include <unistd.h>

static const char *const design = ABBE_SOURCE_DIR "/scenes/designs/brilliant-diamond.asc";
static const char *const coarse[] = {"size=16", "repeats=3", "wavelengths=2", "tilt_rad=0"};

static double number_of(const abbe_lib_gem_report *r, const char *name) {
  for (size_t i = 0; abbe_lib_gem_report_name(r, i) != NULL; i++) {
    double value, error;
    if (strcmp(abbe_lib_gem_report_name(r, i), name) != 0) continue;
    assert_non_null(abbe_lib_gem_report_text(r, i));
    assert_int_equal(abbe_lib_gem_report_number(r, i, &value, &error, NULL), ABBE_OK);
    assert_true(error >= 0);
    return value;
  }
  return NAN;
}

static abbe_lib_gem_report *judged(const char *material) {
  abbe_lib_gem_report *r = NULL;
  OK(abbe_lib_gem_report_make(design, material, coarse, 4, NULL, NULL, &r, &error));
  return r;
}

TEST(shares_add_up) {
  abbe_lib_gem_report *diamond = judged("diamond"), *quartz = judged("quartz");
  const double up = number_of(diamond, "iso"), down = number_of(diamond, "leakage");
  assert_near(up + down + number_of(diamond, "absorbed") + number_of(diamond, "left"), 1, 1e-5);
  /* under a head, the cut for diamond returns less of quartz */
  assert_true(number_of(diamond, "return") > number_of(quartz, "return") + 0.1);
  assert_true(isnan(number_of(diamond, "fire"))); /* not tilted */
  abbe_lib_picture *maps = NULL;
  OK(abbe_lib_gem_report_maps(diamond, &maps, &error));
  assert_int_equal(abbe_lib_picture_width(maps), 16);
  abbe_lib_picture_free(maps);
  abbe_lib_gem_report_free(diamond);
  abbe_lib_gem_report_free(quartz);
}

/* What a degree does goes the way in which the numbers of finer reports go, and is said where it is
 * asked for alone. */
TEST(a_degree_more) {
  static const char *const with[] = {"size=16", "repeats=3", "wavelengths=2", "tilt_rad=0",
                                     "slopes=1"};
  abbe_lib_gem_report *plain = judged("diamond"), *r = NULL, *off = NULL;
  OK(abbe_lib_gem_report_make(design, "diamond", with, 5, NULL, NULL, &r, &error));
  assert_true(isnan(number_of(plain, "iso_by_crown")));
  static const char *const by[] = {"iso_by_crown", "iso_by_pavilion"};
  static const double own[] = {0.602138592, 0.711221671}, degree = 0.0174532925;
  static const char *const keys[] = {"crown_rad", "pavilion_rad"};
  for (int side = 0; side < 2; side++) {
    double value[2];
    for (int s = 0; s < 2; s++) {
      char to[64];
      snprintf(to, sizeof to, "%s=%.9f", keys[side], own[side] + (2 * s - 1) * degree);
      const char *moved[] = {"size=48", "repeats=3", "wavelengths=2", "tilt_rad=0", to};
      OK(abbe_lib_gem_report_make(design, "diamond", moved, 5, NULL, NULL, &off, &error));
      value[s] = number_of(off, "iso");
      abbe_lib_gem_report_free(off);
    }
    assert_true(number_of(r, by[side]) * (value[1] - value[0]) > 0);
  }
  assert_true(isfinite(number_of(r, "fire_by_pavilion")));
  abbe_lib_gem_report_free(plain);
  abbe_lib_gem_report_free(r);
}

/* A cut has more facets than a scene's stone may have. */
TEST(a_degree_more_of_many_facets) {
  static const char *const with[] = {"size=8", "repeats=3", "wavelengths=2", "tilt_rad=0",
                                     "slopes=1"};
  static const struct { double angle, distance; } ring[] = {{-90, 1}, {-43, 0.7173}, {42, 0.70453}};
  char folder[] = "/tmp/abbe-many-XXXXXX";
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/many.asc", folder);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fprintf(file, "GemCad 5.0\ng 100 0.0\ny 100 y\nI 1.544\n");
  for (int r = 0; r < 3; r++) {
    fprintf(file, "a %g %g", ring[r].angle, ring[r].distance);
    for (int i = 1; i <= 100; i++) fprintf(file, " %d%s", i, i == 1 ? r == 0 ? " n G" : "" : "");
    fprintf(file, "\n");
  }
  fprintf(file, "a 0 0.474 100 n T\n");
  fclose(file);
  abbe_lib_gem_report *r = NULL;
  OK(abbe_lib_gem_report_make(path, "quartz", with, 5, NULL, NULL, &r, &error));
  assert_true(isfinite(number_of(r, "return_by_crown")));
  assert_true(isfinite(number_of(r, "return_by_pavilion")));
  abbe_lib_gem_report_free(r);
  remove(path);
  rmdir(folder);
}

/* Its own angles change nothing; a flat pavilion is a window. */
TEST(angles_are_others) {
  static const char *const own[] = {"size=16",
                                    "repeats=3",
                                    "wavelengths=2",
                                    "tilt_rad=0",
                                    "crown_rad=0.602138592",
                                    "pavilion_rad=0.711221671"};
  static const char *const flat[] = {"size=16", "repeats=3", "wavelengths=2", "tilt_rad=0",
                                     "pavilion_rad=0.35"};
  abbe_lib_gem_report *as_it_is = judged("quartz"), *same = NULL, *window = NULL;
  OK(abbe_lib_gem_report_make(design, "quartz", own, 6, NULL, NULL, &same, &error));
  OK(abbe_lib_gem_report_make(design, "quartz", flat, 5, NULL, NULL, &window, &error));
  const double is = number_of(as_it_is, "area_window");
  assert_near(number_of(same, "return"), number_of(as_it_is, "return"), 1e-3);
  assert_true(number_of(window, "area_window") > is + 0.1);
  abbe_lib_gem_report_free(as_it_is);
  abbe_lib_gem_report_free(same);
  abbe_lib_gem_report_free(window);
}

TEST(a_crystal_lies_as_it_is_laid) {
  static const char *const lying[] = {"size=16", "repeats=3", "wavelengths=2", "tilt_rad=0",
                                      "axis=1,0,0"};
  abbe_lib_gem_report *up = judged("zircon"), *down = NULL;
  OK(abbe_lib_gem_report_make(design, "zircon", lying, 5, NULL, NULL, &down, &error));
  assert_near(number_of(up, "iso_lying_x"), number_of(down, "iso_lying_x"), 0);
  assert_near(number_of(down, "iso_upright"), number_of(up, "iso_upright"), 0);
  assert_true(fabs(number_of(up, "iso") - number_of(down, "iso")) > 1e-4);
  abbe_lib_gem_report_free(up);
  abbe_lib_gem_report_free(down);
  REFUSED(ABBE_INVALID_ARGUMENT, "no axis",
          abbe_lib_gem_report_make(design, "diamond", lying, 5, NULL, NULL, &down, &error));
}

TEST(what_is_none_is_refused) {
  abbe_lib_gem_report *r = NULL;
  REFUSED(ABBE_NOT_FOUND, "",
          abbe_lib_gem_report_make(design, "dimond", coarse, 4, NULL, NULL, &r, &error));
  REFUSED(ABBE_UNSUPPORTED, "",
          abbe_lib_gem_report_make(design, "gold", coarse, 4, NULL, NULL, &r, &error));
  REFUSED(ABBE_IO, "",
          abbe_lib_gem_report_make("/nowhere.asc", "diamond", coarse, 4, NULL, NULL, &r, &error));
  const char *const wrong[] = {"head_rad=1"};
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_lib_gem_report_make(design, "diamond", wrong, 1, NULL, NULL, &r, &error));
  assert_null(r);
  r = judged("diamond");
  double value, off;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_lib_gem_report_number(r, 99, &value, &off, &error));
  assert_null(abbe_lib_gem_report_name(r, 99));
  abbe_lib_gem_report_free(r);
}
