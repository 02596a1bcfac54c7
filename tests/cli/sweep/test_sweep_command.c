/* `abbe sweep` as people meet it: rows, going on, stopping, the report, and what it refuses. */
#include "tests/cli/run_json.h"

#include "validation/tradeoff/sweep_table.h"

#define SWEEP                                                                                      \
  "\"$abbe\" sweep \"$house\"/scenes/gem.yaml -q --size 24x24 --frames 1 --spp 2 "                 \
  "--traced-photons 2000 --texels 16 --map 64 --samples 1 "
#define TWO SWEEP "--profiles default --wavelengths 7 --photons 16,32 -o s.csv "

static void load(const char *name, abbe_sweep_table *table) {
  OK(abbe_sweep_table_load(run_path(name), table, &error));
}

static void run_well(const char *line) {
  int code = run_line(line);
  if (code != 0) fail_msg("%s ends with %d: %s", line, code, run_errors);
}

EACH(run_setup, run_teardown);

TEST(rows_are_measured_once) {
  abbe_sweep_table first = {0}, second = {0};
  run_well("ulimit -s 256 && " TWO);
  assert_contains(run_output, "2 settings");
  assert_contains(run_output, "w7 p"); /* which is on the front is the clock's affair */
  load("s.csv", &first);
  assert_int_equal(first.count, 2);
  assert_string_equal(first.fact[ABBE_SWEEP_FACT_SIZE], "24x24");
  assert_string_equal(first.fact[ABBE_SWEEP_FACT_REFERENCE], "s-reference.exr");
  for (int k = 0; k < 2; k++) {
    assert_true(first.row[k].number[ABBE_SWEEP_FRAME_MS] > 0);
    assert_true(first.row[k].number[ABBE_SWEEP_CAUSTIC_DE] > 0);
    assert_true(first.row[k].number[ABBE_SWEEP_MAP_RMSE_NOISE] > 0);
  }
  /* More photons: the two rows stay as they are to the bit, times included, and one comes. */
  run_well(SWEEP "--profiles default --wavelengths 7 --photons 16,32,48 -o s.csv --plot s.png "
                 "--report s.md");
  load("s.csv", &second);
  assert_int_equal(second.count, 3);
  for (int k = 0; k < 2; k++)
    assert_memory_equal(second.row[k].number, first.row[k].number, sizeof first.row[k].number);
  abbe_sweep_table_free(&first);
  abbe_sweep_table_free(&second);
  run_well("test -s s.png && cat s.md && rm s.png s.md s-gem-*.png");
  assert_contains(run_output, "## gem.yaml");
  assert_contains(run_output, "![reference](s-gem-reference.png)");
  assert_contains(run_output, "s-gem-accurate.png");
  run_well("rm s.csv s-reference.exr s-reference-map.exr");
  assert_int_equal(run_left(), 0);
}

TEST(the_thesis_beside_it) {
  cJSON *json = run_json(
      SWEEP "--profiles default,thesis,thesis-cie --wavelengths 7 --photons 32 --fill none "
            "-o s.csv --json",
      0);
  const cJSON *rows = cJSON_GetObjectItemCaseSensitive(json, "rows"), *row;
  assert_int_equal(cJSON_GetArraySize(rows), 3);
  row = cJSON_GetArrayItem(rows, 1);
  assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(row, "profile")),
                      "thesis");
  /* It knows no units, so it got its best factor; the default profile does and got none. */
  assert_true(json_number(row, "scale") != 1);
  assert_true(cJSON_IsNull(cJSON_GetObjectItemCaseSensitive(row, "baseline_ms")));
  row = cJSON_GetArrayItem(rows, 0);
  assert_near(json_number(row, "scale"), 1, 0);
  cJSON_Delete(json);
  /* Tables are shown again, with another error, and reported together. */
  run_well("cp s.csv t.csv && \"$abbe\" sweep s.csv t.csv --error map_rmse --report both.md");
  assert_contains(run_output, "the Pareto front of frame_ms and map_rmse");
  run_well("grep -c '^## gem' both.md && rm both*");
  assert_contains(run_output, "2");
  run_well("\"$abbe\" sweep s.csv --plot s.svg --json && rm s.svg s.csv t.csv s-reference*.exr");
  assert_int_equal(run_left(), 0);
}

/* Full and matched physics: what the model leaves out is a fact of the table, and said. */
TEST(the_error_is_decomposed) {
  /* The references alone first: the sweep takes them as they are. */
  run_well(SWEEP "-o s.csv --decompose --trace-only && ! test -e s.csv && sha1sum s-*.exr >sums");
  run_well(SWEEP "--profiles default --wavelengths 7 --photons 16 -o s.csv --decompose");
  run_well("sha1sum -c --quiet sums && rm sums");
  run_well(SWEEP "--profiles default --wavelengths 7 --photons 16 -o s.csv --decompose");
  assert_contains(run_output, "What is left: w7 p16 m64 s1 share 0.005 has ");
  run_well("grep -c '^# model: caustic_de ' s.csv && ls s-matched.exr s-matched-map.exr");
  /* Rows of another decomposition are not mixed. */
  assert_int_equal(run_line(SWEEP "--profiles default --wavelengths 7 --photons 16,32 -o s.csv"),
                   1);
  assert_contains(run_errors, "its rows were measured with the model 'caustic_de");
  cJSON *json = run_json(
      SWEEP "--profiles default --wavelengths 7 --photons 16,32 -o s.csv --decompose --json", 0);
  const cJSON *parts_of = cJSON_GetObjectItemCaseSensitive(json, "decomposition");
  static const char *const parts[] = {"total", "model", "sampling_and_reconstruction"};
  for (int i = 0; i < 3; i++) assert_true(json_number(parts_of, parts[i]) > 0);
  cJSON_Delete(json);
  run_well("rm s.csv s-reference*.exr s-matched*.exr");
  assert_true(run_refuses("\"$abbe\" sweep a.yaml -o s.csv --decompose --physics matched", 2,
                          "--decompose traces full and matched physics"));
}

TEST(given_references) {
  run_well("\"$abbe\" render \"$house\"/scenes/gem.yaml -q --size 24x24 --photons 32 --map 64 "
           "--aovs -o r.exr --save-map m.exr");
  cJSON *json =
      run_json("\"$abbe\" sweep \"$house\"/scenes/gem.yaml -q --frames 1 --reference r.exr "
               "--reference-map m.exr --profiles default --photons 32 --map 64 -o s.csv --json",
               0);
  const cJSON *row = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, "rows"), 0);
  static const char *const none[] = {"map_rmse", "picture_de", "caustic_rmse"};
  for (int i = 0; i < 3; i++) assert_near(json_number(row, none[i]), 0, 1e-6);
  cJSON_Delete(json);
  run_well("rm r.exr m.exr s.csv");
  assert_int_equal(run_left(), 0);
}

/* Each process has every other setting; all tables together are the whole. */
TEST(parts_are_joined) {
  abbe_sweep_table table = {0};
#define PART(k)                                                                                    \
  "\"$abbe\" sweep \"$house\"/scenes/gem.yaml -q --frames 1 --reference r.exr "                    \
  "--reference-map m.exr --profiles default --photons 16,32,48 --map 64 -o p" k ".csv --part " k   \
  "/2; "
  run_well("\"$abbe\" render \"$house\"/scenes/gem.yaml -q --size 24x24 --photons 32 --map 64 "
           "--aovs -o r.exr --save-map m.exr");
  run_well(PART("0") PART("1") "\"$abbe\" sweep p0.csv p1.csv -o s.csv");
#undef PART
  assert_contains(run_output, "3 settings");
  load("p0.csv", &table);
  assert_int_equal(table.count, 2);
  abbe_sweep_table_free(&table);
  load("s.csv", &table);
  assert_int_equal(table.count, 3);
  abbe_sweep_table_free(&table);
  assert_int_equal(run_line("\"$abbe\" sweep p0.csv p0.csv -o s.csv"), 1);
  assert_contains(run_errors, "twice");
  run_well("rm r.exr m.exr p0.csv p1.csv s.csv");
  assert_true(run_refuses("\"$abbe\" sweep a.yaml -o s.csv --part 2/2", 2, "is no part"));
  assert_int_equal(run_left(), 0);
}

/* Stopped in the middle: the rows so far are kept, and the same command goes on. */
TEST(ctrl_c_keeps_what_is_done) {
  abbe_sweep_table table = {0};
  int code = run_line(
      SWEEP "--profiles default --wavelengths 7,9,11,13,15,17,19,21 --photons 64,72,80,800 "
            "-o s.csv & pid=$!; while ! test -s s.csv; do sleep 0.02; done; "
            "kill -INT $pid; wait $pid");
  assert_int_equal(code, 1);
  assert_contains(run_errors, "of 32 settings are in s.csv, and the same command goes on");
  load("s.csv", &table);
  assert_true(table.count >= 1 && table.count < 32);
  abbe_sweep_table_free(&table);
  run_well("rm s.csv s-reference*.exr");
  assert_int_equal(run_left(), 0);
}

TEST(what_is_refused) {
  static const struct {
    const char *line, *part;
    int code;
  } wrong[] = {
      {"\"$abbe\" sweep", "which scene?", 2},
      {"\"$abbe\" sweep a.yaml", "where to? Give -o FILE.csv", 2},
      {"\"$abbe\" sweep a.yaml b.yaml -o s.csv", "one scene at a time", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --grid quack", "did you mean 'quick'?", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --grid full --map 64", "one or the other", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --map 64,,8", "is not a list such as 3,7,21", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --map 64,x", "not a whole number", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --error caustic_da", "did you mean 'caustic_de'?", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --error frame_ms", "is no error", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --reference r.exr --spp 9", "and one is given", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --scaling --spp 3", "--scaling times frames", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --scaling --size 16x8", "a square --size", 2},
      {"\"$abbe\" sweep a.yaml -o s.csv --scaling", "a.yaml", 1},
      {"\"$abbe\" sweep \"$house\"/scenes/gem.yaml -q -o s.csv --scaling --size 20x20", "in eights",
       1},
      {"\"$abbe\" sweep a.yaml -o s.csv", "a.yaml", 1},
      {"\"$abbe\" sweep a.csv", "a.csv", 1},
      {"\"$abbe\" sweep \"$house\"/scenes/gem.yaml -o no/s.csv", "no/s.csv", 1},
      {"\"$abbe\" sweep \"$house\"/scenes/gem.yaml -o s.csv --reference no.exr", "no.exr", 1},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    assert_true(run_refuses(wrong[i].line, wrong[i].code, wrong[i].part));
  /* Rows of another scene are not mixed with these. */
  run_well(TWO);
  run_well("sed -i 's/^# scene hash: ./# scene hash: x/' s.csv && cp s.csv before.csv");
  assert_int_equal(run_line(TWO), 1);
  assert_contains(run_errors, "s.csv: its rows were measured with the scene hash 'x");
  run_well("cmp s.csv before.csv && echo broken >s.csv");
  assert_int_equal(run_line(TWO), 1);
  assert_contains(run_errors, "s.csv:1: column 1 is 'broken'");
  run_well("grep -q broken s.csv && rm s.csv before.csv s-reference*.exr");
  assert_int_equal(run_left(), 0);
}

/* A page and its pictures stand beside what a table is of, and are written over none of it. */
TEST(a_report_overwrites_nothing) {
  abbe_sweep_table table = {0};
  abbe_sweep_table_set(&table, ABBE_SWEEP_FACT_SCENE, "gem.yaml");
  abbe_sweep_table_set(&table, ABBE_SWEEP_FACT_REFERENCE, "s-gem-reference.png");
  for (int i = 0; i < 2; i++) {
    OK(abbe_sweep_table_save(&table, run_path(i == 0 ? "a.csv" : "b.csv"), &error));
  }
  run_well("touch gem.yaml s-gem-reference.png");
  assert_int_equal(run_line("\"$abbe\" sweep a.csv --report gem.yaml"), 2);
  assert_contains(run_errors, "--report 'gem.yaml' would be written over the table's source");
  assert_int_equal(run_line("\"$abbe\" sweep a.csv --report s.md"), 2);
  assert_contains(run_errors, "the report's picture 's-gem-reference.png' would be written");
  assert_int_equal(run_line("\"$abbe\" sweep a.yaml -o s.csv --report s-reference.exr"), 1);
  assert_int_equal(run_line("\"$abbe\" sweep \"$house\"/scenes/gem.yaml -o s.csv "
                            "--report s-reference.exr"),
                   2);
  assert_contains(run_errors, "the traced file 's-reference.exr'");
  run_well("test ! -s gem.yaml && test ! -s s-gem-reference.png && rm gem.yaml *.png");
  /* Two tables of scenes of one name: each has pictures of its own. */
  run_well("\"$abbe\" sweep a.csv b.csv --report r.md && rm a.csv b.csv r.md");
  assert_int_equal(run_left(), 0);
}
