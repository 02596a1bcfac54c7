#include "tests/check.h"

#include "spectral/formats/material_import.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char root[64];

/* Files and folders to be removed, the deepest last. */
static char made[128][256];
static int made_count;

static const char *below(const char *name) {
  static char path[64][256];
  static int turn;
  char *mine = path[turn++ % 64];
  snprintf(mine, sizeof path[0], "%s/%s", root, name);
  return mine;
}

static void setup(void) {
  snprintf(root, sizeof root, "/tmp/abbe-test-batch-XXXXXX");
  made_count = 0;
  assert_non_null(mkdtemp(root));
}

static void teardown(void) {
  while (made_count > 0) remove(made[--made_count]);
  assert_false(rmdir(root));
}

static void folder(const char *name) {
  snprintf(made[made_count++], sizeof made[0], "%s", below(name));
  assert_int_equal(mkdir(below(name), 0700), 0);
}

static void file(const char *name, const char *text) {
  FILE *to = fopen(below(name), "wb");
  assert_non_null(to);
  fputs(text, to);
  assert_int_equal(fclose(to), 0);
  snprintf(made[made_count++], sizeof made[0], "%s", below(name));
}

#define RII                                                                                        \
  "REFERENCES: r\nCOMMENTS: |\n  20 \xc2\xb0"                                                      \
  "C\nDATA:\n- {type: formula 5, wavelength_range: 0.4 0.7, coefficients: 1.5}\n"
#define GLASS(name) "NM " name " 2 0 1.5 60\nCD 1.2 0.01\nLD 0.3 2\n"

static abbe_material_table table;
static abbe_report report;

static abbe_result run(const char *const *paths, size_t count, const char *prefix,
                       abbe_error *error) {
  const abbe_import_batch batch = {.path = paths, .count = count, .prefix = prefix};
  abbe_report_free(&report);
  abbe_material_table_free(&table);
  return abbe_import_batch_run(&batch, &table, &report, error);
}

static void runs(const char *const *paths, size_t count, const char *prefix) {
  OK(run(paths, count, prefix, &error));
}

static void assert_names(const char *const *names, size_t count) {
  for (size_t i = 0; i < table.count && i < count; i++)
    assert_string_equal(table.material[i].name, names[i]);
  assert_int_equal(table.count, count);
}

static bool noted(abbe_note_kind kind, const char *part) {
  for (size_t i = 0; i < report.count; i++)
    if (report.note[i].kind == kind && strstr(report.note[i].text, part) != NULL) return true;
  return false;
}

static void done(void) {
  abbe_report_free(&report);
  abbe_material_table_free(&table);
  teardown();
}

/* ---- folders ---- */

EACH(setup, done);

TEST(a_folder_is_read_whole_and_in_order) {
  folder("b");
  folder("b/nk");
  folder("a");
  folder(".git");
  file("b/nk/Zoe.yml", RII);
  file("b/nk/Ann.yml", RII);
  file("a/maker.AGF", "CC maker\n" GLASS("G1") GLASS("G2"));
  file("a/points.csv", "500,1.5\n600,1.4\n");
  file("mine.yaml", "materials:\n- {name: own, model: constant, coefficients: [1.5], source: s}\n");
  /* what is not for us */
  file("about.yml", "ABOUT: 1,2-pentanediol\n1,2-pentanediol boils at 206 C\n");
  file("README.md", "500 1.5\n600 1.4\n");
  file(".git/hidden.agf", GLASS("H"));
  assert_int_equal(symlink("..", below("a/up")), 0);
  snprintf(made[made_count++], sizeof made[0], "%s", below("a/up"));
  const char *const paths[] = {root};
  runs(paths, 1, NULL);
  assert_names((const char *const[]){"G1", "G2", "points", "b-Ann", "b-Zoe", "own"}, 6);
  assert_null(table.description); /* that of one file is not the table's */
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 1);
  assert_true(noted(ABBE_NOTE_SKIPPED, "1 files in folders hold no materials; the first is"));
  /* what a note is about */
  bool found = false;
  for (size_t i = 0; i < report.count; i++)
    found = found || strstr(report.note[i].file, "a/points.csv") != NULL;
  assert_true(found);
}

TEST(a_bad_file_stops_nothing) {
  folder("d");
  file("d/a.agf", GLASS("A"));
  file("d/b.yml", "DATA:\n- {type: tabulated k, data: 0.5 1}\n");
  file("d/c.agf", "NM X 77\nNM Y 78\n");
  file("d/e.csv", "nm,k\n400,1\n");
  file("d/f.yaml", "materials: [\n");
  file("d/g.agf", GLASS("G"));
  file("h.txt", "hello\n");
  const char *const paths[] = {below("d"), below("h.txt")};
  runs(paths, 2, NULL);
  assert_names((const char *const[]){"A", "G"}, 2);
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 5);
  assert_true(noted(ABBE_NOTE_SKIPPED, "d/b.yml:2: holds no index, only k"));
  assert_true(noted(ABBE_NOTE_SKIPPED, "d/c.agf: none of its 2 glasses can be used"));
  assert_true(noted(ABBE_NOTE_SKIPPED, "h.txt: is none of what can be read"));
}

/* Names without an ending or with a short one, links to nothing, and folders too deep to be read.
 */
TEST(odd_entries_stop_nothing) {
  char deep[200] = "d";
  folder("d");
  file("d/a.agf", GLASS("A"));
  file("d/noending", GLASS("B"));
  file("d/x.y", GLASS("C"));
  assert_int_equal(symlink("nowhere.agf", below("d/gone.agf")), 0);
  snprintf(made[made_count++], sizeof made[0], "%s", below("d/gone.agf"));
  for (int i = 0; i < 33; i++) {
    strcat(deep, "/e");
    folder(deep);
  }
  for (int i = 0; i < 18; i++) file(printed("d/n%02d.txt", i), "");
  for (int i = 0; i < 18; i++) file(printed("d/m%02d.agf", i), "");
  const char *const paths[] = {printed("%s/", below("d"))};
  runs(paths, 1, NULL);
  assert_names((const char *const[]){"A"}, 1);
  assert_true(noted(ABBE_NOTE_SKIPPED, "/e: the folder cannot be read: it lies too deep"));
  const abbe_import_batch alone = {.path = (const char *const[]){below("d/a.agf")},
                                   .count = 1,
                                   .import = {.format = ABBE_IMPORT_AGF, .name = "x"},
                                   .target = below("d/noending")};
  OK(abbe_import_batch_run(&alone, &table, &report, &error));
  assert_null(strstr(paths[0], "//"));
}

/* Many files are read by several threads, and taken in the order of their names. */
TEST(many_files_keep_their_order) {
  folder("m");
  for (int i = 0; i < 70; i++)
    file(printed("m/%02d.agf", i), printed("NM G%02d 2 0 1.5 60\nCD 1.2 0.01\nLD 0.3 2\n", i));
  const char *const paths[] = {below("m")};
  runs(paths, 1, NULL);
  assert_int_equal(table.count, 70);
  for (int i = 0; i < 70; i++) assert_string_equal(table.material[i].name, printed("G%02d", i));
}

/* A folder that cannot be opened, for no more files can be. */
TEST(a_folder_that_cannot_be_read) {
  struct rlimit old, few;
  folder("d");
  const char *const paths[] = {below("d")};
  assert_int_equal(getrlimit(RLIMIT_NOFILE, &old), 0);
  few = old;
  few.rlim_cur = 0;
  assert_int_equal(setrlimit(RLIMIT_NOFILE, &few), 0);
  abbe_error why = {0};
  const abbe_result result = run(paths, 1, NULL, &why);
  assert_int_equal(setrlimit(RLIMIT_NOFILE, &old), 0);
  assert_int_equal(result, ABBE_IO);
  assert_contains(why.text, "d: the folder cannot be read: Too many open files");
}

TEST(nothing_at_all_is_a_failure) {
  folder("empty");
  file("a.yml", "DATA:\n- {type: tabulated k, data: 0.5 1}\n");
  file("b.agf", "NM X 77\n");
  const char *const one[] = {below("a.yml")}, *const two[] = {one[0], below("b.agf")};
  const char *const none[] = {below("empty")}, *const typo[] = {one[0], below("c.agf")};
  REFUSED(ABBE_SCHEMA, "a.yml:2: holds no index, only k", run(one, 1, NULL, &error));
  REFUSED(ABBE_SCHEMA, "none of the 2 files can be used; the first: ", run(two, 2, NULL, &error));
  REFUSED(ABBE_NOT_FOUND, "holds no file that ends in .agf, .yml, .yaml, .csv, .sqlite or .mtlx",
          run(none, 1, NULL, &error));
  REFUSED(ABBE_IO, "c.agf: cannot be opened", run(typo, 2, NULL, &error));
  assert_int_equal(report.count, 0); /* it is seen before anything is read */
  const abbe_import_batch named = {.path = two, .count = 2, .import.name = "x"};
  REFUSED(ABBE_INVALID_ARGUMENT, "one name does not go with 2 files",
          abbe_import_batch_run(&named, &table, NULL, &error));
  const abbe_import_batch nothing = {.target = one[0]};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_import_batch_run(&nothing, &table, NULL, &error));
}

TEST(the_target_is_none_of_the_files) {
  folder("d");
  file("d/a.yml", RII);
  file("d/b.yml", RII);
  assert_int_equal(symlink("d/b.yml", below("link")), 0);
  snprintf(made[made_count++], sizeof made[0], "%s", below("link"));
  const char *const all[] = {below("d")};
  abbe_import_batch batch = {.path = all, .count = 1, .target = below("link")};
  REFUSED(ABBE_INVALID_ARGUMENT, "d/b.yml', which is read",
          abbe_import_batch_run(&batch, &table, &report, &error));
  assert_int_equal(table.count + report.count, 0);
  batch.target = below("d/c.yml"); /* not there yet */
  OK(abbe_import_batch_run(&batch, &table, &report, &error));
}

TEST(a_binary_file_is_said_to_be_one) {
  file("a.xls", "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1 \x01\x02\x03\x04\x05\x06\x0e\x0f");
  const char *const one[] = {below("a.xls")};
  REFUSED(ABBE_PARSE, "a.xls: is not a text file", run(one, 1, NULL, &error));
  assert_int_equal(report.count, 0); /* it is said once */
}

/* ---- names ---- */

TEST(two_makers_glasses_are_kept_apart) {
  folder("hoya");
  folder("hoya/optical");
  folder("schott");
  folder("schott/optical");
  folder("schott/old");
  file("hoya/optical/F2.yml", RII);
  file("hoya/optical/X1.yml", RII);
  file("schott/optical/f2.yml", RII);
  file("schott/old/F3.yml", RII);
  file("schott/optical/F3.yml", RII);
  const char *const paths[] = {root};
  runs(paths, 1, NULL);
  assert_names((const char *const[]){"hoya-F2", "X1", "old-F3", "optical-F3", "schott-f2"}, 5);
  assert_int_equal(report.kinds[ABBE_NOTE_RENAMED], 4);
  assert_true(noted(ABBE_NOTE_RENAMED, "is named schott-f2, since several files have"));
  runs(paths, 1, "my ");
  assert_names(
      (const char *const[]){"my hoya-F2", "my X1", "my old-F3", "my optical-F3", "my schott-f2"},
      5);
}

TEST(two_catalogues_glasses_are_kept_apart) {
  folder("2012");
  folder("2017");
  file("2012/schott.agf", GLASS("F2") GLASS("K5"));
  file("2017/schott.agf", GLASS("F2") GLASS("F2") GLASS("SF1"));
  file("2017/hoya.agf", GLASS("F2") GLASS("SF1"));
  const char *const paths[] = {below("2012/schott.agf"), below("2017/schott.agf"),
                               below("2017/hoya.agf"), below("2017/hoya.agf")};
  runs(paths, 2, NULL);
  assert_names((const char *const[]){"2012-F2", "K5", "2017-F2", "SF1"}, 4);
  /* no single part tells three apart */
  runs(paths, 3, NULL);
  assert_names((const char *const[]){"2012-schott-F2", "K5", "2017-schott-F2", "schott-SF1",
                                     "2017-hoya-F2", "hoya-SF1"},
               6);
  /* a file of one material is named after it, which tells nothing */
  folder("specs");
  folder("specs/hikari");
  file("specs/hikari/F2.yml", RII);
  const char *const mixed[] = {below("2017/hoya.agf"), below("specs/hikari/F2.yml")};
  runs(mixed, 2, NULL);
  assert_names((const char *const[]){"hoya-F2", "SF1", "hikari-F2"}, 3);
  /* the same file again is no other maker's */
  runs(paths + 2, 2, NULL);
  assert_names((const char *const[]){"F2", "SF1"}, 2);
  assert_int_equal(report.kinds[ABBE_NOTE_RENAMED], 0);
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 2);
}

/* A prefix that is no part of a name, and files that are called without a folder or an ending. */
TEST(odd_prefixes_and_paths) {
  char *here = getcwd(NULL, 0);
  folder("s");
  file("s/one.b.agf", GLASS("G") GLASS("H"));
  file("s/two", GLASS("G"));
  file("s/.agf", GLASS("G"));
  assert_int_equal(chdir(below("s")), 0);
  const char *const paths[] = {"one.b.agf", "two", ".agf", "two"};
  runs(paths, 3, NULL);
  assert_names((const char *const[]){"one.b-G", "H", "two-G", ".agf-G"}, 4);
  runs(paths, 1, "a\tb\x7f");
  assert_names((const char *const[]){"a?b?G", "a?b?H"}, 2);
  runs(paths, 1, "   ");
  assert_names((const char *const[]){"G", "H"}, 2);
  runs(paths, 1, "a\xff b"); /* no name would be one */
  assert_names((const char *const[]){"G", "H"}, 2);
  file("s/p", "500,1.5\n600,1.4\n");
  const char *const one[] = {"p"}, *const twice[] = {"./one.b.agf", ".//one.b.agf"};
  runs(one, 1, NULL);
  assert_names((const char *const[]){"p"}, 1);
  runs(twice, 2, NULL); /* the same file, by what its path says */
  assert_names((const char *const[]){"G", "H"}, 2);
  OWNED(abbe_material_table, own) = {0};
  OK(abbe_import_load("two", NULL, &own, NULL, &error)); /* what the table had is nobody's file's */
  const abbe_import_batch more = {.path = paths, .count = 1};
  OK(abbe_import_batch_run(&more, &own, NULL, &error));
  assert_int_equal(own.count, 3);
  assert_int_equal(chdir(here), 0);
  free(here);
}

TEST(long_names_are_cut_before) {
  char name[80];
  memset(name, 'n', 70);
  name[70] = '\0';
  folder("a-folder-of-some-length");
  folder("b\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4-folder-of-some-length");
  const char *text = printed("NM %s 2 0 1.5 60\nCD 1.2 0.01\nLD 0.3 2\n", name);
  file("a-folder-of-some-length/x.agf", text);
  file(printed("b\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4-folder-of-some-length/x.agf"), text);
  const char *const paths[] = {root};
  runs(paths, 1, NULL);
  assert_int_equal(table.count, 2);
  assert_string_equal(table.material[0].name, printed("a-folder--%s", name));
  assert_string_equal(table.material[1].name,
                      printed("b\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4-%s", name));
  for (size_t i = 0; i < 2; i++) OK(abbe_material_check(&table.material[i], &error));
  runs(paths, 1, "a very long prefix that does not fit");
  assert_true(noted(ABBE_NOTE_RENAMED, "with the whole prefix its name would be too long"));
}
