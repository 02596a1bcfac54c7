/* MaterialX documents. */
#include "tests/fuzz/keeps.h"

#include "spectral/formats/material_import.h"

const char *const fuzz_words[] = {"<materialx>",
                                  "</materialx>",
                                  "<open_pbr_surface name=\"SR_a\">",
                                  "</open_pbr_surface>",
                                  "<standard_surface name=\"b\">",
                                  "<gltf_pbr name=\"c\">",
                                  "</gltf_pbr>",
                                  "<surfacematerial name=\"stone\">",
                                  "</surfacematerial>",
                                  "<input name=\"transmission\" value=\"1\"/>",
                                  "<input name=\"surfaceshader\" nodename=\"SR_a\"/>",
                                  "<input name=\"transmission_color\" value=\"1, 0.5, 0\"/>",
                                  "&#xe9;",
                                  "&#10;",
                                  "<!DOCTYPE a [<!ENTITY b \"",
                                  NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  static const abbe_import_options options = {.format = ABBE_IMPORT_MTLX};
  abbe_material_table table = {0};
  abbe_report report = {0};
  abbe_error error = {0};
  const abbe_result result = FUZZED(
      abbe_import_parse((const char *)data, size, "f.mtlx", &options, &table, &report, &error),
      &error);
  FUZZ_PROMISE(result == ABBE_OK || (error.text[0] != '\0' && table.count == 0));
  if (result == ABBE_OK) abbe_material_table_unique(&table, NULL, NULL);
  if (result == ABBE_OK && table.count > 0) fuzz_keeps(&table); /* else all are skipped */
  abbe_material_table_free(&table);
  abbe_report_free(&report);
  return 0;
}
