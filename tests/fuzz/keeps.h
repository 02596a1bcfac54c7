/* keeps.h: the promise of every importer: what it accepts can be written and read again. */
#ifndef ABBE_TESTS_FUZZ_KEEPS_H
#define ABBE_TESTS_FUZZ_KEEPS_H

#include "tests/fuzz/fuzz.h"

#include "spectral/formats/material_write.h"

#include <math.h>
#include <string.h>

static inline void fuzz_write_rest(const abbe_material_table *table, FILE *to) {
  abbe_error error;
  FUZZ_PROMISE(abbe_agf_write(table, to, NULL, &error) == ABBE_OK);
  if (table->count == 0) return;
  FUZZ_PROMISE(abbe_rii_write(&table->material[0], to, NULL, &error) == ABBE_OK);
  abbe_csv_write(&table->material[0], NULL, to, NULL, &error);
}

static inline void fuzz_keeps(const abbe_material_table *table) {
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  abbe_error error = {0};
  if (to == NULL) return;
  for (size_t i = 0; i < table->count; i++)
    FUZZ_PROMISE(abbe_material_check(&table->material[i], &error) == ABBE_OK);
  FUZZ_PROMISE(abbe_material_table_write(table, to, &error) == ABBE_OK);
  fflush(to);
  fuzz_same(text, size);
  abbe_material_table back;
  abbe_result result = abbe_material_table_parse(text, size, "back", &back, &error);
  if (result != ABBE_OK) fprintf(stderr, "%s\n%s\n", error.text, text);
  FUZZ_PROMISE(result == ABBE_OK && back.count == table->count);
  for (size_t i = 0; i < back.count; i++) {
    const abbe_material *a = &table->material[i], *b = &back.material[i];
    FUZZ_PROMISE(strcmp(a->name, b->name) == 0 && strcmp(a->source, b->source) == 0);
    double n = abbe_dispersion_n(&a->dispersion, 550), m = abbe_dispersion_n(&b->dispersion, 550);
    FUZZ_PROMISE((isnan(n) && isnan(m)) || n == m);
  }
  if (size % 8 == 0) fuzz_write_rest(table, to); /* a share of them: it takes its time */
  fclose(to);
  free(text);
  abbe_material_table_free(&back);
}

#endif
