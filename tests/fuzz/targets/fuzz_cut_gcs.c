/* Gem Cut Studio's designs. */
#include "scenes/cuts/cut_file.h"
#include "tests/fuzz/cut_keeps.h"

const char *const fuzz_words[] = {"<GemCutStudio version=\"1000\">",
                                  "<index gear=\"80\" symmetry=\"4\"/>",
                                  "<tier angle=\"0\" name=\"T\">",
                                  "<tier angle=\"135\" depth=\"0.8\">",
                                  "<facet nx=\"0\" ny=\"1\" nz=\"-1\" index_angle=\"0\">",
                                  "<vertex x=\"1\" y=\"1\" z=\"0.5\"/>",
                                  "</facet>",
                                  "</tier>",
                                  "</GemCutStudio>",
                                  "<!DOCTYPE a [<!ENTITY b \"c\">]>",
                                  "<render refractive_index=\"1.76\"/>",
                                  "<info title=\"&#10;\"/>",
                                  "1e308",
                                  "nan",
                                  NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  return fuzz_cut(abbe_cut_gcs_parse, data, size);
}
