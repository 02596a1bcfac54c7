#include "tests/fuzz/keeps.h"

#include "spectral/formats/material_import.h"

const char *const fuzz_words[] = {"NM ",           "GC ",
                                  "ED ",           "CD ",
                                  "TD ",           "OD ",
                                  "LD ",           "IT ",
                                  "CC ",           "\nNM A 2 0 1.5 60\n",
                                  "\nCD 1 0.01\n", "\nLD 0.3 2\n",
                                  "source: ",      "; source: ",
                                  "\xff\xfe",      NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_material_table table;
  abbe_report report = {0};
  abbe_error error = {0};
  if (FUZZED(abbe_agf_parse((const char *)data, size, "f.agf", &table, &report, &error), &error) ==
      ABBE_OK)
    fuzz_keeps(&table);
  else
    FUZZ_PROMISE(error.text[0] != '\0' && table.material == NULL);
  abbe_material_table_free(&table);
  abbe_report_free(&report);
  return 0;
}
