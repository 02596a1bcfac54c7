/* What a sweep's error is made of: the parts that are found, and the sentence for each case. */
#include "tests/validation/tradeoff/sweep_row.h"

#include "validation/tradeoff/error_decomposition.h"

static abbe_sweep_row *add(abbe_sweep_table *table, size_t wavelengths, size_t photons,
                           const char *fill, double total, double rest) {
  abbe_sweep_row row = sweep_row("default", photons);
  row.setting.wavelengths = wavelengths;
  snprintf(row.setting.fill, sizeof row.setting.fill, "%s", fill);
  row.number[ABBE_SWEEP_CAUSTIC_DE] = total;
  row.number[ABBE_SWEEP_CAUSTIC_DE_NOISE] = 0.1;
  row.number[ABBE_SWEEP_MATCHED_DE] = rest;
  row.number[ABBE_SWEEP_MATCHED_DE_NOISE] = 0.1;
  row.number[ABBE_SWEEP_MAP_ENERGY] = 0.9;
  OK(abbe_sweep_table_add(table, &row, &error));
  return &table->row[table->count - 1];
}

static void set_model(abbe_sweep_table *table, double de) {
  const abbe_sweep_model model = {de, 0.1, 0.3, 0.05, 0.93};
  abbe_sweep_model read;
  abbe_sweep_model_write(&model, table);
  assert_true(abbe_sweep_model_read(table, &read));
  assert_near(read.de, de, 1e-12);
  assert_near(read.de_noise, 0.1, 1e-12);
  assert_near(read.map, 0.3, 1e-12);
  assert_near(read.map_noise, 0.05, 1e-12);
  assert_near(read.energy, 0.93, 1e-12);
}

TEST(parts_and_words) {
  OWNED(abbe_sweep_table, t) = {0};
  abbe_sweep_model model;
  abbe_error_decomposition s;
  char words[2000];
  abbe_error_decomposition_make(&t, &s);
  abbe_error_decomposition_say(&s, words, sizeof words);
  assert_null(s.row);
  assert_string_equal(words, "");
  assert_false(abbe_sweep_model_read(&t, &model));
  add(&t, 7, 64, "bridge", 6, 5);
  add(&t, 7, 128, "bridge", 4, 2.6);
  add(&t, 3, 256, "bridge", 3.5, 1.02);
  add(&t, 7, 256, "none", 5, 4.5);
  add(&t, 7, 256, "bridge", 3, 1);
  set_model(&t, 2.8);
  abbe_error_decomposition_make(&t, &s);
  assert_int_equal(s.row->setting.photons, 256);
  assert_near(s.total, 3, 0);
  assert_near(s.model, 2.8, 1e-12);
  assert_near(s.rest, 1, 0);
  assert_near(s.with_fill, 1, 0);
  assert_near(s.without_fill, 4.5, 0);
  assert_near(s.fewer_photons, 2.6, 0); /* 128, and not 64 */
  assert_near(s.fewer_wavelengths, 1.02, 0);
  abbe_error_decomposition_say(&s, words, sizeof words);
  assert_contains(words, "w7 p256 m512 s1 has 3 (0.1 of it noise)");
  assert_contains(words, "most of it is the model's");
  assert_contains(words, "keeps 93.0 % of the map's light, and the setting has 90.0 %");
  assert_contains(words, "With fewer photons it was 2.6: more of them would help on");
  assert_contains(words, "With fewer wavelengths it was 1.02: more of them would not help");
  assert_contains(words, "turns 4.5 into 1");
  /* The other way round, both alike, and nothing but noise. */
  set_model(&t, 0.4);
  abbe_error_decomposition_make(&t, &s);
  abbe_error_decomposition_say(&s, words, sizeof words);
  assert_contains(words, "most of it is sampling and reconstruction");
  set_model(&t, 1.1);
  abbe_error_decomposition_make(&t, &s);
  abbe_error_decomposition_say(&s, words, sizeof words);
  assert_contains(words, "the model has about as much of it");
  set_model(&t, 0.1);
  t.row[4].number[ABBE_SWEEP_MATCHED_DE] = 0.1;
  abbe_error_decomposition_make(&t, &s);
  abbe_error_decomposition_say(&s, words, sizeof words);
  assert_contains(words, "Both are noise");
  /* Never past the end. */
  memset(words, 'x', sizeof words);
  abbe_error_decomposition_say(&s, words, 20);
  assert_int_equal(strlen(words), 19);
  assert_int_equal(words[20], 'x');
}
