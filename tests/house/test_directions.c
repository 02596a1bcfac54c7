/* The rooms include only what they may: the directions of CONVENTIONS.md, read from the sources. */
#include "tests/check.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/stat.h>

#define ALL "base spectral colorimetry scenes gl validation cli tests"
static const struct {
  const char *room, *may;
} directions[] = {
    {"base", "base"},
    {"spectral", "base spectral"},
    {"colorimetry", "base spectral colorimetry"},
    {"scenes", "base spectral colorimetry scenes"},
    {"gl", "base spectral colorimetry scenes gl"},
    {"validation", "base spectral colorimetry scenes validation"},
    {"cli", ALL},
    {"tests", ALL},
};
enum { ROOMS = sizeof directions / sizeof *directions, MAX_PATH = 1024 };

/* The exceptions: the sweep compares both pictures; C++ stays in the bridges. */
static const char *const exception_files = "validation/sweep/", *const exception_room = "gl";
static const char *const bridges[] = {"colorimetry/image/display_ocio.cpp", "scenes/geometry/transform.cpp",
                                      "scenes/mesh/edge_collapse.cpp", "tests/colorimetry/image/exr_library.cpp"};

static size_t folder_length(const char *path) {
  const char *slash = strchr(path, '/');
  return slash != NULL ? (size_t)(slash - path) : 0;
}

static int room_of(const char *path) {
  for (int i = 0; i < ROOMS; i++)
    if (strlen(directions[i].room) == folder_length(path) &&
        strncmp(path, directions[i].room, folder_length(path)) == 0)
      return i;
  return -1;
}

static bool has_word(const char *words, const char *word) {
  size_t length = strlen(word);
  if (length == 0) return false;
  for (const char *at = words; (at = strstr(at, word)) != NULL; at += length)
    if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
  return false;
}

static bool may_include(const char *file, const char *included) {
  int from = room_of(file), to = room_of(included);
  if (from < 0 || to < 0) return false;
  if (has_word(directions[from].may, directions[to].room)) return true;
  return strncmp(file, exception_files, strlen(exception_files)) == 0 &&
         strcmp(directions[to].room, exception_room) == 0;
}

static const char *ending(const char *path) {
  const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
  return dot != NULL && (slash == NULL || dot > slash) ? dot + 1 : "";
}

static bool is_c(const char *path) {
  return has_word("c h", ending(path));
}

static bool is_cpp(const char *path) {
  return has_word("cpp cc cxx hpp hh C", ending(path));
}

static bool is_bridge(const char *path) {
  for (size_t i = 0; i < sizeof bridges / sizeof *bridges; i++)
    if (strcmp(path, bridges[i]) == 0) return true;
  return false;
}

/* The name between the quotes of an include line. <…> counts where it starts with a room. */
static bool included_name(const char *line, char *out, size_t size) {
  char mark, name[MAX_PATH];
  if (sscanf(line, " # include %c%1023[^\">]", &mark, name) != 2) return false;
  if (mark != '"' && !(mark == '<' && room_of(name) >= 0)) return false;
  snprintf(out, size, "%s", name);
  return true;
}

typedef struct survey {
  size_t files, includes, wrong;
} survey;

static void complain(survey *s, const char *file, int line, const char *what) {
  print_error("%s:%d: %s\n", file, line, what);
  s->wrong++;
}

static void read_includes(survey *s, const char *path) {
  char line[2048], full[2 * MAX_PATH], name[MAX_PATH], what[2 * MAX_PATH];
  struct stat status;
  snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", path);
  FILE *file = fopen(full, "r");
  assert_non_null(file);
  for (int number = 1; fgets(line, sizeof line, file) != NULL; number++) {
    if (!included_name(line, name, sizeof name)) continue;
    s->includes++;
    snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", name);
    snprintf(what, sizeof what, "may not include \"%s\"", name);
    if (!may_include(path, name)) complain(s, path, number, what);
    snprintf(what, sizeof what, "\"%s\" is not there; includes are written from the root", name);
    if (stat(full, &status) != 0) complain(s, path, number, what);
  }
  fclose(file);
}

static void visit_file(survey *s, const char *path) {
  if (!is_c(path) && !is_cpp(path)) return;
  s->files++;
  if (room_of(path) < 0) complain(s, path, 1, "is in no room");
  if (is_cpp(path) && !is_bridge(path)) complain(s, path, 1, "is C++ and no bridge");
  read_includes(s, path);
}

/* Hidden folders and what the build and the demo make are not sources. */
static bool is_source_folder(const char *path) {
  return strcmp(path, "build") != 0 && strcmp(path, "out") != 0;
}

static void visit_folder(survey *s, const char *folder) {
  char full[2 * MAX_PATH], path[MAX_PATH];
  struct stat status;
  snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", folder);
  DIR *dir = opendir(full);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
    if (entry->d_name[0] == '.') continue;
    int n = snprintf(path, sizeof path, "%s%s%s", folder, *folder ? "/" : "", entry->d_name);
    assert_true(n > 0 && (size_t)n < sizeof path);
    snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", path);
    if (stat(full, &status) != 0) continue;
    if (!S_ISDIR(status.st_mode))
      visit_file(s, path);
    else if (is_source_folder(path))
      visit_folder(s, path);
  }
  closedir(dir);
}

static void test_the_sources_keep_the_directions(void **state) {
  (void)state;
  survey s = {0};
  visit_folder(&s, "");
  assert_int_equal(s.wrong, 0);
  /* The survey has read the house and not an empty folder. */
  assert_true(s.files > 100);
  assert_true(s.includes > 3 * s.files / 2);
}

static void test_the_rule_refuses_wrong_directions(void **state) {
  (void)state;
  assert_true(may_include("gl/plan/plan.c", "scenes/scene.h"));
  assert_true(may_include("scenes/scene.c", "colorimetry/image/image.h"));
  assert_true(may_include("cli/render/render.c", "validation/tracer/tracer.h"));
  assert_true(may_include("validation/sweep/sweep_measure.c", "gl/renderer.h"));
  assert_true(may_include("validation/sweep/sweep_measure.h", "gl/renderer.h"));
  assert_false(may_include("validation/sweep/sweep_measure.c", "cli/base/command.h"));
  assert_false(may_include("validation/tracer/tracer.c", "gl/plan/plan.h"));
  assert_false(may_include("gl/plan/plan.c", "validation/tracer/tracer.h"));
  assert_false(may_include("base/file.c", "colorimetry/image/image.h"));
  assert_false(may_include("colorimetry/image/exr.c", "scenes/scene.h"));
  assert_false(may_include("scenes/scene.c", "gl/plan/plan.h"));
  assert_false(may_include("gl/plan/plan.c", "cli/base/command.h"));
  assert_false(may_include("gl/plan/plan.c", "plan.h"));
  assert_false(may_include("main.c", "gl/plan/plan.h"));
}

static void test_include_lines_are_understood(void **state) {
  (void)state;
  char name[MAX_PATH];
  assert_true(included_name("#include \"gl/plan/plan.h\"\n", name, sizeof name));
  assert_string_equal(name, "gl/plan/plan.h");
  assert_true(included_name("  #  include  \"view.h\" /* near */\n", name, sizeof name));
  assert_string_equal(name, "view.h");
  assert_true(included_name("#include <gl/plan/plan.h>\n", name, sizeof name));
  assert_false(included_name("#include <math.h>\n", name, sizeof name));
  assert_false(included_name("#include <sys/stat.h>\n", name, sizeof name));
  assert_false(included_name("// include \"gl/plan/plan.h\"\n", name, sizeof name));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_sources_keep_the_directions),
                                     cmocka_unit_test(test_the_rule_refuses_wrong_directions),
                                     cmocka_unit_test(test_include_lines_are_understood)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
