/* cut_keeps.h: the promise of every reader of designs: what it accepts is sound, its stone closes
 * where it has one, and it can be written and read again. */
#ifndef ABBE_TESTS_FUZZ_CUT_KEEPS_H
#define ABBE_TESTS_FUZZ_CUT_KEEPS_H

#include "tests/fuzz/fuzz.h"

#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_stretch.h"

#include <math.h>

typedef abbe_result fuzz_cut_reader(const char *data, size_t size, const char *name, abbe_cut *out,
                                    abbe_report *report, abbe_error *error);

static inline void fuzz_cut_writes(const abbe_cut *cut) {
  char *text = NULL;
  size_t size = 0;
  abbe_cut back;
  abbe_error error = {0};
  FILE *to = open_memstream(&text, &size);
  if (to == NULL) return;
  FUZZ_PROMISE(abbe_cut_asc_write(cut, to, NULL, &error) == ABBE_OK);
  fclose(to);
  fuzz_same(text, size);
  const abbe_result result = abbe_cut_asc_parse(text, size, "back", &back, NULL, &error);
  if (result != ABBE_OK) fprintf(stderr, "%s\n%s\n", error.text, text);
  FUZZ_PROMISE(result == ABBE_OK);
  FUZZ_PROMISE(back.facet_count == cut->facet_count);
  abbe_cut_free(&back);
  free(text);
}

static inline void fuzz_cut_stone(const abbe_cut *cut) {
  abbe_cut_polyhedron p;
  abbe_cut_measures m;
  abbe_error error = {0};
  if (FUZZED(abbe_cut_polyhedron_make(cut, 0, &p, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && p.vertex == NULL);
    return;
  }
  FUZZ_PROMISE(p.vertex_count + p.face_count == p.edge_count + 2);
  FUZZ_PROMISE(isfinite(p.volume) && p.volume > 0);
  abbe_cut_measures_make(cut, &p, &m);
  FUZZ_PROMISE(m.width > 0 && m.length >= m.width && m.height > 0);
  abbe_cut_polyhedron_free(&p);
}

static inline int fuzz_cut(fuzz_cut_reader *read, const uint8_t *data, size_t size) {
  enum { STONES_OF_AT_MOST = 128 }; /* more take their time */
  abbe_cut cut;
  abbe_error error = {0};
  if (FUZZED(read((const char *)data, size, "fuzz", &cut, NULL, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && cut.facet == NULL && cut.tier == NULL);
    return 0;
  }
  FUZZ_PROMISE(abbe_cut_check(&cut, &error) == ABBE_OK);
  fuzz_cut_writes(&cut);
  if (cut.facet_count <= STONES_OF_AT_MOST) fuzz_cut_stone(&cut);
  abbe_cut_free(&cut);
  return 0;
}

#endif
