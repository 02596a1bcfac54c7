/* The rules for command lines: names that are meant, files named once, and no output over an input
 * or another output, of every verb. */
#include "tests/cli/run_program.h"

#include "cli/base/command.h"
#include "cli/materials/materials.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>

#define ABBE_NAME_OF(name, summary) #name,
#define ABBE_VERB_OF(name, summary) "materials " #name,
static const char *const verbs[] = {ABBE_COMMANDS(ABBE_NAME_OF) ABBE_MATERIALS_VERBS(ABBE_VERB_OF)};

/* What names files: an option, or "" for what is none. What is edited in place is read. */
enum { READS = 1, WRITES = 2 };
static const struct named {
  const char *verb, *option;
  int use;
} named[] = {
    {"render", "", READS},
    {"render", "output", WRITES},
    {"render", "png", WRITES},
    {"render", "stats", WRITES},
    {"render", "save-map", WRITES},
    {"render", "error-png", WRITES},
    {"render", "map-like", READS},
    {"render", "materials", READS},
    {"render", "save-scene", WRITES},
    {"render", "ocio", READS},
    {"render", "volume", READS},
    {"render", "presets", READS},
    {"view", "", READS},
    {"view", "script", READS},
    {"view", "materials", READS},
    {"view", "save-scene", WRITES},
    {"view", "ocio", READS},
    {"view", "volume", READS},
    {"view", "lit-by", READS},
    {"view", "illuminant", READS},
    {"trace", "", READS},
    {"trace", "output", WRITES},
    {"trace", "png", WRITES},
    {"trace", "stats", WRITES},
    {"trace", "save-map", WRITES},
    {"trace", "checkpoint", WRITES},
    {"trace", "map-like", READS},
    {"trace", "materials", READS},
    {"trace", "save-scene", WRITES},
    {"trace", "ocio", READS},
    {"derive", "", READS},
    {"derive", "output", WRITES},
    {"derive", "map-like", READS},
    {"derive", "target", READS},
    {"derive", "materials", READS},
    {"derive", "save-scene", WRITES},
    {"plan", "", READS},
    {"plan", "materials", READS},
    {"plan", "save-scene", WRITES},
    {"plan", "volume", READS},
    {"volume", "", READS},
    {"volume", "output", WRITES},
    {"volume", "checkpoint", WRITES},
    {"volume", "materials", READS},
    {"weights", "illuminant", READS},
    {"display", "", READS},
    {"display", "output", WRITES},
    {"display", "ocio", READS},
    {"display", "lit-by", READS},
    {"display", "illuminant", READS},
    {"export", "", READS},
    {"export", "output", WRITES},
    {"export", "materials", READS},
    {"export", "save-scene", WRITES},
    {"info", "", READS},
    {"pixel", "lit-by", READS},
    {"pixel", "illuminant", READS},
    {"pixel", "plot", WRITES},
    {"relight", "", READS},
    {"relight", "output", WRITES},
    {"relight", "png", WRITES},
    {"relight", "lit-by", READS},
    {"relight", "illuminant", READS},
    {"relight", "ocio", READS},
    {"compare", "", READS},
    {"compare", "difference", WRITES},
    {"compare", "mask", READS},
    {"validate", "chart", WRITES},
    {"materials list", "table", READS},
    {"materials show", "table", READS},
    {"materials plot", "output", WRITES},
    {"materials plot", "table", READS},
    {"materials plot", "points", READS},
    {"materials partners", "output", WRITES},
    {"materials partners", "table", READS},
    {"materials nearest", "table", READS},
    {"materials nearest", "like-table", READS},
    {"materials nearest", "points", READS},
    {"materials check", "table", READS},
    {"materials check", "known", READS},
    {"materials fit", "table", READS},
    {"materials fit", "points", READS},
    {"materials fit", "plot", WRITES},
    {"materials from", "known", READS},
    {"materials set", "table", READS},
    {"materials add", "table", READS},
    {"materials add", "from", READS},
    {"materials add", "record", READS},
    {"materials remove", "table", READS},
    {"materials import", "", READS},
    {"materials import", "output", WRITES},
    {"materials export", "output", WRITES},
    {"materials export", "table", READS},
};
enum { NAMED = sizeof named / sizeof *named };

static bool is_listed(const char *verb, const char *option) {
  for (size_t i = 0; i < NAMED; i++)
    if (strcmp(named[i].verb, verb) == 0 && strcmp(named[i].option, option) == 0) return true;
  return false;
}

EACH(run_setup, run_teardown);

/* Every option whose value is a file by its help is in the table above. */
TEST(the_list_is_whole) {
  static const char *const kinds[] = {"FILE", "TABLE", ".exr", ".png", ".yaml", ".csv", ".pov"};
  size_t found = 0;
  for (size_t v = 0; v < sizeof verbs / sizeof *verbs; v++) {
    run_must(printed("\"$abbe\" %s --help | sed '/^Examples/,$d'", verbs[v]));
    for (char *at = run_output; (at = strstr(at, "--")) != NULL;) {
      char option[40] = "", value[40] = "";
      at += 2;
      if (sscanf(at, "%39[a-z-]=%39s", option, value) != 2) continue;
      bool file = false;
      for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        file = file || strstr(value, kinds[k]) != NULL;
      if (file && !is_listed(verbs[v], option)) fail_msg("%s --%s=%s", verbs[v], option, value);
      found += file;
    }
  }
  size_t options = 0;
  for (size_t i = 0; i < NAMED; i++) options += named[i].option[0] != '\0';
  assert_int_equal(found, options);
}

static void put_option(char *out, size_t size, const struct named *n, const char *path) {
  if (n->option[0] == '\0')
    snprintf(out, size, "%s", path);
  else
    snprintf(out, size, "--%s=%s", n->option, path);
}

/* Both words in one line; `part` is what is said. */
static void refuse_pair(const struct named *a, const char *a_path, const struct named *b,
                        const char *b_path, const char *part) {
  char first[80], second[80];
  put_option(first, sizeof first, a, a_path);
  put_option(second, sizeof second, b, b_path);
  const char *line =
      printed("\"$abbe\" %s %s %s; code=$?; cat in.txt; exit $code", a->verb, first, second);
  int code = run_line(line);
  if (code != 2 || strstr(run_errors, part) == NULL)
    fail_msg("%s\n  ends with %d: %s", line, code, run_errors);
  assert_string_equal(run_output, "kept");
  assert_int_not_equal(run_line("test -e new.txt || test -e sub/new.txt"), 0);
}

TEST(no_output_over_another_file) {
  static const char *const there[] = {"in.txt",   "./in.txt",      "soft.txt",
                                      "hard.txt", "sub/../in.txt", "\"$PWD\"/in.txt"};
  static const char *const none[][2] = {{"new.txt", "new.txt"},
                                        {"new.txt", "./new.txt"},
                                        {"sub/new.txt", "alias/new.txt"},
                                        {"sub/../new.txt", "\"$PWD\"/new.txt"}};
  size_t pairs = 0;
  run_must(
      "printf kept >in.txt; ln -s in.txt soft.txt; ln in.txt hard.txt;mkdir sub; ln -s sub alias");
  for (size_t i = 0; i < NAMED; i++)
    for (size_t k = 0; k < NAMED; k++) {
      if (named[i].use != WRITES || strcmp(named[i].verb, named[k].verb) != 0 || i == k) continue;
      pairs++;
      if (named[k].use == READS)
        refuse_pair(&named[i], there[pairs % 6], &named[k], "in.txt", "is read; name another file");
      else if (i < k)
        refuse_pair(&named[i], none[pairs % 4][0], &named[k], none[pairs % 4][1],
                    "are one file; give each its own");
    }
  assert_true(pairs > 80);
  run_must("rm alias; rmdir sub");
}

/* A dash is standard output where that makes sense, and no file anywhere. */
TEST(a_dash_is_no_file) {
  static const char gem[] =
      "\"$abbe\" trace \"$house\"/scenes/gem.yaml --size 8x8 --spp 1 --photons 64 -q ";
  static const char *const refused[] = {"-o -", "--png -", "--save-map=- --map 4",
                                        "-o a.exr --checkpoint -"};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
    run_fails(printed("%s%s", gem, refused[i]), 2, "goes into a file, not to standard output");
  run_says(printed("%s--stats - --json && ! test -e ./-", gem), "relative_error");
  assert_null(strstr(strstr(run_output, "relative_error") + 1, "relative_error")); /* once */
  assert_int_equal(
      run_line("\"$abbe\" materials export diamond --to csv -o - | grep -c , && ! test -e ./-"), 0);
}

/* Two files that are two may be named, whatever they are called. */
TEST(other_files_are_let_through) {
  run_must(
      "cp \"$house\"/spectral/materials/thesis.yaml t.yaml; mkdir sub;cp t.yaml sub; \"$abbe\" "
      "materials export --table t.yaml --to yaml -o sub/t.yaml --force && \"$abbe\" materials add "
      "bk7 --from t.yaml --as other --table t.yaml && rm sub/t.yaml && rmdir sub");
}

/* What a scene names is read as well. */
TEST(files_of_a_scene) {
  static const char make[] =
      "cp \"$house\"/scenes/wood.png wood.png; cp \"$house\"/spectral/materials/thesis.yaml "
      "t.yaml;\n"
      "(echo mtllib wedge.mtl; cat \"$house\"/tests/bad/inverted.obj) >wedge.obj;\n"
      "printf 'newmtl a\\n' >wedge.mtl; printf '380 1\\n780 1\\n' >lamp.txt;\n"
      "cat >scene.yaml <<END\n"
      "camera: {eye: [0, -1, 0.5], target: [0, 0, 0], size: [8, 8]}\n"
      "materials: t.yaml\n"
      "lights: [{kind: point, position: [0.3, 0, 1], intensity: 3, illuminant: lamp.txt}]\n"
      "objects:\n"
      "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5,\n"
      "   texture: wood.png}\n"
      "- {name: wedge, mesh: wedge.obj, smooth: false, material: bk7,\n"
      "   transform: [{translate: [0, 0, 0.2]}]}\n"
      "END\n"
      "sha256sum wood.png t.yaml wedge.obj wedge.mtl lamp.txt scene.yaml >sums\n";
  static const char *const lines[] = {
      "render scene.yaml -q --size 8x8 --photons 8 --map 8 --png wood.png",
      "render scene.yaml -q --size 8x8 --photons 8 --map 8 --stats wedge.obj",
      "render scene.yaml -q --size 8x8 --photons 8 --map 8 --stats ./lamp.txt",
      "trace scene.yaml -q --spp 1 --photons 8 -o c.exr --checkpoint wedge.obj",
      "trace scene.yaml -q --spp 1 --photons 8 -o c.exr --checkpoint t.yaml",
      "trace scene.yaml -q --spp 1 --photons 8 -o c.exr --checkpoint wedge.mtl",
      "export scene.yaml -q --to povray -o wedge.obj",
  };
  run_must(make);
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    int code = run_line(printed(
        "\"$abbe\" %s; code=$?; sha256sum -c --quiet sums || exit 9; exit $code", lines[i]));
    if (code != 2) fail_msg("%s\n  ends with %d: %s%s", lines[i], code, run_errors, run_output);
    assert_contains(run_errors, "would be written over the scene's file");
  }
  assert_int_not_equal(run_line("ls | grep -E 'exr|csv|checkpoint'"), 0);
}

/* What no option names is claimed as well. */
TEST(files_that_no_option_names) {
  assert_true(run_line("\"$abbe\" trace a.yaml -o c.exr --png c.exr.checkpoint") == 2);
  assert_contains(run_errors, "the checkpoint 'c.exr.checkpoint'");
  assert_true(
      run_line("OCIO=o.txt; export OCIO; printf kept >o.txt; \"$abbe\" display a.exr -o o.txt") ==
      2);
  assert_contains(run_errors, "$OCIO 'o.txt'");
  assert_true(
      run_line("mkdir sub; cp \"$house\"/spectral/materials/thesis.yaml sub/t.yaml;ln sub/t.yaml "
               "sub/hard.yaml; \"$abbe\" materials import sub --force -o sub/hard.yaml; code=$?; "
               "cmp sub/t.yaml \"$house\"/spectral/materials/thesis.yaml || exit 9; rm -r sub; "
               "exit $code") == 1);
  assert_contains(run_errors, "'sub/hard.yaml' would be written over");
}

TEST(names_that_are_meant) {
  static const struct {
    const char *line, *part;
  } rows[] = {
      {"render a.yaml --materialz sapphire --png a.png",
       "there is no option '--materialz'; did you mean '--materials'?"},
      {"render a.yaml --wavelenghts 7 --png a.png",
       "there is no option '--wavelenghts'; did you mean '--wavelengths'?"},
      {"render a.yaml --sample=2 --png a.png", "did you mean '--samples'?"},
      {"render a.yaml --xyzzy --png a.png", "there is no option '--xyzzy'\n"},
      {"render a.yaml --ma 64 --png a.png", "'--map'"},
      {"trace a.yaml -o a.exr --checkpint b", "did you mean '--checkpoint'?"},
      {"materials list --tabel t.yaml", "did you mean '--table'?"},
      {"materials nearest --pionts p.csv", "did you mean '--points'?"},
      {"info", "which file?"},
      {"info a.exr b.exr", "'b.exr' is one argument too many"},
      {"weights --cuont 3", "did you mean '--count'?"},
      {"plan a.yaml --jsno", "did you mean '--json'?"},
      {"materials list --table a.yaml --table b.yaml",
       "--table is given twice, 'a.yaml' and 'b.yaml'; only one can be taken"},
      {"materials list --name a --name b", "--name is given twice"},
      {"render a.yaml -o a.exr -q -ob.exr", "--output is given twice, 'a.exr' and 'b.exr'"},
      {"render a.yaml --materials a --png a.png --materials=b", "--materials is given twice"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    assert_true(run_refuses(printed("\"$abbe\" %s", rows[i].line), 2, rows[i].part));
  /* Abbreviations that lack more, values that look like options, and what may be repeated. */
  run_must("\"$abbe\" weights --co 3 --spa xyz --js");
  run_must("\"$abbe\" materials show n-bk7 --at 500 --at 600");
  run_must("\"$abbe\" materials plot n-bk7 --table default --table thesis -o --a ; test $? -eq 1");
  assert_contains(run_errors, "--a");
}

/* A reader that goes ends the program as it ends others: by SIGPIPE, and without a word. */
TEST(a_reader_that_goes) {
  static char *const asked[][5] = {{"abbe", "help"},
                                   {"abbe", "render", "--help"},
                                   {"abbe", "materials", "list"},
                                   {"abbe", "materials", "list", "--json"},
                                   {"abbe", "weights", "--count", "4096"}};
  for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
    int ends[2], status = 0;
    struct stat said;
    assert_int_equal(pipe(ends), 0);
    close(ends[0]);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
      int errors = open(run_path("errors"), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (errors < 0 || dup2(errors, 2) < 0 || dup2(ends[1], 1) < 0) _exit(99);
      execv(ABBE_PROGRAM, asked[i]);
      _exit(99);
    }
    close(ends[1]);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE);
    assert_int_equal(stat(run_path("errors"), &said), 0);
    assert_int_equal(said.st_size, 0);
  }
}
