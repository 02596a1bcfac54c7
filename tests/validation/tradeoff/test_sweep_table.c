/* Sweeps as tables: every bit written is read again, broken ones are named, fronts are marked. */
#include "tests/validation/tradeoff/sweep_row.h"

#include "tests/random.h"
#include "validation/tradeoff/sweep_table.h"

#include <unistd.h>

static abbe_sweep_row row_of(const char *profile, size_t wavelengths, double ms, double error) {
  abbe_sweep_row row = sweep_row(profile, 128);
  row.setting.wavelengths = wavelengths;
  row.setting.samples = 2;
  row.number[ABBE_SWEEP_FRAME_MS] = ms;
  row.number[ABBE_SWEEP_CAUSTIC_DE] = error;
  return row;
}

static void add(abbe_sweep_table *table, abbe_sweep_row row) {
  OK(abbe_sweep_table_add(table, &row, &error));
}

TEST(what_is_saved_is_loaded) {
  char path[] = "/tmp/abbe-test-sweep-XXXXXX";
  OWNED(abbe_sweep_table, table) = {0};
  OWNED(abbe_sweep_table, read) = {0};
  uint64_t random = 3;
  int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  abbe_sweep_table_set(&table, ABBE_SWEEP_FACT_SCENE, "scenes/gem.yaml");
  abbe_sweep_table_set(&table, ABBE_SWEEP_FACT_DEVICE,
                       "osmesa: llvmpipe,\nwith a break: and so on");
  for (size_t i = 0; i < 100; i++) {
    abbe_sweep_row row = row_of(i % 3 == 0 ? "thesis" : "default", i + 1, 1, 1);
    for (int k = 0; k < ABBE_SWEEP_NUMBER_COUNT; k++)
      row.number[k] = i % 7 == 0 && k > 3 ? NAN : exp(random_between(&random, -20, 20));
    row.setting.share = random_between(&random, 1e-6, 1);
    row.front = i % 5 == 0;
    add(&table, row);
  }
  OK(abbe_sweep_table_save(&table, path, &error));
  OK(abbe_sweep_table_load(path, &read, &error));
  unlink(path);
  assert_int_equal(read.count, 100);
  for (int i = 0; i < ABBE_SWEEP_FACT_COUNT; i++) assert_string_equal(read.fact[i], table.fact[i]);
  assert_string_equal(read.fact[ABBE_SWEEP_FACT_DEVICE],
                      "osmesa: llvmpipe, with a break: and so on");
  for (size_t i = 0; i < 100; i++) {
    const abbe_sweep_row *a = &table.row[i], *b = &read.row[i];
    assert_true(abbe_sweep_setting_same(&a->setting, &b->setting));
    assert_int_equal(a->front, b->front);
    for (int k = 0; k < ABBE_SWEEP_NUMBER_COUNT; k++)
      assert_true(a->number[k] == b->number[k] || (isnan(a->number[k]) && isnan(b->number[k])));
  }
}

TEST(frames_before_are_apart) {
  OWNED(abbe_sweep_table, table) = {0};
  char text[64];
  add(&table, row_of("default", 7, 10, 5));
  abbe_sweep_row row = row_of("default", 7, 5, 2);
  row.setting.history = 4;
  add(&table, row);
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "w7 p128 m512 s2 h4");
  OK(abbe_sweep_table_mark(&table, ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_CAUSTIC_DE, NULL, &error));
  assert_true(table.row[0].front && !table.row[1].front);
}

TEST(settings_are_told_apart) {
  OWNED(abbe_sweep_table, table) = {0};
  abbe_sweep_row row = row_of("default", 7, 10, 1);
  char text[160];
  add(&table, row);
  assert_ptr_equal(abbe_sweep_table_find(&table, &row.setting), &table.row[0]);
  REFUSED(ABBE_INVALID_ARGUMENT, "w7 p128 m512 s2", abbe_sweep_table_add(&table, &row, &error));
  size_t *const counts[] = {&row.setting.wavelengths, &row.setting.photons,  &row.setting.map,
                            &row.setting.samples,     &row.setting.upsample, &row.setting.exits,
                            &row.setting.passes,      &row.setting.history};
  for (int i = 0; i < 8; i++) {
    ++*counts[i];
    assert_null(abbe_sweep_table_find(&table, &row.setting));
    --*counts[i];
  }
  snprintf(row.setting.polygons, sizeof row.setting.polygons, "even+culled");
  assert_null(abbe_sweep_table_find(&table, &row.setting));
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "w7 p128 m512 s2 even+culled");
  *row.setting.polygons = '\0';
  snprintf(row.setting.direction, sizeof row.setting.direction, "own");
  assert_null(abbe_sweep_table_find(&table, &row.setting));
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "w7 p128 m512 s2 own");
  *row.setting.direction = '\0';
  row.setting.share = 0.02;
  assert_null(abbe_sweep_table_find(&table, &row.setting));
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "w7 p128 m512 s2 share 0.02");
  row.setting.samples = 1;
  row.setting.upsample = 3;
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "w7 p128 m512 s1/3 share 0.02");
  row.setting.samples = 2;
  row.setting.upsample = 1;
  row.setting.share = 0.01;
  row.setting.exits = 1;
  snprintf(row.setting.fill, sizeof row.setting.fill, "none");
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "w7 p128 m512 s2 no fill e1");
  snprintf(row.setting.model, sizeof row.setting.model, "layers");
  assert_null(abbe_sweep_table_find(&table, &row.setting));
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "w7 p128 m512 s2 no fill e1 layers");
  snprintf(row.setting.profile, sizeof row.setting.profile, "thesis");
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "thesis w7 p128 m512 s2 no fill");
  assert_false(abbe_sweep_setting_is_traced(&row.setting));
  snprintf(row.setting.profile, sizeof row.setting.profile, ABBE_SWEEP_TRACE_FILTER);
  row.setting.passes = 4;
  assert_true(abbe_sweep_setting_is_traced(&row.setting));
  abbe_sweep_setting_label(&row.setting, text, sizeof text);
  assert_string_equal(text, "trace-filter 4 x p128");
}

TEST(the_front_of_all_and_of_a_profile) {
  OWNED(abbe_sweep_table, table) = {0};
  add(&table, row_of("default", 3, 10, 5));
  add(&table, row_of("default", 7, 20, 2));
  add(&table, row_of("default", 21, 40, NAN));
  add(&table, row_of("thesis", 7, 30, 8));
  add(&table, row_of("thesis", 21, 50, 7));
  OK(abbe_sweep_table_mark(&table, ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_CAUSTIC_DE, NULL, &error));
  static const bool all[] = {true, true, false, false, false};
  for (int i = 0; i < 5; i++) assert_int_equal(table.row[i].front, all[i]);
  OK(abbe_sweep_table_mark(&table, ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_CAUSTIC_DE, "thesis", &error));
  static const bool thesis[] = {false, false, false, true, true};
  for (int i = 0; i < 5; i++) assert_int_equal(table.row[i].front, thesis[i]);
}

/* The front of another time is another one, and settings without that time are not on it. */
TEST(the_front_of_a_process) {
  OWNED(abbe_sweep_table, table) = {0};
  size_t count, *order;
  add(&table, row_of("default", 3, 10, 5));
  add(&table, row_of("default", 7, 20, 4));
  add(&table, row_of("trace", 0, 400, 3));
  add(&table, row_of("trace", 1, 300, 2));
  static const double warm_ms[] = {900, NAN, 600, 500};
  for (int i = 0; i < 4; i++) table.row[i].number[ABBE_SWEEP_WARM_MS] = warm_ms[i];
  OK(abbe_sweep_table_mark(&table, ABBE_SWEEP_WARM_MS, ABBE_SWEEP_CAUSTIC_DE, NULL, &error));
  order = abbe_sweep_table_front(&table, ABBE_SWEEP_WARM_MS, &count);
  assert_int_equal(count, 1);
  assert_int_equal(order[0], 3);
  free(order);
}

/* Medians of frames are 0, 10, 20, 60 and 400 % above the fastest. */
TEST(a_busy_machine_is_noticed) {
  OWNED(abbe_sweep_table, table) = {0};
  static const double over[] = {0, 4, 0.1, 0.2, 0.6};
  assert_near(abbe_sweep_table_unrest(&table), 0, 0);
  for (size_t i = 0; i < 5; i++) {
    abbe_sweep_row row = row_of("default", i + 1, 100 * (1 + over[i]), 5);
    row.number[ABBE_SWEEP_FASTEST_MS] = 100;
    add(&table, row);
  }
  assert_near(abbe_sweep_table_unrest(&table), 0.6, 1e-12); /* of those that vary at all */
}

/* The saved text of a table of one row, for breaking. */
static char *text_of_one_row(void) {
  char path[] = "/tmp/abbe-test-sweep-XXXXXX", *text = calloc(1, 8192);
  OWNED(abbe_sweep_table, table) = {0};
  close(mkstemp(path));
  abbe_sweep_table_set(&table, ABBE_SWEEP_FACT_SCENE, "a.yaml");
  add(&table, row_of("default", 7, 10, 5));
  OK(abbe_sweep_table_save(&table, path, &error));
  FILE *file = fopen(path, "rb");
  assert_true(fread(text, 1, 8191, file) > 0);
  fclose(file);
  unlink(path);
  return text;
}

static void refuse(const char *text, size_t size, const char *part) {
  abbe_sweep_table read = {0};
  REFUSED(ABBE_PARSE, part, abbe_sweep_table_parse(text, size, "s.csv", &read, &error));
  assert_null(read.row);
}

TEST(broken_tables_are_named) {
  static const struct {
    const char *from, *to, *part;
  } broken[] = {
      {"default,7,", "default,7.5,", "s.csv:3: wavelengths '7.5' is not a whole number"},
      {"default,7,", "default,-7,", "is not a whole number"},
      {"default,7,", ",7,", "s.csv:3: profile '' is not a word"},
      {"default,7,", "a-profile-of-a-long-name,7,", "is not a word of 1 to 15 letters"},
      {"auto,1,0,1,,,10,", "auto,1,0,1,,,ten,", "s.csv:3: frame_ms 'ten' is not a number"},
      {"auto,1,0,1,,,10,", "auto,1,0,1,,,1e999,", "is not a number"},
      {"auto,1,0,1,,,10,", "auto,1,0,1,even+corners+culled+in-light+round,,10,",
       "is not a word of 0 to 31 letters"},
      {"0.01,auto,1,0,1,,,10,", "0,auto,1,0,1,,,10,", "is not a share above 0"},
      {"auto,1,0,1,,,10,", "auto,1,0,1,,,10,,", "the row has 60 cells, not 59"},
      {"frame_ms", "frame_s", "column 15 is 'frame_s' where a sweep has 'frame_ms'"},
      {"front\n", "front,more\n", "where a sweep has ''"},
  };
  FREED char *text = text_of_one_row();
  char changed[8300];
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    const char *at = strstr(text, broken[i].from);
    assert_non_null(at);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, broken[i].to,
             at + strlen(broken[i].from));
    refuse(changed, strlen(changed), broken[i].part);
  }
  const char *row = strchr(strchr(text, '\n') + 1, '\n') + 1;
  snprintf(changed, sizeof changed, "%s%s", text, row);
  refuse(changed, strlen(changed), "s.csv:4: the setting");
  refuse(text, strlen(text) + 1, "a zero byte");
  refuse("", 0, "no line of column names");
  refuse("# scene: a\n", 11, "no line of column names");
  /* Cut anywhere it is refused, or is a table with no row and no half of one. */
  for (size_t size = 0; size < strlen(text) - 1; size++) {
    OWNED(abbe_sweep_table, read) = {0};
    if (abbe_sweep_table_parse(text, size, "s.csv", &read, NULL) == ABBE_OK)
      assert_true(read.count == 0 || size + 1 >= strlen(text) - 1);
  }
}

TEST(tables_of_different_things_do_not_agree) {
  abbe_sweep_table a = {0}, b = {0};
  abbe_sweep_table_set(&a, ABBE_SWEEP_FACT_MACHINE, "one processor");
  abbe_sweep_table_set(&b, ABBE_SWEEP_FACT_MACHINE, "one processor");
  abbe_sweep_table_set(&a, ABBE_SWEEP_FACT_DATE, "yesterday");
  OK(abbe_sweep_table_agree(&a, "s.csv", &b, &error));
  abbe_sweep_table_set(&b, ABBE_SWEEP_FACT_MACHINE, "another");
  REFUSED(ABBE_INVALID_ARGUMENT, "the machine 'one processor', and now it is 'another'",
          abbe_sweep_table_agree(&a, "s.csv", &b, &error));
}

TEST(parts_are_joined) {
  abbe_sweep_table part[2] = {0}, all;
  const char *const names[] = {"a.csv", "b.csv"};
  abbe_sweep_row row = {.setting = {.profile = "default", .fill = "auto", .model = "auto"}};
  for (size_t i = 0; i < 5; i++) {
    row.setting.wavelengths = i;
    row.number[ABBE_SWEEP_FRAME_MS] = (double)i;
    OK(abbe_sweep_table_add(&part[i % 2], &row, &error));
  }
  abbe_sweep_table_set(&part[0], ABBE_SWEEP_FACT_DATE, "yesterday");
  OK(abbe_sweep_table_join(part, names, 2, &all, &error));
  assert_int_equal(all.count, 5);
  assert_string_equal(all.fact[ABBE_SWEEP_FACT_DATE], "yesterday");
  for (size_t i = 0; i < 5; i++) {
    row.setting.wavelengths = i;
    const abbe_sweep_row *found = abbe_sweep_table_find(&all, &row.setting);
    assert_true(found != NULL && found->number[ABBE_SWEEP_FRAME_MS] == (double)i);
  }
  abbe_sweep_table_free(&all);
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_sweep_table_join(part, names, 0, &all, &error));
  /* a setting in both, then another machine */
  OK(abbe_sweep_table_add(&part[1], &row, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "b.csv", abbe_sweep_table_join(part, names, 2, &all, &error));
  assert_contains(last_error.text, "twice");
  abbe_sweep_table_set(&part[1], ABBE_SWEEP_FACT_MACHINE, "another");
  REFUSED(ABBE_INVALID_ARGUMENT, "the machine 'another'",
          abbe_sweep_table_join(part, names, 2, &all, &error));
  assert_true(all.count == 0 && all.row == NULL);
  abbe_sweep_table_free(&part[0]);
  abbe_sweep_table_free(&part[1]);
}

TEST(names) {
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) {
    abbe_sweep_number number = (abbe_sweep_number)i;
    assert_int_equal(abbe_sweep_number_find(abbe_sweep_number_name(number)), i);
    if (!abbe_sweep_number_is_error(number)) continue;
    char noise[64];
    snprintf(noise, sizeof noise, "%s_noise", abbe_sweep_number_name(number));
    assert_int_equal(abbe_sweep_number_find(noise), i + 1);
  }
  assert_true(abbe_sweep_number_is_error(ABBE_SWEEP_CAUSTIC_DE));
  assert_false(abbe_sweep_number_is_error(ABBE_SWEEP_FRAME_MS));
  assert_int_equal(abbe_sweep_number_find("beauty"), ABBE_SWEEP_NUMBER_COUNT);
}
