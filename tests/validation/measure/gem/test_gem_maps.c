#include "tests/check.h"

#include "base/file.h"
#include "tests/validation/measure/gem/gem_stones.h"
#include "validation/measure/gem/gem_maps.h"

#include <unistd.h>

static const abbe_gem_view_desc small = {.head_rad = 15 * DEG, .side = 24, .repeats = 3};

/* Of the middle pixel, which the stone fills. */
static void middle(const abbe_gem_view *view, abbe_gem_map map, float rgb[3]) {
  MADE(abbe_image, image, abbe_gem_map_paint(view, map, &image, &error));
  for (size_t c = 0; c < 3; c++) {
    rgb[c] = image.data[3 * (view->side * view->side / 2 + view->side / 2) + c];
    assert_near(image.data[c], 1, 0); /* white where no stone is */
  }
}

/* A roof shows the head alone; a plate shows what is behind it, and the head by its faces. */
TEST(colours_are_those_of_the_scopes) {
  char text[256];
  float rgb[3];
  roof_text(45, text);
  OWNED(judged, j) = judged_plain(text, 1.6);
  OWNED(abbe_gem_view, v) = judged_view(&j, &small);
  middle(&v, ABBE_GEM_MAP_ASET, rgb);
  assert_true(rgb[2] > 2 * rgb[0] && rgb[2] > 2 * rgb[1]);
  middle(&v, ABBE_GEM_MAP_IDEAL, rgb);
  assert_near(rgb[0], 0, 0.01);
  middle(&v, ABBE_GEM_MAP_ISO, rgb);
  assert_near(rgb[1], 1, 0.01);
  middle(&v, ABBE_GEM_MAP_COLOUR, rgb);
  assert_near(rgb[1], 0, 0.01); /* of one wavelength, and dark */
  abbe_gem_view_free(&v);
  judged_free(&j);
  j = judged_plain(slab, 1.5);
  v = judged_view(&j, &small);
  /* 0.923 of the light: sRGB's 0.965 */
  middle(&v, ABBE_GEM_MAP_LEAKAGE, rgb);
  assert_near(rgb[0], 0.9654, 1e-3);
  middle(&v, ABBE_GEM_MAP_IDEAL, rgb);
  assert_near(rgb[1], 0.9654, 1e-3);
  middle(&v, ABBE_GEM_MAP_ASET, rgb);
  assert_true(rgb[0] < 0.1f);
}

/* The means of its channels over the silhouette are the measures. */
TEST(channels_have_the_measures) {
  OWNED(judged, j) = judged_plain(design_b, 2.417);
  OWNED(abbe_gem_view, v) = judged_view(&j, &small);
  MADE(abbe_image, image, abbe_gem_map_image(&v, &image, &error));
  const size_t cover = abbe_image_find_channel(&image, "cover");
  const size_t y = abbe_image_find_channel(&image, "Y");
  assert_true(cover < image.channels && y < image.channels);
  for (int a = 0; a < ABBE_GEM_AMOUNT_COUNT; a++) {
    const size_t c = abbe_image_find_channel(&image, abbe_gem_amount_name((abbe_gem_amount)a));
    double sum = 0, met = 0;
    assert_true(c < image.channels);
    for (size_t i = 0; i < v.side * v.side; i++) {
      const float *p = image.data + i * image.channels;
      sum += (double)p[c] * (double)p[cover];
      met += (double)p[cover];
      if (a == ABBE_GEM_RETURN) assert_near(p[c], p[y], 1e-4);
    }
    assert_near(sum / met, abbe_gem_view_amount(&v, (abbe_gem_amount)a).value, 1e-5);
  }
}

/* Parts of a search for angles: together they are the one search, to the last bit, in any order;
 * what does not go together is named. */

enum { PARTS = 3 };
static const char *const path[PARTS] = {"grid_file_0.csv", "grid_file_1.csv", "grid_file_2.csv"};

static abbe_gem_optimum search(const judged *j, const abbe_material *m,
                               const abbe_gem_optimum_desc *desc, bool judge) {
  abbe_gem_optimum o;
  OK((judge ? abbe_gem_optimum_find : abbe_gem_optimum_begin)(
      &j->cut, &j->polyhedron, m, &j->wavelengths, &j->weights, desc, &o, &error));
  return o;
}

static void write_parts(const judged *j, const abbe_material *m) {
  for (size_t k = 0; k < PARTS; k++) {
    abbe_gem_optimum_desc desc = small_search();
    desc.part = k;
    desc.parts = PARTS;
    OWNED(abbe_gem_optimum, part) = search(j, m, &desc, true);
    assert_int_equal(abbe_gem_optimum_missing(&part, NULL), 8);
    OK(abbe_gem_grid_file_write(path[k], &part, &error));
  }
}

TEST(parts_are_the_whole) {
  const abbe_material quartz = glass(1.54);
  OWNED(judged, j) = judged_make(design_a, &quartz, 1);
  const abbe_gem_optimum_desc desc = small_search();
  OWNED(abbe_gem_optimum, whole) = search(&j, &quartz, &desc, true);
  OWNED(abbe_gem_optimum, merged) = search(&j, &quartz, &desc, false);
  size_t first = 0;
  write_parts(&j, &quartz);
  assert_int_equal(abbe_gem_optimum_missing(&whole, NULL), 0);
  OK(abbe_gem_grid_file_read(path[2], &merged, &error));
  OK(abbe_gem_grid_file_read(path[0], &merged, &error));
  assert_int_equal(abbe_gem_optimum_missing(&merged, &first), 4);
  assert_int_equal(first, 1);
  REFUSED(ABBE_INVALID_ARGUMENT, "known already",
          abbe_gem_grid_file_read(path[0], &merged, &error));
  OK(abbe_gem_grid_file_read(path[1], &merged, &error));
  assert_int_equal(abbe_gem_optimum_missing(&merged, NULL), 0);
  assert_memory_equal(merged.value, whole.value, 12 * sizeof *whole.value);
  assert_int_equal(merged.best, whole.best);
}

static void refuse(const judged *j, const abbe_material *m, const abbe_gem_optimum_desc *desc,
                   const char *text, abbe_result code, const char *says) {
  OWNED(abbe_gem_optimum, o) = search(j, m, desc, false);
  abbe_error why = {0};
  const char *from = path[0];
  if (text != NULL) {
    OK(abbe_file_write("grid_file_bad.csv", text, strlen(text), &error));
    from = "grid_file_bad.csv";
  }
  assert_int_equal(abbe_gem_grid_file_read(from, &o, &why), code);
  if (strstr(why.text, says) == NULL) fail_msg("'%s' does not say '%s'", why.text, says);
}

TEST(what_is_of_another_search_or_broken) {
  const abbe_material quartz = glass(1.54), heavy = glass(1.9);
  OWNED(judged, j) = judged_make(design_a, &quartz, 1);
  write_parts(&j, &quartz);
  abbe_gem_optimum_desc desc = small_search();
  refuse(&j, &heavy, &desc, NULL, ABBE_INVALID_ARGUMENT, "another search");
  desc.crowns = 4;
  refuse(&j, &quartz, &desc, NULL, ABBE_INVALID_ARGUMENT, "3 x 4");
  desc = small_search();
  desc.measure = ABBE_GEM_COS;
  refuse(&j, &quartz, &desc, NULL, ABBE_INVALID_ARGUMENT, "another search");
  desc = small_search();
  FREED char *data = NULL;
  char bad[4096];
  size_t size;
  OK(abbe_file_read(path[0], sizeof bad / 2, &data, &size, &error));
  snprintf(bad, sizeof bad, "%s99,0,0,0,0\n", data);
  refuse(&j, &quartz, &desc, bad, ABBE_PARSE, "line 7: pair 99 of 0 to 11");
  snprintf(bad, sizeof bad, "%s1,0.5,0.6,nan,0\n", data);
  refuse(&j, &quartz, &desc, bad, ABBE_PARSE, "line 7: column 4");
  refuse(&j, &quartz, &desc, "", ABBE_PARSE, "no table");
  refuse(&j, &quartz, &desc, "a,b\n1,2\n", ABBE_PARSE, "begins with");
  for (size_t k = 0; k < PARTS; k++) assert_int_equal(unlink(path[k]), 0);
  assert_int_equal(unlink("grid_file_bad.csv"), 0);
}
