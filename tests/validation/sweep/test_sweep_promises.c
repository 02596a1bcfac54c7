/* Promises of presets beside what a table met: by hand. */
#include "tests/validation/tradeoff/sweep_row.h"

#include "base/file.h"
#include "validation/sweep/sweep_promises.h"

#include <unistd.h>

#define POINT(photons, light, error)                                                               \
  "  - {wavelengths: 7, photons: " photons                                                         \
  ", map: 512, samples: 1, fill: bridge, exits: 8, share: 0.01,\n     light_ms: " light            \
  ", eye_ms: 10, error: " error ", least: 0.5}\n"
#define PRESETS                                                                                    \
  "error: caustic_de\nwhat: mean error\nrun: a run\nclasses:\n- class: convex\n  scenes: gem\n"    \
  "  draft: 0\n  balanced: 1\n  front:\n" POINT("32", "20", "8") POINT("64", "40", "4")            \
      POINT("128", "160", "2")

static void add(abbe_sweep_table *t, size_t photons, double light_ms, double eye_ms, double error) {
  abbe_sweep_row row = sweep_row("default", photons);
  row.number[ABBE_SWEEP_LIGHT_MS] = light_ms;
  row.number[ABBE_SWEEP_EYE_MS] = eye_ms;
  row.number[ABBE_SWEEP_FRAME_MS] = light_ms + eye_ms;
  row.number[ABBE_SWEEP_CAUSTIC_DE] = error;
  assert_int_equal(abbe_sweep_table_add(t, &row, NULL), ABBE_OK);
}

TEST(by_hand) {
  char path[] = "/tmp/abbe-test-promises-XXXXXX";
  int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  OK(abbe_file_write(path, PRESETS, strlen(PRESETS), &error));
  OWNED(abbe_sweep_table, t) = {0};
  abbe_sweep_promises p;
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_CLASS, "convex");
  add(&t, 64, 50, 30, 5);
  /* Without the cheapest point nothing tells this machine's speed. */
  OK(abbe_sweep_promises_make(&t, path, &p, &error));
  assert_null(p.front);
  abbe_sweep_promises_free(&p);
  add(&t, 32, 40, 30, 7); /* light at half the run's speed, the eye at a third */
  OK(abbe_sweep_promises_make(&t, path, &p, &error));
  assert_int_equal(p.count, 2); /* the third was not measured */
  assert_string_equal(p.promise[0].preset, "draft");
  assert_string_equal(p.promise[1].preset, "balanced");
  assert_near(p.promise[0].ms, 70, 1e-9);
  assert_near(p.promise[1].ms, 2 * 40 + 3 * 10, 1e-9);
  assert_near(p.promise[1].ms_met, 80, 0);
  assert_near(p.promise[1].error, 4, 0);
  assert_near(p.promise[1].error_met, 5, 0);
  abbe_sweep_promises_free(&p);
  /* Of a class that has no front nothing is promised. */
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_CLASS, "meshes");
  OK(abbe_sweep_promises_make(&t, path, &p, &error));
  assert_null(p.front);
  abbe_sweep_promises_free(&p);
  unlink(path);
  REFUSED(ABBE_IO, "", abbe_sweep_promises_make(&t, path, &p, &error));
}
