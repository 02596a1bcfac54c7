/* A sweep's chart: the file's texts say what is drawn, and what cannot be drawn is refused. */
#include "tests/fontconfig.h"
#include "tests/validation/tradeoff/sweep_row.h"

#include "base/file.h"
#include "colorimetry/image/png_file.h"
#include "validation/tradeoff/sweep_plot.h"

#include <unistd.h>

static void add(abbe_sweep_table *table, const char *profile, size_t photons, double ms, double e) {
  abbe_sweep_row row = sweep_row(profile, photons);
  row.number[ABBE_SWEEP_FRAME_MS] = ms;
  row.number[ABBE_SWEEP_CAUSTIC_DE] = e;
  row.number[ABBE_SWEEP_CAUSTIC_DE_NOISE] = 0.05;
  OK(abbe_sweep_table_add(table, &row, &error));
}

TEST(the_chart) {
  char folder[] = "/tmp/abbe-test-sweep-plot-XXXXXX", path[64], *text;
  size_t size;
  OWNED(abbe_sweep_table, table) = {0};
  static const abbe_sweep_number numbers[] = {ABBE_SWEEP_CAUSTIC_DE, ABBE_SWEEP_FRAME_MS,
                                              ABBE_SWEEP_PICTURE_DE};
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/a.png", folder);
  REFUSED(ABBE_INVALID_ARGUMENT, "no setting has a known 'caustic_de'",
          abbe_sweep_plot(path, &table, ABBE_SWEEP_FRAME_MS, numbers, 1, &error));
  abbe_sweep_table_set(&table, ABBE_SWEEP_FACT_SCENE, "gem.yaml");
  add(&table, "default", 64, 10, 3);
  add(&table, "default", 256, 100, 0.3);
  add(&table, "default", 128, 120, 2);
  add(&table, "thesis", 512, 90, 20);
  add(&table, "thesis", 1024, 0.0 / 0.0, 20);
  OK(abbe_sweep_plot(path, &table, ABBE_SWEEP_FRAME_MS, numbers, 1, &error));
  OK(abbe_file_read(path, 1 << 22, &text, &size, &error));
  assert_memory_equal(text + 1, "PNG", 3);
  free(text);
  unlink(path);
  REFUSED(ABBE_INVALID_ARGUMENT, "'frame_ms' is no error",
          abbe_sweep_plot(path, &table, ABBE_SWEEP_FRAME_MS, numbers + 1, 1, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_sweep_plot(path, &table, ABBE_SWEEP_FRAME_MS, numbers, 3, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_sweep_plot(path, &table, ABBE_SWEEP_FRAME_MS, numbers, 0, &error));
  assert_int_equal(rmdir(folder), 0);
}

static abbe_result plot_scenes(const char *path, const abbe_sweep_table *tables, size_t count,
                               abbe_sweep_number number, abbe_error *error) {
  *error = (abbe_error){0};
  return abbe_sweep_plot_scenes(path, tables, count, number, error);
}

/* A row a scene, a column a time that is known. */
TEST(scenes) {
  char folder[] = "/tmp/abbe-test-sweep-plot-XXXXXX", path[64];
  abbe_sweep_table tables[17] = {0};
  abbe_image image;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/a.png", folder);
  REFUSED(ABBE_INVALID_ARGUMENT, "no setting has a known time",
          plot_scenes(path, tables, 2, ABBE_SWEEP_CAUSTIC_DE, &error));
  for (size_t i = 0; i < 2; i++) {
    abbe_sweep_table_set(&tables[i], ABBE_SWEEP_FACT_SCENE, i == 0 ? "a/gem.yaml" : "a/ball.yaml");
    add(&tables[i], "default", 64, 10, 3);
    add(&tables[i], "thesis", 512, 90, 20);
  }
  OK(plot_scenes(path, tables, 2, ABBE_SWEEP_CAUSTIC_DE, &error));
  OK(abbe_png_read(path, &image, &error));
  assert_int_equal(image.width, 420);
  assert_int_equal(image.height, 460);
  abbe_image_free(&image);
  unlink(path);
  for (size_t k = 0; k < 2; k++) tables[0].row[k].number[ABBE_SWEEP_WARM_MS] = 500;
  REFUSED(ABBE_INVALID_ARGUMENT, "ball.yaml: no setting has a known 'warm_ms' and 'caustic_de'",
          plot_scenes(path, tables, 2, ABBE_SWEEP_CAUSTIC_DE, &error));
  tables[1].row[0].number[ABBE_SWEEP_WARM_MS] = 400;
  OK(plot_scenes(path, tables, 2, ABBE_SWEEP_CAUSTIC_DE, &error));
  OK(abbe_png_read(path, &image, &error));
  assert_int_equal(image.width, 840);
  abbe_image_free(&image);
  REFUSED(ABBE_INVALID_ARGUMENT, "", plot_scenes(path, tables, 2, ABBE_SWEEP_WARM_MS, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", plot_scenes(path, tables, 17, ABBE_SWEEP_CAUSTIC_DE, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", plot_scenes(path, tables, 0, ABBE_SWEEP_CAUSTIC_DE, &error));
  unlink(path);
  assert_int_equal(rmdir(folder), 0);
  for (size_t i = 0; i < 2; i++) abbe_sweep_table_free(&tables[i]);
}
