/* `abbe materials import` and `export`, as a person meets them. */
#include "tests/cli/run_program.h"

#define M "\"$abbe\" materials "

static void runs(const char *line, const char *said) {
  int code = run_line(line);
  if (code != 0) fail_msg("%s\nends with %d: %s", line, code, run_errors);
  if (strstr(run_errors, said) == NULL) fail_msg("'%s' is not in: %s", said, run_errors);
}

GROUP(run_setup, run_teardown);

TEST(a_table_goes_out_and_comes_back) {
  runs(M "export --to yaml -o copy.yaml", "75 materials in copy.yaml");
  runs(M "import copy.yaml -o again.yaml && cmp copy.yaml again.yaml && rm again.yaml",
       "75 materials in again.yaml");
  runs(M "export --table copy.yaml -o all.agf", "lost: AGF has no place for a warning");
  runs(M "import all.agf -o all.yaml && " M "list --table all.yaml && rm all.yaml all.agf",
       "54 materials in all.yaml");
  assert_contains(run_output, "diamond");
  assert_contains(run_output, "2.417486");
  runs(M "export sapphire --table copy.yaml -o sapphire.yml && " M "import sapphire.yml",
       "1 material");
  assert_contains(run_output, "model: sellmeier\n");
  assert_contains(run_output, "source: \"[MalitsonDodge1972] both rays\"");
  runs(M "export water --to csv --range 400:700 --step 10 >w.csv && " M
         "import w.csv --name w --source 'sampled'",
       "sampled every 10 nm from 400 to 700 nm");
  assert_contains(run_output, "name: w\n");
  assert_contains(run_output, "range_nm: [400, 700]");
  runs("rm copy.yaml sapphire.yml w.csv", "");
  assert_int_equal(run_left(), 0);
}

TEST(notes_are_numbers_for_a_program) {
  runs("printf 'NM A 99\\nNM B 2 0 1.5 60\\nCD 1 0.01\\nLD 0.3 2\\n' >c.agf; " M
       "import c.agf -o c.yaml --json && rm c.agf c.yaml",
       "");
  assert_contains(run_output, "\"materials\":\t1");
  assert_contains(run_output, "\"skipped\":\t1");
  assert_contains(run_output, "\"name\":\t\"A\"");
  assert_int_equal(run_left(), 0);
}

/* A folder in one command, into a store that every verb reads. */
TEST(a_folder_becomes_a_store) {
  runs("mkdir -p d/one/nk d/two/nk; for m in one two; do for f in Ann Zoe; do printf 'REFERENCES: "
       "r\\nCOMMENTS: 20 C\\nDATA:\\n- {type: formula 5, wavelength_range: 0.3 0.9, coefficients: "
       "1.5 0.004 -2}\\n' >d/$m/nk/$f.yml; done; done; cp \"$house/docs/examples/maker.agf\" d; cp "
       "d/maker.agf d/two; echo DATA: >d/bad.yml; " M "import d -o all.sqlite; rm -r d",
       "14 materials in all.sqlite");
  assert_contains(run_errors, "skipped: d/bad.yml");
  assert_contains(run_errors, "N-BK7: line 2: is named d-N-BK7, since several files have a "
                              "material of this name; it is of d/maker.agf");
#define T " --table all.sqlite"
  runs(M "list --name '*zoe*' --columns name,n_d" T, "");
  assert_string_equal(run_output, "name          n_d\none-Zoe  1.511587\ntwo-Zoe  1.511587\n");
  runs(M "show two-n-bk7 --at 587.5618" T, "");
  assert_contains(run_output, "1.516800");
  runs(M "plot one-Ann two-SF10 -o p.svg" T " && " M "plot --map -o m.svg" T " && rm ?.svg", "");
  runs(M "nearest --nd 1.62 --vd 36.4 --count 1" T, "");
  assert_contains(run_output, "d-F2");
  runs(M "nearest --like one-Ann --like-table all.sqlite --count 1", "");
  runs(M "fit d-F2 --terms 3" T, "");
  assert_int_equal(run_line(M "check" T), 3);
  assert_contains(run_output, "all.sqlite: 14 rows, 2 wrong, 2 doubtful");
  runs(M "import all.sqlite -o again.sqlite && " M "export --table again.sqlite -o again.yaml && " M
         "export -o all.yaml" T " && cmp all.yaml again.yaml && rm again.* all.yaml",
       "");
  runs(M
       "export -o all.yaml" T " && " M "import all.yaml -o again.sqlite && " M
       "export --table again.sqlite -o again.yaml && cmp all.yaml again.yaml && rm a*n.* all.yaml",
       "14 materials in again.sqlite");
  runs(M "export one-ann --to yaml" T, "");
  assert_contains(run_output, "name: one-Ann\n");
  runs(M "add two-SF10 --from all.sqlite --as mine --table t.yaml --create temperature_c=21 && " M
         "show mine --table t.yaml && rm t.yaml",
       "");
  assert_contains(run_output, "temperature   21 C");
  runs("cp \"$house/scenes/wood.png\" . && sed 's/sf10/two-SF10/' \"$house/scenes/prism.yaml\" "
       ">s.yaml && \"$abbe\" plan s.yaml --materials all.sqlite | grep -q 'the index varies'",
       "");
  bool right = true;
  const struct {
    const char *line;
    const char *part;
  } rows[] = {
      {M "show zoe" T, "has no material 'zoe'"},
      {M "show one-Zo" T, "did you mean 'one-Zoe'?"},
      {M "set one-Zoe source=x" T, "all.sqlite: a store is not edited; 'abbe materials add"},
      {M "add x --from default" T, "a store is not edited"},
      {M "check --fix" T, "a store is not edited"},
      {"\"$abbe\" plan \"$house/scenes/prism.yaml\" --materials all.sqlite",
       "prism.yaml:32: the table 'all.sqlite' has no material 'sf10'; did you mean"}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    int code = run_line(rows[i].line);
    bool good = code == 1 && strstr(run_errors, rows[i].part) != NULL;
    if (!good) print_error("%s: %d: %s\n", rows[i].line, code, run_errors);
    right = right && good;
  }
  assert_true(right);
  runs("rm all.sqlite s.yaml wood.png", "");
  assert_int_equal(run_left(), 0);
#undef T
}

TEST(names_may_get_a_prefix) {
  runs(M "import \"$house/docs/examples/maker.agf\" --prefix maker-", "5 materials");
  assert_contains(run_output, "name: maker-N-BK7\n");
  runs("printf 'nm,n\n500,1.5\n600,1.4\n' >a.csv; " M "import a.csv --name x --prefix 'my '", "");
  assert_contains(run_output, "name: my x\n");
  runs("rm a.csv", "");
}

TEST(wrong_requests_get_a_sentence) {
  const struct {
    const char *line;
    int code;
    const char *part;
  } rows[] = {
      {M "import", 2, "which file?"},
      {M "import a b --name x", 2, "--name names the material of one file"},
      {M "import a --json", 2, "--json goes with -o"},
      {M "import a --format agff", 2, "did you mean 'agf'?"},
      {M "import a --unit feet", 2, "--unit 'feet' is not known"},
      {M "import missing.agf", 1, "missing.agf: cannot be opened"},
      {M "import \"$house/docs/examples\" missing.agf", 1, "missing.agf: cannot be opened"},
      {M "import \"$house/script\"", 1, "holds no file that ends in .agf"},
      {M "export --to sqlite", 2, "a store is a file; name it with -o FILE.sqlite"},
      {"echo hello >x; " M "import x; c=$?; rm x; exit $c", 1, "is none of what can be read"},
      {"echo x >t.yaml; " M
       "import \"$house/spectral/materials/thesis.yaml\" -o t.yaml; c=$?; rm t.yaml; exit $c",
       1, "t.yaml: is there already; --force"},
      {M "import \"$house/spectral/materials/thesis.yaml\" -o missing/t.yaml", 1,
       "missing/t.yaml: cannot be written"},
      {M "import \"$house/spectral/materials/thesis.yaml\" >/dev/full", 1, "could not be written"},
      {M "export", 2, "to what? --to yaml, sqlite"},
      {M "export --to rii", 2, "holds one material; name one"},
      {M "export a b --to csv", 2, "a CSV file holds one material; name one"},
      {M "export n-bk7 --to mtlx --step 1", 2, "--range and --step go with --to csv"},
      {M "export n-bk77 --to mtlx", 1, "did you mean 'n-bk7'?"},
      {M "export n-bk7 N-BK7 --to mtlx", 1, "'n-bk7' is named twice"},
      {M "export n-bk7 --to blender", 2, "--to 'blender' is not known"},
      {M "export n-bk7 --to csv --range 100:400 >/dev/null", 1, "has no index at 100 nm"},
      {M "export --to agf >/dev/full", 1, "could not be written"},
  };
  bool right = true;
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
    right = run_refuses(rows[i].line, rows[i].code, rows[i].part) && right;
  assert_true(right);
}
