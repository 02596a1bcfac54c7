#define _XOPEN_SOURCE 700
#include "tests/check.h"
#include "tests/fontconfig.h"

#include "colorimetry/image/png_file.h"
#include "colorimetry/plot/material_chart.h"
#include "spectral/formats/material_import.h"

#include <unistd.h>

static char folder[64], path[96];
static abbe_material_table table;

static void set_up(void) {
  snprintf(folder, sizeof folder, "/tmp/abbe-test-material-chart-XXXXXX");
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/c.png", folder);
  OK(abbe_material_table_load("default", &table, &error));
}

static void tear_down(void) {
  abbe_material_table_free(&table);
  unlink(path);
  assert_false(rmdir(folder));
}

static const abbe_material *find(const char *name) {
  const abbe_material *m = NULL;
  OK(abbe_material_table_find(&table, name, &m, &error));
  return m;
}

/* Columns of the picture that hold at least so many pixels of that colour. */
static size_t columns_within(double r, double g, double b, double within, size_t least) {
  size_t count = 0;
  MADE(abbe_image, image, abbe_png_read(path, &image, &error));
  for (size_t x = 0; x < image.width; x++) {
    size_t hits = 0;
    for (size_t y = 0; y < image.height; y++) {
      const float *p = image.data + 3 * (y * image.width + x);
      hits += fabs((double)p[0] - r) < within && fabs((double)p[1] - g) < within &&
              fabs((double)p[2] - b) < within;
    }
    count += hits >= least;
  }
  return count;
}

static size_t columns(double r, double g, double b) {
  return columns_within(r, g, b, 0.1, 1);
}
static size_t blue(void) {
  return columns(0, 0.447, 0.698);
}
static size_t shaded(void) {
  return columns_within(0.92, 0.92, 0.92, 0.01, 200);
}

static void draw(const abbe_material_chart *chart) {
  OK(abbe_material_chart_write(path, chart, &error));
}

EACH(set_up, tear_down);

/* A curve takes up as much of the picture's width as its data do of the wavelengths. */
TEST(curves_reach_as_far_as_their_data) {
  const abbe_material *bk7 = find("n-bk7"), *water = find("water"); /* from 182 to 1129 nm */
  abbe_material_chart chart = {.count = 1, .material = &bk7};
  draw(&chart);
  double whole = (double)blue();
  assert_true(whole > 800);
  chart = (abbe_material_chart){.count = 1, .material = &water, .min_nm = 629, .max_nm = 1629};
  draw(&chart);
  assert_near((double)blue() / whole, 0.5, 0.05); /* and the legend's sample */
  assert_near((double)shaded() / whole, 0.5, 0.01);
}

/* A record that allows it is continued in dashes, over a shaded ground. */
TEST(continued_curves_are_dashed) {
  const abbe_material *k5 = find("k5"); /* from 400 to 700 nm */
  abbe_material_chart chart = {.count = 1, .material = &k5, .min_nm = 400, .max_nm = 700};
  draw(&chart);
  double whole = (double)blue();
  chart = (abbe_material_chart){.count = 1, .material = &k5, .min_nm = 100, .max_nm = 700};
  draw(&chart);
  /* half is solid; of the other half the part within reach is dashed, six on and four off */
  assert_true((double)blue() / whole > 0.5 && (double)blue() / whole < 0.85);
  chart = (abbe_material_chart){.count = 1, .material = &k5, .min_nm = 300, .max_nm = 800};
  draw(&chart);
  assert_near((double)shaded() / whole, 0.4, 0.02); /* both ends in one grey */
}

TEST(fits_and_measurements_are_drawn) {
  const abbe_material *m[2] = {find("n-bk7"), find("f2")};
  const char *csv = "435.8,1.5267,3e-4\n546.1,1.5187,2e-4\n656.3,1.5143,2e-4\n";
  MADE(abbe_index_points, points, abbe_index_points_parse(csv, strlen(csv), "p", &points, &error));
  abbe_material_chart chart = {.count = 1, .material = m};
  draw(&chart);
  assert_int_equal(columns(0.835, 0.369, 0), 0); /* the first fit's colour */
  chart.fits = true;
  draw(&chart);
  assert_true(columns(0.835, 0.369, 0) > 800);
  chart = (abbe_material_chart){.count = 2, .material = m, .fits = true, .points = &points};
  draw(&chart);
  chart = (abbe_material_chart){
      .count = 1, .material = m, .points = &points, .min_nm = 300, .max_nm = 310};
  draw(&chart); /* no point in the range */
}

TEST(the_map_shows_all_that_have_numbers) {
  const abbe_material_table *tables[] = {&table};
  const abbe_material *marked = find("n-bk7");
  abbe_material_map map = {.table_count = 1, .table = tables, .marked_count = 1, .marked = &marked};
  size_t left_out = 0, constant = 0;
  for (size_t i = 0; i < table.count; i++)
    constant += table.material[i].dispersion.model == ABBE_DISPERSION_CONSTANT;
  OK(abbe_material_map_write(path, &map, &left_out, &error));
  assert_int_equal(left_out, constant);
  assert_true(columns(0.835, 0.369, 0) >= 5); /* the marked one */
  assert_true(blue() >= 40);
}

TEST(what_cannot_be_drawn_is_refused) {
  const abbe_material *m = find("n-bk7");
  abbe_material_chart chart = {.count = 1, .material = &m, .min_nm = 5000, .max_nm = 6000};
  REFUSED(ABBE_OUT_OF_RANGE, "n-bk7 has no index from 5000 to 6000 nm",
          abbe_material_chart_write(path, &chart, &error));
  chart = (abbe_material_chart){.count = 0};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_material_chart_write(path, &chart, &error));
  chart = (abbe_material_chart){.count = 1, .material = &m};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_material_chart_write("c.jpg", &chart, &error));
  const char *text = "materials: [{name: a, model: constant, coefficients: [1.5], source: s}]";
  OWNED(abbe_material_table, flat);
  const abbe_material_table *tables[] = {&flat};
  OK(abbe_material_table_parse(text, strlen(text), "t", &flat, &error));
  abbe_material_map map = {.table_count = 1, .table = tables};
  REFUSED(ABBE_NOT_FOUND, "", abbe_material_map_write(path, &map, NULL, &error));
  map.table_count = 0;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_material_map_write(path, &map, NULL, &error));
  m = &flat.material[0];
  draw(&chart); /* a flat line */
}
