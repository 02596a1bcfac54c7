/* COATING.DAT: a coating by waves and one by lengths. */
#include "tests/fuzz/memory_file.h"

#include "scenes/coating/coating.h"

#include <math.h>

const char *const fuzz_words[] = {
    "\nMATE MGF2\n",
    "\nCOAT AR\n",
    "\nCOAT THICK\n",
    "MGF2 0.25\n",
    "MGF2 .1 1\n",
    "narrow 0.25\n",
    "0.5 1.5 -2\n",
    "\nTAPR A\n",
    "\nTABLE AR\n",
    "ANGL 30\n",
    "WAVE .5 .1 .1 .9 .9\n",
    "OPTIS - Coated surface file v1.0\n\n2 1\n500\n0 4 96 4 96\n90 100 0 100 0\n",
    "IDEAL AR 1 0",
    "!",
    "\r\n",
    "1e300",
    NULL};

static const char glass[] = "materials:\n"
                            "- {name: narrow, model: cauchy, coefficients: [1.5, 0.006],\n"
                            "   range_nm: [400, 500], source: made up}\n";

/* What is read is a film: no light is made, and its layers are within their limits. */
static void check(const abbe_coating *coating) {
  FUZZ_PROMISE(coating->count > 0 && coating->count <= ABBE_FILM_MOST_LAYERS);
  for (size_t i = 0; i < coating->count; i++)
    FUZZ_PROMISE(coating->layer[i].nm >= 0 && coating->layer[i].nm <= ABBE_FILM_MOST_NM);
  for (int i = 0; i < 6; i++) {
    double reflected = NAN, passed = NAN;
    abbe_error error = {0};
    const abbe_result result =
        abbe_coating_straight(coating, 1.5, i % 2 == 0, 300 + 100 * i, &reflected, &passed, &error);
    FUZZ_PROMISE(result == ABBE_OK || error.text[0] != '\0');
    FUZZ_PROMISE(result != ABBE_OK ||
                 (reflected >= 0 && passed >= 0 && reflected + passed <= 1 + 1e-9));
  }
}

int fuzz_input(const uint8_t *data, size_t size) {
  static abbe_material_table table;
  const char *path = memory_file(data, size);
  if (table.count == 0)
    FUZZ_PROMISE(abbe_material_table_parse(glass, strlen(glass), "glass", &table, NULL) == ABBE_OK);
  for (int i = 0; i < 2; i++) {
    abbe_error error = {0};
    abbe_coatings *all = calloc(1, sizeof *all);
    if (all == NULL) return 0;
    all->count = 1;
    if (FUZZED(abbe_coating_file_read(path, i == 0 ? "AR" : "THICK", i == 0 ? 550 : 0, &table,
                                      &all->coating[0], &error),
               &error) == ABBE_OK)
      check(&all->coating[0]);
    else
      FUZZ_PROMISE(error.text[0] != '\0');
    abbe_coatings_free(all);
  }
  return 0;
}
