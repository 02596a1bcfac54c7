#define _XOPEN_SOURCE 700
#include "tests/check.h"
#include "tests/random.h"

#include "base/file.h"
#include "spectral/editing/table_edit.h"
#include "spectral/materials/material_table.h"

#include <sys/stat.h>
#include <unistd.h>

static const char two[] = "# Two glasses\n"
                          "description: two\n"
                          "\n"
                          "materials:\n"
                          "  # the first\n"
                          "  - name: crown # a crown\n"
                          "    model: cauchy\n"
                          "    coefficients: [1.5220, # high\n"
                          "                   0.00459]\n"
                          "    range_nm: [380, 780]\n"
                          "    source: \"[Somebody] p. 3\"\n"
                          "    # of the crown\n"
                          "\n"
                          "  - {name: flint, model: constant, coefficients: [1.6], source: x}\n"
                          "# the end\n";

static abbe_table_edit *parse(const char *text) {
  abbe_table_edit *edit = NULL;
  OK(abbe_table_edit_parse(text, strlen(text), "t.yaml", &edit, &error));
  return edit;
}

static const char *text_of(const abbe_table_edit *edit) {
  size_t size = 0;
  const char *text = abbe_table_edit_text(edit, &size);
  assert_int_equal(strlen(text), size);
  return text;
}

/* The diff of the edit, without its head. */
static void check_diff(abbe_table_edit *edit, const char *wanted) {
  char diff[4096] = "";
  size_t size = 0;
  const char *before = abbe_table_edit_original(edit, &size);
  OK(abbe_table_edit_check(edit, &error));
  OK(abbe_file_write("before.yaml", before, size, &error));
  OK(abbe_file_write("after.yaml", text_of(edit), strlen(text_of(edit)), &error));
  FILE *shown = popen("diff -u before.yaml after.yaml", "r");
  assert_non_null(shown);
  diff[fread(diff, 1, sizeof diff - 1, shown)] = '\0';
  pclose(shown);
  remove("before.yaml"), remove("after.yaml");
  if (strstr(diff, wanted) == NULL) fail_msg("%s\nis not\n%s", diff, wanted);
  abbe_table_edit_free(edit);
}

TEST(values_are_set) {
  abbe_table_edit *edit = parse(two);
  OK(abbe_table_edit_set(edit, "CROWN", "coefficients.0", "1.5090", &error));
  check_diff(edit, "@@ -5,7 +5,7 @@\n   # the first\n   - name: crown # a crown\n"
                   "     model: cauchy\n-    coefficients: [1.5220, # high\n"
                   "+    coefficients: [1.5090, # high\n                    0.00459]\n");
  edit = parse(two);
  OK(abbe_table_edit_set_text(edit, "flint", "source", "me: 3 May", &error));
  OK(abbe_table_edit_set(edit, "flint", "temperature_c", "20", &error));
  check_diff(edit, "+  - {name: flint, model: constant, coefficients: [1.6], temperature_c: 20, "
                   "source: \"me: 3 May\"}\n");
}

TEST(new_keys_go_where_the_format_has_them) {
  abbe_table_edit *edit = parse(two);
  OK(abbe_table_edit_set_text(edit, "crown", "warning", "Old.", &error));
  OK(abbe_table_edit_set_text(edit, "crown", "description", "A crown", &error));
  OK(abbe_table_edit_set(edit, "crown", "absorption.colour", "[0.9, 0.8, 0.7]", &error));
  OK(abbe_table_edit_set(edit, "crown", "absorption.distance_m", "0.01", &error));
  check_diff(edit, "+    description: A crown\n     model: cauchy\n");
  edit = parse(two);
  OK(abbe_table_edit_set(edit, "crown", "fit.cauchy2.coefficients", "[1, 2]", &error));
  OK(abbe_table_edit_set(edit, "crown", "fit.cauchy2.max_error", "0.1", &error));
  check_diff(edit, "     source: \"[Somebody] p. 3\"\n"
                   "+    fit: {cauchy2: {coefficients: [1, 2], max_error: 0.1}}\n"
                   "     # of the crown\n");
}

TEST(keys_and_records_come_and_go) {
  abbe_table_edit *edit = parse(two);
  OK(abbe_table_edit_set(edit, "flint", "warning", "x", &error));
  OK(abbe_table_edit_unset(edit, "flint", "warning", &error));
  assert_string_equal(text_of(edit), two);
  OK(abbe_table_edit_add(edit, "name: third\nmodel: constant\ncoefficients: [2]\nsource: s\n",
                         &error));
  OK(abbe_table_edit_rename(edit, "third", "Third: a", &error));
  OK(abbe_table_edit_remove(edit, "flint", &error));
  check_diff(edit, "     # of the crown\n \n"
                   "-  - {name: flint, model: constant, coefficients: [1.6], source: x}\n"
                   "+  - name: \"Third: a\"\n+    model: constant\n+    coefficients: [2]\n"
                   "+    source: s\n # the end\n");
  edit = parse(two);
  OK(abbe_table_edit_remove(edit, "crown", &error));
  check_diff(edit, "   # the first\n-  - name: crown # a crown\n-    model: cauchy\n"
                   "-    coefficients: [1.5220, # high\n-                   0.00459]\n"
                   "-    range_nm: [380, 780]\n-    source: \"[Somebody] p. 3\"\n"
                   "-    # of the crown\n \n");
}

/* Whatever is done to a shipped record, the others stay; all is done to the first and last ones. */
TEST(each_edit_stays_inside_its_record) {
  const char *const paths[] = {ABBE_SOURCE_DIR "/spectral/materials/materials.yaml",
                               ABBE_SOURCE_DIR "/spectral/materials/thesis.yaml"};
  for (int file = 0; file < 2; file++) {
    FREED char *before = NULL;
    size_t size = 0;
    OK(abbe_file_read(paths[file], 1 << 20, &before, &size, &error));
    MADE(abbe_material_table, table, abbe_material_table_parse(before, size, "t", &table, &error));
    for (size_t i = 0; i < table.count; i++)
      for (size_t action = 0; action < 5; action++) {
        const abbe_material *m = &table.material[i];
        if (i > 4 && i + 1 < table.count && i % 5 != action) continue;
        HELD(abbe_table_edit, edit) = parse(before);
        if (action == 0) OK(abbe_table_edit_set(edit, m->name, "warning", "\"# x\"", &error));
        if (action == 1) OK(abbe_table_edit_set(edit, m->name, "coefficients", "[1.75]", &error));
        if (action == 2) OK(abbe_table_edit_rename(edit, m->name, "Zzz", &error));
        if (action == 3) OK(abbe_table_edit_unset(edit, m->name, "source", &error));
        if (action == 4) OK(abbe_table_edit_remove(edit, m->name, &error));
        const char *after = text_of(edit);
        char next[128] = "";
        const char *own = printed("  - name: %s\n", m->name);
        if (i + 1 < table.count) snprintf(next, sizeof next, "  - name: %s\n", m[1].name);
        size_t head = (size_t)(strstr(before, own) - before);
        if (action == 4 && !*next) head--; /* the blank line that set it off goes with it */
        assert_memory_equal(before, after, head);
        const char *tail[2] = {*next ? strstr(before, next) : "", *next ? strstr(after, next) : ""};
        assert_string_equal(tail[0], tail[1]);
        assert_string_not_equal(before, after);
      }
  }
}

/* ---- laws, over random tables in every style ---- */

static uint64_t state_of_chance;

static unsigned chance(unsigned below) {
  return (unsigned)(random_bits(&state_of_chance) >> 33) % below;
}

/* A value of a record, in one of the ways that YAML has to write it. */
static void add_values(char *out, const char *end, const char *indent, bool flow) {
  const char *between = flow ? ", " : end;
  const char *lead = flow ? "" : indent;
  const char *note = !flow && chance(3) == 0 ? " # \u00b5, in" : "";
  out += strlen(out);
  out += sprintf(out, "%s%smodel: cauchy%s", between, lead, note);
  if (!flow && chance(3) == 0)
    out += sprintf(out, "%s%scoefficients:%s%s- 1.5 # A%s%s- 4e-3", between, lead, end, lead, end,
                   lead);
  else if (!flow && chance(2) == 0)
    out += sprintf(out, "%s%scoefficients: [1.5, # A%s%s  4e-3 ]", between, lead, end, lead);
  else
    out += sprintf(out, "%s%scoefficients: [1.5, 4e-3]", between, lead);
  if (!flow && chance(2) == 0) out += sprintf(out, "%s%s# inside", end, lead);
  out += sprintf(out, "%s%srange_nm: [380, 780]", between, lead);
  if (chance(2) == 0) out += sprintf(out, "%s%stemperature_c: 20", between, lead);
  if (!flow && chance(2) == 0)
    out += sprintf(out, "%s%swarning: >-%s%s  two%s%s  lines", end, lead, end, lead, end, lead);
  sprintf(out, "%s%ssource: 's: it''s'", between, lead);
}

/* count records m0, m1, … in block style, in brackets, or some so and some so. */
static void make_table(char *out, int count) {
  const char *end = chance(4) == 0 ? "\r\n" : "\n";
  bool brackets = chance(4) == 0, blank = chance(2) == 0;
  const char *dash = chance(2) == 0 ? "" : "  ";
  const char *indent = printed("%s  ", dash);
  *out = '\0';
  if (chance(3) == 0) strcpy(out, "\xEF\xBB\xBF");
  sprintf(out + strlen(out), "# out%sdescription: a \u2026 table%smaterials:%s", end, end,
          brackets ? " [" : "");
  for (int i = 0; i < count; i++) {
    bool flow = brackets || chance(4) == 0;
    if (!brackets && i > 0 && blank) strcat(out, end);
    if (!brackets && chance(3) == 0) sprintf(out + strlen(out), "%s# out", end);
    sprintf(out + strlen(out), "%s%s%s%sname: m%d", brackets ? (i > 0 ? ", " : "") : end,
            brackets ? "" : dash, brackets ? "" : "- ", flow ? "{" : "", i);
    add_values(out, end, indent, flow);
    if (flow) strcat(out, "}");
  }
  if (brackets) strcat(out, "]");
  if (chance(3) == 0) sprintf(out + strlen(out), "%s# out", end);
  if (chance(4) > 0) strcat(out, end);
}

static int count_of(const char *text, const char *part) {
  int count = 0;
  for (const char *at = text; (at = strstr(at, part)) != NULL; at++) count++;
  return count;
}

/* One random change to the record `name`; true where it is gone after. */
static bool change(abbe_table_edit *edit, const char *name) {
  switch (chance(7)) {
  case 0:
    OK(abbe_table_edit_set(edit, name, "coefficients.1", "5e-3", &error));
    return false;
  case 1:
    OK(abbe_table_edit_set(edit, name, "coefficients", "[1.6, 0, 1e-6]", &error));
    return false;
  case 2:
    OK(abbe_table_edit_set_text(edit, name, "warning", "a: b # c", &error));
    return false;
  case 3:
    OK(abbe_table_edit_set(edit, name, "absorption.colour", "[1, 1, 1]", &error));
    OK(abbe_table_edit_set(edit, name, "absorption.distance_m", "1", &error));
    return false;
  case 4:
    OK(abbe_table_edit_set(edit, name, "temperature_c", "21", &error));
    OK(abbe_table_edit_unset(edit, name, "temperature_c", &error));
    return false;
  case 5:
    OK(abbe_table_edit_rename(edit, name, "another", &error));
    return true;
  default:
    OK(abbe_table_edit_remove(edit, name, &error));
    return true;
  }
}

static void check_random_table(int round) {
  static char text[1 << 14];
  enum { COUNT = 4 };
  char *before[COUNT], name[8];
  state_of_chance = (uint64_t)round;
  make_table(text, COUNT);
  HELD(abbe_table_edit, edit) = parse(text);
  OK(abbe_table_edit_check(edit, &error));
  for (int i = 0; i < COUNT; i++) {
    snprintf(name, sizeof name, "m%d", i);
    OK(abbe_table_edit_record(edit, name, &before[i], &error));
  }
  int chosen = (int)chance(COUNT);
  snprintf(name, sizeof name, "m%d", chosen);
  bool gone = change(edit, name);
  if (abbe_table_edit_check(edit, &last_error) != ABBE_OK)
    fail_msg("%d: %s\n%s\n---\n%s", round, last_error.text, text, text_of(edit));
  char *after = NULL;
  bool found = abbe_table_edit_record(edit, name, &after, &last_error) == ABBE_OK;
  if (found == gone) fail_msg("%d: %s is %s", round, name, gone ? "there" : "gone");
  free(after);
  if (count_of(text, "# out") != count_of(text_of(edit), "# out"))
    fail_msg("%d: a comment is lost\n%s\n---\n%s", round, text, text_of(edit));
  for (int i = 0; i < COUNT; i++) {
    snprintf(name, sizeof name, "m%d", i);
    if (i != chosen) {
      OK(abbe_table_edit_record(edit, name, &after, &error));
      assert_string_equal(after, before[i]);
      free(after);
    }
    free(before[i]);
  }
}

TEST(random_tables_keep_their_other_records) {
  for (int round = 0; round < (SANITIZED ? 250 : 1000); round++) check_random_table(round);
}

static void refuses(const char *text, abbe_result code, const char *part,
                    abbe_result (*act)(abbe_table_edit *, abbe_error *)) {
  HELD(abbe_table_edit, edit) = parse(text);
  if (act(edit, &last_error) != code) fail_msg("not '%s': %s", part, last_error.text);
  assert_contains(last_error.text, part);
  assert_string_equal(text_of(edit), text);
}

static abbe_result set_unknown(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_set(e, "crwon", "source", "x", error);
}
static abbe_result set_deep(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_set(e, "crown", "source.more", "x", error);
}
static abbe_result set_index(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_set(e, "crown", "coefficients.2", "1", error);
}
static abbe_result set_empty_step(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_set(e, "crown", "fit..cauchy2", "1", error);
}
static abbe_result unset_absent(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_unset(e, "crown", "warning", error);
}
static abbe_result rename_taken(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_rename(e, "crown", "FLINT", error);
}
static abbe_result remove_flint(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_remove(e, "flint", error);
}
static abbe_result set_flint(abbe_table_edit *e, abbe_error *error) {
  return abbe_table_edit_set(e, "flint", "coefficients.0", "2", error);
}

TEST(what_cannot_be_is_refused) {
  refuses(two, ABBE_NOT_FOUND, "did you mean 'crown'?", set_unknown);
  refuses(two, ABBE_NOT_FOUND, "has no 'source.more'", set_deep);
  refuses(two, ABBE_NOT_FOUND, "has no 'coefficients.2'", set_index);
  refuses(two, ABBE_INVALID_ARGUMENT, "'fit..cauchy2' is no key", set_empty_step);
  refuses(two, ABBE_NOT_FOUND, "has no 'warning'", unset_absent);
  refuses(two, ABBE_INVALID_ARGUMENT, "t.yaml:14: the name 'FLINT' is taken", rename_taken);
  refuses(two, ABBE_INVALID_ARGUMENT, "from memory", abbe_table_edit_save);
  refuses("materials: [{name: flint}]", ABBE_INVALID_ARGUMENT, "only record", remove_flint);
  refuses("materials: [{name: flint}, {name: Flint}]", ABBE_INVALID_ARGUMENT, "lines 1 and 1",
          remove_flint);
  refuses("materials: [{name: a, coefficients: &c [1]}, {name: flint, coefficients: *c}]",
          ABBE_UNSUPPORTED, "alias", set_flint);
  abbe_table_edit *edit = NULL;
  REFUSED(ABBE_UNSUPPORTED, "'default' is compiled in", abbe_table_edit_open(NULL, &edit, &error));
  REFUSED(ABBE_IO, "", abbe_table_edit_open("/no/such.yaml", &edit, &error));
  REFUSED(ABBE_SCHEMA, "no list 'materials'", abbe_table_edit_parse("a: 1", 4, "t", &edit, &error));
  REFUSED(ABBE_SCHEMA, "", abbe_table_edit_parse("- 1", 3, "t", &edit, &error));
}

/* ---- files ---- */

static char path[] = "/tmp/abbe-test-table-edit-XXXXXX";

static void make_file(void) {
  strcpy(path + strlen(path) - 6, "XXXXXX");
  int fd = mkstemp(path);
  assert_false(fd < 0);
  assert_int_equal(close(fd), 0);
  OK(abbe_file_write(path, two, strlen(two), &error));
}

static void drop_file(void) {
  unlink(path);
}

static void check_file(const char *wanted) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 20, &text, &size, &error));
  assert_string_equal(text, wanted);
}

TEST_WITH(a_saved_edit_is_on_the_disk, make_file, drop_file) {
  HELD(abbe_table_edit, edit) = NULL;
  struct stat status;
  assert_int_equal(chmod(path, 0640), 0);
  OK(abbe_table_edit_open(path, &edit, &error));
  OK(abbe_table_edit_set(edit, "flint", "coefficients.0", "1.7", &error));
  check_file(two);
  OK(abbe_table_edit_save(edit, &error));
  check_file(text_of(edit));
  assert_int_equal(stat(path, &status), 0);
  assert_int_equal(status.st_mode & 0777, 0640);
  OK(abbe_table_edit_set(edit, "flint", "coefficients.0", "1.6", &error));
  OK(abbe_table_edit_save(edit, &error));
  check_file(two);
}

TEST_WITH(a_file_that_changed_is_not_overwritten, make_file, drop_file) {
  HELD(abbe_table_edit, edit) = NULL;
  OK(abbe_table_edit_open(path, &edit, &error));
  OK(abbe_table_edit_set(edit, "flint", "coefficients.0", "1.7", &error));
  OK(abbe_file_write(path, "materials: []\n", 14, &error));
  REFUSED(ABBE_IO, "changed by someone else", abbe_table_edit_save(edit, &error));
  check_file("materials: []\n");
}

TEST_WITH(a_table_is_not_broken_but_may_be_fixed, make_file, drop_file) {
  HELD(abbe_table_edit, edit) = NULL;
  OK(abbe_table_edit_open(path, &edit, &error));
  OK(abbe_table_edit_set(edit, "flint", "model", "cauhcy", &error));
  REFUSED(ABBE_SCHEMA, "nothing was written: ", abbe_table_edit_save(edit, &error));
  assert_contains(last_error.text, ":14: 'model: cauhcy' is not known; did you mean 'cauchy'?");
  check_file(two);
  abbe_table_edit_free(edit);
  const char broken[] = "materials:\n- {name: a, model: x, source: s}\n- {name: b, model: y}\n";
  OK(abbe_file_write(path, broken, strlen(broken), &error));
  OK(abbe_table_edit_open(path, &edit, &error));
  OK(abbe_table_edit_set(edit, "a", "model", "constant", &error));
  OK(abbe_table_edit_set(edit, "a", "coefficients", "[1.5]", &error));
  OK(abbe_table_edit_save(edit, &error)); /* b is still wrong: one fix at a time */
  REFUSED(ABBE_SCHEMA, "", abbe_table_edit_check(edit, &error));
}

TEST_WITH(a_new_table_begins_with_a_record, make_file, drop_file) {
  HELD(abbe_table_edit, edit) = NULL;
  REFUSED(ABBE_IO, "is there already", abbe_table_edit_make(path, &edit, &error));
  unlink(path);
  OK(abbe_table_edit_make(path, &edit, &error));
  REFUSED(ABBE_SCHEMA, "", abbe_table_edit_save(edit, &error)); /* no record yet */
  assert_int_not_equal(access(path, F_OK), 0);
  OK(abbe_table_edit_add(edit, "{name: a, model: constant, coefficients: [1.5], source: s}",
                         &error));
  OK(abbe_table_edit_save(edit, &error));
  check_file("materials:\n  - {name: a, model: constant, coefficients: [1.5], source: s}\n");
}

TEST(a_record_moves_from_table_to_table) {
  HELD(abbe_table_edit, from) = parse(two);
  HELD(abbe_table_edit, to) = parse("materials: [{name: a}]\n");
  FREED char *text = NULL;
  OK(abbe_table_edit_record(from, "crown", &text, &error));
  assert_string_equal(text, "name: crown # a crown\nmodel: cauchy\n"
                            "coefficients: [1.5220, # high\n               0.00459]\n"
                            "range_nm: [380, 780]\nsource: \"[Somebody] p. 3\"\n# of the crown");
  OK(abbe_table_edit_add(to, text, &error));
  assert_string_equal(text_of(to),
                      "materials: [{name: a}, {name: crown, model: cauchy, coefficients: [1.5220, "
                      "0.00459], range_nm: [380, 780], source: \"[Somebody] p. 3\"}]\n");
}
