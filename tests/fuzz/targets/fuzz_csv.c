#include "tests/fuzz/keeps.h"

#include "spectral/formats/material_import.h"

const char *const fuzz_words[] = {
    "wavelength_nm,n\n", "wl (um);n;k\n", "wl,k\n",      ",", ";", "\t",
    "\n500,1.5\n",       "0,5;1,5\n",     "uncertainty", "#", NULL};

/* A light's spectrum: powers of 0 or more at wavelengths that ascend, or a sentence. */
static void fuzz_light(const char *text, size_t size) {
  abbe_csv_points points;
  abbe_error error = {0};
  const abbe_csv_options light = {.quantity = ABBE_CSV_POWER};
  abbe_result result =
      FUZZED(abbe_csv_points_parse(text, size, "f.csv", &light, &points, NULL, &error), &error);
  FUZZ_PROMISE(result == ABBE_OK || error.text[0] != '\0');
  FUZZ_PROMISE(result == ABBE_OK || points.power.point == NULL);
  for (size_t i = 0; i < points.power.count && result == ABBE_OK; i++) {
    const abbe_point *p = &points.power.point[i];
    FUZZ_PROMISE(p->value >= 0 && isfinite(p->value));
    FUZZ_PROMISE(i == 0 ? p->lambda_nm > 0 : p->lambda_nm > p[-1].lambda_nm);
  }
  abbe_csv_points_free(&points);
}

int fuzz_input(const uint8_t *data, size_t size) {
  static const abbe_import_options options[] = {
      {.format = ABBE_IMPORT_CSV, .csv = {.third = ABBE_CSV_K}},
      {.format = ABBE_IMPORT_CSV, .csv = {.third = ABBE_CSV_UNCERTAINTY, .repeats = true}},
      {.format = ABBE_IMPORT_AUTO},
  };
  fuzz_light((const char *)data, size);
  for (int i = 0; i < 3; i++) {
    abbe_material_table table = {0};
    abbe_report report = {0};
    abbe_error error = {0};
    abbe_result result = FUZZED(
        abbe_import_parse((const char *)data, size, "f.csv", &options[i], &table, &report, &error),
        &error);
    FUZZ_PROMISE(result == ABBE_OK || (error.text[0] != '\0' && table.count == 0));
    if (result == ABBE_OK) abbe_material_table_unique(&table, NULL, NULL);
    if (result == ABBE_OK) fuzz_keeps(&table);
    abbe_material_table_free(&table);
    abbe_report_free(&report);
  }
  return 0;
}
