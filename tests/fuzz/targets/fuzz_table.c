#include "tests/fuzz/keeps.h"

#include "spectral/materials/material_table.h"

const char *const fuzz_words[] = {"materials:\n",
                                  "  - name: x\n",
                                  "model: cauchy\n",
                                  "coefficients: [",
                                  "points: [[400, 1.5]]",
                                  "absorption: {",
                                  "attenuation_per_m: ",
                                  "transmittance: ",
                                  "thickness_m: 0.01",
                                  "colour: [1, 1, 1]",
                                  "catalogue: {",
                                  "fit: {cauchy2: {",
                                  "&a ",
                                  "*a",
                                  "!!str ",
                                  "|\n",
                                  ">-\n",
                                  "? ",
                                  NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_material_table table;
  abbe_error error = {0};
  if (FUZZED(abbe_material_table_parse((const char *)data, size, "f.yaml", &table, &error),
             &error) == ABBE_OK)
    fuzz_keeps(&table);
  else
    FUZZ_PROMISE(error.text[0] != '\0' && table.material == NULL);
  abbe_material_table_free(&table);
  return 0;
}
