#include "tests/fuzz/keeps.h"

#include "spectral/formats/material_import.h"

const char *const fuzz_words[] = {"DATA:\n",
                                  "  - type: formula 2\n",
                                  "tabulated nk",
                                  "tabulated n",
                                  "tabulated k",
                                  "formula 4",
                                  "formula 5",
                                  "formula 9",
                                  "    wavelength_range: 0.3 2.5\n",
                                  "coefficients: ",
                                  "    data: |\n        ",
                                  "REFERENCES: ",
                                  "PROPERTIES:\n",
                                  "n_absolute: true",
                                  "<br>",
                                  "&amp;",
                                  NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_material material;
  abbe_report report = {0};
  abbe_error error = {0};
  if (FUZZED(abbe_rii_parse((const char *)data, size, "f.yml", NULL, &material, &report, &error),
             &error) == ABBE_OK) {
    abbe_material_table table = {.count = 1, .material = &material};
    fuzz_keeps(&table);
    abbe_material_free(&material);
  } else {
    FUZZ_PROMISE(error.text[0] != '\0' && material.name == NULL);
  }
  abbe_report_free(&report);
  return 0;
}
