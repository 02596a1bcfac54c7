/* The verbs of `abbe materials` that change a table, as people meet them. */
#include "tests/cli/run_program.h"

#define TABLE " --table t.yaml"
#define MATERIALS "\"$abbe\" materials "
#define RENEW "cp \"$house\"/spectral/materials/thesis.yaml t.yaml && "

GROUP(run_setup, run_teardown);

TEST(a_row_is_corrected) {
  run_must(RENEW MATERIALS "set k5 coefficients.0=1.5090 --unset warning --dry-run" TABLE
                           " && cmp t.yaml \"$house\"/spectral/materials/thesis.yaml");
  assert_string_equal(run_output, "t.yaml: the record 'k5' is changed\n  n_d 1.535296 -> 1.522296, "
                                  "V_d 61.071 -> 59.588\n  nothing is written\n");
  run_fails(MATERIALS "set k5 coefficients.0=1.5090 source='own: 3 May' note=1" TABLE, 1,
            "nothing was written: t.yaml:33: a material has no key 'note'");
  run_says(
      MATERIALS "set k5 coefficients.0=1.5090 source='own: 3 May'" TABLE,
      "t.yaml: the record 'k5' is changed\n  n_d 1.535296 -> 1.522296, V_d 61.071 -> 59.588\n");
  run_must("diff t.yaml \"$house\"/spectral/materials/thesis.yaml | grep -c '^[<>]'");
  assert_string_equal(run_output, "4\n");
  run_says(MATERIALS "show k5 --at 587.5618" TABLE, "own: 3 May");
  run_must("rm t.yaml");
}

TEST(what_is_so_already_is_not_changed) {
  run_says(RENEW MATERIALS "set k5 coefficients.1=0.00459" TABLE,
           "it says so already; nothing is changed");
  run_must("cmp t.yaml \"$house\"/spectral/materials/thesis.yaml && rm t.yaml");
}

TEST(records_come_and_go) {
  run_must(MATERIALS "add n-bk7 --from default --create" TABLE);
  run_must(MATERIALS "add f2 --from default --as my-f2 source='melt 7'" TABLE);
  run_must(MATERIALS "add mine model=cauchy 'coefficients=[1.509, 0.0046]' 'range_nm=[400, 700]' "
                     "source='own: 3 May'" TABLE);
  run_must("printf 'name: x\\nmodel: constant\\ncoefficients: [2]\\nsource: s\\n' | \"$abbe\" "
           "materials add --record -" TABLE);
  run_must(MATERIALS "set x name='x, the last'" TABLE);
  run_must(MATERIALS "remove n-bk7 MY-F2" TABLE);
  run_must("cat t.yaml && rm t.yaml");
  assert_string_equal(run_output, "materials:\n  - name: mine\n    model: cauchy\n"
                                  "    coefficients: [1.509, 0.0046]\n    range_nm: [400, 700]\n"
                                  "    source: \"own: 3 May\"\n\n  - name: \"x, the last\"\n"
                                  "    model: constant\n    coefficients: [2]\n    source: s\n");
}

/* A copied record is the shipped one, comments and all. */
TEST(a_copy_is_whole) {
  run_must(MATERIALS "add f2 --from default --create" TABLE
                     " && grep -c '# 4 pi k' t.yaml && " MATERIALS "show f2" TABLE
                     " > a && " MATERIALS "show f2 > b && cmp a b && rm a b t.yaml");
}

TEST(wrong_use_gets_a_sentence) {
  const struct {
    const char *line, *part;
    int code;
  } cases[] = {
      {MATERIALS "set k5 a=1", "--table FILE", 2},
      {MATERIALS "set" TABLE, "set what?", 2},
      {MATERIALS "set k5" TABLE, "Write KEY=VALUE", 2},
      {MATERIALS "set k5 red" TABLE, "'red' sets nothing", 2},
      {MATERIALS "set k5 source=" TABLE, "--unset source", 1},
      {MATERIALS "set k6 source=x" TABLE, "did you mean 'k5'?", 1},
      {MATERIALS "set k5 range_nm=380:780" TABLE, "'range_nm' wants a list of 2 numbers", 1},
      {MATERIALS "set k5 'range_nm=[380'" TABLE, "break the file", 1},
      {MATERIALS "set k5 coefficients.2=1" TABLE, "has no 'coefficients.2'; the list has 2 items",
       1},
      {MATERIALS "set k5 coefficients.1=0,0046" TABLE, "with a decimal point, 0.0046", 1},
      {MATERIALS "set k5 --unset fit" TABLE, "has no 'fit'", 1},
      {MATERIALS "set k5 --unset source" TABLE, "the key 'source' is missing", 1},
      {MATERIALS "set k5 source=x --table thesis", "is compiled in", 1},
      {MATERIALS "set k5 source=x --table no.yaml", "no.yaml: cannot be opened", 1},
      {MATERIALS "add k5" TABLE, "--from TABLE", 2},
      {MATERIALS "add" TABLE, "add what?", 2},
      {MATERIALS "add k5 --from default" TABLE, "has a material 'k5' already", 1},
      {MATERIALS "add k9 --from default" TABLE, "no material 'k9'", 1},
      {MATERIALS "add k9 --from default --table no.yaml", "--create makes a new table", 1},
      {MATERIALS "add --record no.yaml" TABLE, "no.yaml: cannot be opened", 1},
      {MATERIALS "add --record t.yaml k5" TABLE, "--record goes without", 2},
      {MATERIALS "add --record t.yaml" TABLE, "nothing was written", 1},
      {MATERIALS "add x model=cauchy" TABLE, "the key 'source' is missing", 1},
      {MATERIALS "add x --as y model=cauchy" TABLE, "--as goes with --from", 2},
      {MATERIALS "remove" TABLE, "remove what?", 2},
      {MATERIALS "remove k5 k5" TABLE, "no material 'k5'", 1},
      {MATERIALS "remove fused-silica bk7 k5 bak4 baf10" TABLE, "at least one", 1},
      {MATERIALS "set k5 name=BK7" TABLE, "is taken", 1},
      {MATERIALS "set k5 name=' x'" TABLE, "'name'", 1},
  };
  run_must(RENEW "true");
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    int code = run_line(cases[i].line);
    if (code != cases[i].code || run_output[0] != '\0')
      fail_msg("%s: %d\n%s%s", cases[i].line, code, run_output, run_errors);
    assert_contains(run_errors, cases[i].part);
  }
  run_must("cmp t.yaml \"$house\"/spectral/materials/thesis.yaml && rm t.yaml");
}

/* Each line of the examples is a command or its next line: none was broken to fit the page. */
TEST(help_shows_examples) {
  const char *const verbs[] = {"list", "show", "plot", "nearest", "check",  "fit",
                               "from", "set",  "add",  "remove",  "import", "export"};
  for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
    const char *line = printed(MATERIALS "%s --help", verbs[i]);
    const char *example = printed("  abbe materials %s ", verbs[i]);
    run_says(line, "Examples:");
    assert_contains(run_output, example);
    const char *c = strstr(run_output, "Examples:\n") + 10;
    for (; *c != '\n' && *c != '\0'; c += strcspn(c, "\n") + 1)
      if (c[0] != ' ') fail_msg("%s: a broken example: %.40s", verbs[i], c);
  }
}
