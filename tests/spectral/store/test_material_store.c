#include "tests/random.h"
#include "tests/spectral/random_material.h"
#include "tests/spectral/same_material.h"

#include "base/file.h"
#include "spectral/formats/material_import.h"
#include "spectral/store/material_store.h"

#include <sqlite3.h>
#include <unistd.h>

static char folder[64], path[128];

static void setup(void) {
  snprintf(folder, sizeof folder, "/tmp/abbe-test-store-XXXXXX");
  assert_non_null(mkdtemp(folder));
  /* as awkward as a path of a store may be */
  snprintf(path, sizeof path, "%s/50%% of #1? \xc3\xa4.sqlite", folder);
}

static void teardown(void) {
  unlink(path);
  assert_false(rmdir(folder));
}

static void write_store(const abbe_material_table *table) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  OK(abbe_material_store_write(table, file, &error));
  assert_int_equal(fclose(file), 0);
}

/* In place: a file that is made anew each time is synced by some file systems. */
static void write_bytes(const char *bytes, size_t size) {
  FILE *file = fopen(path, "r+b");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fflush(file), 0);
  assert_int_equal(ftruncate(fileno(file), (off_t)size), 0);
  assert_int_equal(fclose(file), 0);
}

static abbe_material_table read_all(void) {
  abbe_material_table table;
  OK(abbe_material_table_load(path, &table, &error));
  return table;
}

static abbe_material_table table_of(const char *records) {
  abbe_material_table table;
  const char *text = printed("description: three\nmaterials:\n%s", records);
  OK(abbe_material_table_parse(text, strlen(text), "t", &table, &error));
  return table;
}

#define A                                                                                          \
  "- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [400, 800], source: s}\n"
#define B "- {name: B, model: tabulated, points: [[400, 1.5], [500, 1.4], [600, 1.3]], source: s}\n"
#define C "- {name: c, model: constant, coefficients: [1.6], source: s}\n"

static void write_three(void) {
  OWNED(abbe_material_table, table) = table_of(A B C);
  write_store(&table);
}

/* Asks the file as an outside program does. */
static void run_sql(const char *sql) {
  sqlite3 *db = NULL;
  char *why = NULL;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  sqlite3_exec(db, "PRAGMA synchronous = OFF", NULL, NULL, NULL);
  if (sqlite3_exec(db, sql, NULL, NULL, &why) != SQLITE_OK) fail_msg("%s: %s", sql, why);
  assert_int_equal(sqlite3_close(db), SQLITE_OK);
}

static void refuses(abbe_result code, const char *part) {
  abbe_material_table table;
  abbe_error error = {0};
  abbe_result result = abbe_material_store_read(path, NULL, 0, NULL, &table, &error);
  if (result != code || strstr(error.text, part) == NULL || strstr(error.text, path) == NULL)
    fail_msg("%d, '%s'; '%s' is expected", (int)result, error.text, part);
}

/* ---- round trips ---- */

GROUP(setup, teardown);

TEST(every_record_comes_back_the_same) {
  srand(21);
  OWNED(abbe_material_table, table) = {0};
  for (size_t i = 0; i < 300; i++) {
    abbe_material m = random_material(i);
    OK(abbe_material_table_append(&table, &m, &error));
  }
  table.description = strdup("it's \"all\"");
  write_store(&table);
  assert_true(abbe_material_store_is(path));
  OWNED(abbe_material_table, back) = read_all();
  assert_int_equal(back.count, table.count);
  assert_string_equal(back.description, table.description);
  assert_string_equal(back.path, path);
  for (size_t i = 0; i < back.count; i++) {
    assert_same_record(&table.material[i], &back.material[i]);
    assert_int_equal(back.material[i].line, i + 1);
  }
}

TEST(the_shipped_table_comes_back_the_same) {
  MADE(abbe_material_table, table, abbe_material_table_load(NULL, &table, &error));
  write_store(&table);
  OWNED(abbe_material_table, back) = read_all();
  assert_int_equal(back.count, table.count);
  for (size_t i = 0; i < back.count; i++) assert_same_record(&table.material[i], &back.material[i]);
}

/* ---- rows by name ---- */

/* A row that is asked for is read, however broken the others are. */
TEST(one_name_reads_one_row) {
  write_three();
  run_sql("UPDATE materials SET points = x'00' WHERE name = 'B'");
  const char *const names[] = {"C", "c", "A", "nobody"};
  const abbe_material *m = NULL;
  MADE(abbe_material_table, table, abbe_material_table_load_named(path, names, 4, &table, &error));
  assert_int_equal(table.count, 2);
  OK(abbe_material_table_find(&table, "A", &m, &error));
  assert_int_equal(m->line, 1);
  OK(abbe_material_table_find(&table, "c", &m, &error));
  assert_near(m->dispersion.c[0], 1.6, 0);
  /* of what it does not have it names the nearest, among all */
  assert_int_equal(abbe_material_table_find(&table, "nobody", &m, NULL), ABBE_NOT_FOUND);
  REFUSED(ABBE_NOT_FOUND, "did you mean 'B'?", abbe_material_table_find(&table, "bb", &m, &error));
  refuses(ABBE_SCHEMA, "row 2 ('B') cannot be used: 'points' is not whole");
}

/* Which is what YAML and the shipped tables do with all of theirs. */
TEST(other_tables_are_asked_in_the_same_words) {
  const char *const name = "diamond";
  const abbe_material *m = NULL;
  MADE(abbe_material_table, table, abbe_material_table_load_named(NULL, &name, 1, &table, &error));
  OK(abbe_material_table_find(&table, "sapphire", &m, &error));
}

/* ---- files of strangers ---- */

TEST(what_is_wrong_with_a_row_is_told) {
  const struct {
    const char *set, *part;
  } rows[] = {
      {"name = ''", "row 2 ('') cannot be used: '' is not a name"},
      {"name = x'61'", "'name' is no text"},
      {"name = cast(x'61ff' as text)", "'name' is no whole text"},
      {"model = 'cachy'", "'model' is not known"},
      {"interpolation = 'step'", "'interpolation' is not known"},
      {"points = NULL", "cannot be used"},
      {"points = x'0000000000000000'", "'points' is not whole"},
      {"points = zeroblob(32)", "'points' holds a number out of its range"},
      {"points = zeroblob(1600000)", "'points' has too many points"},
      {"points = 'text'", "'points' is no list of numbers"},
      {"points = (SELECT substr(points, 17) || substr(points, 1, 16) FROM materials WHERE id = 2)",
       "'points' is no list of numbers"}, /* || makes text */
      {"from_nm = -1", "'from_nm' is out of its range"},
      {"from_nm = 'x'", "'from_nm' is no number"},
      {"to_nm = 9e999", "'to_nm' is out of its range"},
      {"to_nm = 300", "does not ascend"},
      {"source = NULL", "names no source"},
      {"temperature_c = -300", "'temperature_c' is out of its range"},
      {"attenuation_per_m = zeroblob(16)", "'attenuation_per_m' holds a number out of its range"},
      {"thermal = zeroblob(8)", "'thermal' has another length"},
      {"ratings = zeroblob(56)", "'ratings' has another length"},
      {"cauchy2 = zeroblob(40)", "'cauchy2' has no range"},
      {"cauchy3 = zeroblob(40)", "'cauchy3' has another length"},
      {"coefficients = zeroblob(8)", "cannot be used"},
      {"model = 'sellmeier', coefficients = zeroblob(800)", "'coefficients' has another length"},
      {"source = zeroblob(5000000)", "too big"}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    write_three();
    run_sql(printed("UPDATE materials SET %s WHERE id = 2", rows[i].set));
    abbe_material_table table;
    abbe_error error = {0};
    abbe_result result = abbe_material_table_load(path, &table, &error);
    if (result == ABBE_OK || strstr(error.text, rows[i].part) == NULL)
      fail_msg("%s: '%s', not '%s'", rows[i].set, error.text, rows[i].part);
  }
}

/* A formula without an index is seen where the row is used, and by the check. */
TEST(a_row_that_is_used_has_an_index) {
  write_three();
  run_sql("UPDATE materials SET coefficients = x'000000000000f0bf000000000000f0bf' WHERE id = 1");
  const char *const names[] = {"a", "c"};
  OWNED(abbe_material_table, table) = read_all();
  assert_int_equal(table.count, 3);
  abbe_material_table_free(&table);
  REFUSED(ABBE_SCHEMA, "row 1 ('a') cannot be used: a: its cauchy formula has no real index",
          abbe_material_table_load_named(path, names, 2, &table, &error));
  OK(abbe_material_table_load_named(path, names + 1, 1, &table, &error));
}

/* The check's reading leaves such a row out, and says so. */
TEST(a_bad_row_is_noted_and_left_out) {
  write_three();
  run_sql("UPDATE materials SET model = 'cachy' WHERE id = 2");
  OWNED(abbe_report, unread) = {0};
  MADE(abbe_material_table, table, abbe_material_table_load_lenient(path, &table, &unread, &error));
  assert_int_equal(table.count, 2);
  assert_int_equal(unread.count, 1);
  assert_int_equal(unread.note[0].line, 2);
  assert_string_equal(unread.note[0].name, "B");
}

TEST(other_databases_are_no_stores) {
  const char *const alien[] = {
      "CREATE TABLE materials(id INTEGER PRIMARY KEY, name TEXT)",
      "PRAGMA application_id = 1096966757; PRAGMA user_version = 1; CREATE TABLE materials(name)",
      /* a query that never ends, under our table's name */
      "PRAGMA application_id = 1096966757; PRAGMA user_version = 1; CREATE VIEW materials AS WITH "
      "RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT x AS id FROM n"};
  for (size_t i = 0; i < sizeof alien / sizeof alien[0]; i++) {
    unlink(path);
    run_sql(alien[i]);
    refuses(ABBE_PARSE, "is an SQLite file, and no store of this version of Abbe");
  }
  write_three();
  run_sql("PRAGMA user_version = 1"); /* without extraordinary indices */
  refuses(ABBE_PARSE, "no store of this version");
  write_bytes("SQLite format 3", 16);
  assert_true(abbe_material_store_is(path));
  refuses(ABBE_PARSE, "the store is damaged");
  write_bytes("materials:\n", 11);
  assert_false(abbe_material_store_is(path));
  assert_false(abbe_material_store_is(folder));
  assert_false(abbe_material_store_is("/nowhere"));
  abbe_material_table table;
  assert_int_equal(abbe_material_store_read("/nowhere", NULL, 0, NULL, &table, NULL), ABBE_IO);
}

/* Whatever a disk or a stranger does to the bytes: a table, or a sentence. */
TEST(changed_bytes_are_survived) {
  write_three();
  FREED char *bytes = NULL;
  size_t size = 0, read = 0, refused = 0;
  OK(abbe_file_read(path, 1 << 24, &bytes, &size, &error));
  FREED char *changed = malloc(size);
  uint64_t random = 3;
  for (int i = 0; i < 1500; i++) {
    memcpy(changed, bytes, size);
    size_t length = i % 10 == 0 ? random_bits(&random) % size : size;
    for (uint64_t k = 1 + random_bits(&random) % 6; k > 0; k--)
      changed[random_bits(&random) % (i % 3 == 0 ? 200 : size)] = (char)random_bits(&random);
    write_bytes(changed, length);
    OWNED(abbe_material_table, table);
    abbe_error why = {0};
    abbe_result result = abbe_material_store_read(path, NULL, 0, NULL, &table, &why);
    if (result != ABBE_OK) assert_true(why.text[0] != '\0' && table.material == NULL);
    read += result == ABBE_OK;
    refused += result != ABBE_OK;
    for (size_t k = 0; k < table.count; k++)
      OK(abbe_material_check_form(&table.material[k], &error));
    abbe_material_table_free(&table);
    const char *const names[] = {"a", "b", "c"};
    result = abbe_material_store_read(path, names, 3, NULL, &table, &why);
    for (size_t k = 0; k < table.count; k++) OK(abbe_material_check(&table.material[k], &error));
  }
  assert_true(read > 100 && refused > 100);
}

/* ---- writing ---- */

TEST(what_cannot_be_stored_is_refused) {
  OWNED(abbe_material_table, table) = table_of(A B C);
  FILE *full = fopen("/dev/full", "w");
  REFUSED(ABBE_IO, "", abbe_material_store_write(&table, full, &error));
  fclose(full);
  FILE *to = tmpfile();
  strcpy(table.material[2].name, "A");
  REFUSED(ABBE_INVALID_ARGUMENT, "the name 'A' stands twice",
          abbe_material_store_write(&table, to, &error));
  table.material[0].max_nm = 1;
  REFUSED(ABBE_INVALID_ARGUMENT, "does not ascend", abbe_material_store_write(&table, to, &error));
  assert_int_equal(ftell(to), 0);
  fclose(to);
  assert_true(abbe_material_store_is_name("a/b.SQLite"));
  assert_false(abbe_material_store_is_name("a.sqlite/b"));
  assert_false(abbe_material_store_is_name("sqlite"));
}
