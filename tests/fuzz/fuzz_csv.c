#include "tests/fuzz/keeps.h"

#include "spectral/material_import.h"

const char *const fuzz_words[] = {
    "wavelength_nm,n\n", "wl (um);n;k\n", "wl,k\n",      ",", ";", "\t",
    "\n500,1.5\n",       "0,5;1,5\n",     "uncertainty", "#", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const abbe_import_options options[] = {
      {.format = ABBE_IMPORT_CSV, .csv = {.third = ABBE_CSV_K}},
      {.format = ABBE_IMPORT_CSV, .csv = {.third = ABBE_CSV_UNCERTAINTY, .repeats = true}},
      {.format = ABBE_IMPORT_AUTO},
  };
  for (int i = 0; i < 3; i++) {
    abbe_material_table table = {0};
    abbe_report report = {0};
    abbe_error error = {0};
    abbe_result result =
        abbe_import_parse((const char *)data, size, "f.csv", &options[i], &table, &report, &error);
    FUZZ_PROMISE(result == ABBE_OK || (error.text[0] != '\0' && table.count == 0));
    if (result == ABBE_OK) abbe_material_table_unique(&table, NULL, NULL);
    if (result == ABBE_OK) fuzz_keeps(&table);
    abbe_material_table_free(&table);
    abbe_report_free(&report);
  }
  return 0;
}
