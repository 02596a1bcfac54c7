#include "tests/spectral/random_material.h"
#include "tests/spectral/same_material.h"

#include "spectral/dispersion/csv_points.h"
#include "spectral/formats/material_write.h"

static abbe_csv_points reread(const abbe_material *m, const abbe_csv_sampling *sampling,
                              abbe_report *report) {
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  OK(abbe_csv_write(m, sampling, to, report, &error));
  fclose(to);
  abbe_csv_points points;
  OK(abbe_csv_points_parse(text, size, "x.csv", NULL, &points, NULL, &error));
  return points;
}

TEST(written_points_are_the_materials) {
  srand(4);
  for (size_t i = 0; i < 200; i++) {
    OWNED(abbe_material, m) = random_material(i);
    OWNED(abbe_report, report) = {0};
    OWNED(abbe_csv_points, p) = reread(&m, NULL, &report);
    for (size_t k = 0; k < p.n.count; k++) {
      double n = 0;
      OK(abbe_material_n(&m, p.n.point[k].lambda_nm, &n, &error));
      assert_near(p.n.point[k].value, n, 1e-14);
    }
    if (m.dispersion.table != NULL)
      assert_int_equal(p.n.count, abbe_spectrum_count(m.dispersion.table));
    else
      assert_int_equal(p.n.count, 81); /* 380 to 780 */
    assert_int_equal(p.k.count, m.attenuation != NULL ? p.n.count : 0);
    assert_true(report.kinds[ABBE_NOTE_LOST] > 0);
  }
}

static char name[] = "glass", source[] = "s";

static abbe_material glass(void) {
  return (abbe_material){.name = name,
                         .source = source,
                         .min_nm = 400,
                         .max_nm = 700,
                         .dispersion = {ABBE_DISPERSION_CAUCHY, 2, {1.5, 0.004}, NULL}};
}

/* The error that is told is that of straight lines through the points. */
TEST(sampling_is_asked_for_and_its_error_told) {
  abbe_material m = glass();
  OWNED(abbe_report, report) = {0};
  OWNED(abbe_csv_points, p) = reread(&m, &(abbe_csv_sampling){450, 525, 50}, &report);
  assert_int_equal(p.n.count, 3);
  assert_near(p.n.point[1].lambda_nm, 500, 0);
  assert_near(p.n.point[2].lambda_nm, 525, 0);
  double worst = 0.004 * ((1 / 0.45 / 0.45 + 1 / 0.5 / 0.5) / 2 - 1 / 0.475 / 0.475);
  assert_contains(report.note[0].text, printed("off by up to %.2g", worst));
}

TEST(what_cannot_be_sampled_is_refused) {
  abbe_material m = glass();
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  REFUSED(ABBE_OUT_OF_RANGE, "glass has no index at 380 nm",
          abbe_csv_write(&m, &(abbe_csv_sampling){380, 780, 5}, to, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_csv_write(&m, &(abbe_csv_sampling){400, 700, -1}, to, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "at most 65536 points",
          abbe_csv_write(&m, &(abbe_csv_sampling){400, 700, 1e-4}, to, NULL, &error));
  fclose(to);
  FILE *full = fopen("/dev/full", "w");
  REFUSED(ABBE_IO, "", abbe_csv_write(&m, NULL, full, NULL, &error));
  fclose(full);
}
