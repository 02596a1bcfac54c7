/* Rooms use only what lies below them: the directions of CONVENTIONS.md, read from the includes of
 * the sources and from the symbols that the build's objects define and want. */
#include "tests/check.h"
#include "tests/house/sources.h"
#include "tests/house/symbols.h"

#include <sys/stat.h>

#define ALL "base spectral colorimetry scenes gl validation library cli tests"
static const struct {
  const char *room, *may;
} directions[] = {
    {"base", "base"},
    {"spectral", "base spectral"},
    {"colorimetry", "base spectral colorimetry"},
    {"scenes", "base spectral colorimetry scenes"},
    {"gl", "base spectral colorimetry scenes gl"},
    {"validation", "base spectral colorimetry scenes validation"},
    {"library", "base spectral colorimetry scenes gl validation library"},
    {"cli", "base spectral colorimetry scenes gl validation library cli"},
    {"tests", ALL},
};

/* C++ stays in the bridges. */
static const char *const bridges[] = {"cli/view/widgets/view_ui.cpp",
                                      "colorimetry/screen/lut_ocio.cpp",
                                      "colorimetry/image/display_ocio.cpp",
                                      "scenes/geometry/transform.cpp",
                                      "tests/colorimetry/image/exr_library.cpp",
                                      "tests/install/outside.cpp"};

static bool may_use(const char *file, const char *used) {
  const char *from = sources_room(file), *to = sources_room(used);
  bool allowed = false;
  for (size_t i = 0; i < sizeof directions / sizeof *directions; i++)
    if (strcmp(directions[i].room, from) == 0)
      allowed = allowed || sources_has_word(directions[i].may, to);
  return allowed;
}

static bool is_cpp(const char *path) {
  return sources_has_word("cpp cc cxx hpp hh C", sources_ending(path));
}

static bool is_c(const char *path) {
  return sources_has_word("c h", sources_ending(path)) || is_cpp(path);
}

static bool is_bridge(const char *path) {
  for (size_t i = 0; i < sizeof bridges / sizeof *bridges; i++)
    if (strcmp(path, bridges[i]) == 0) return true;
  return false;
}

/* ---- includes ---- */

static size_t judge_file(const source_file *f) {
  size_t wrong = 0;
  if (sources_room(f->path)[0] == '\0') wrong++, print_error("%s: is in no room\n", f->path);
  if (is_cpp(f->path) && !is_bridge(f->path))
    wrong++, print_error("%s: is C++ and no bridge\n", f->path);
  for (size_t i = 0; i < f->include_count; i++) {
    const source_include *n = &f->include[i];
    char full[2 * SOURCES_MAX_PATH];
    struct stat status;
    snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", n->name);
    if (!may_use(f->path, n->name))
      wrong++, print_error("%s:%d: may not include \"%s\"\n", f->path, n->line, n->name);
    if (stat(full, &status) != 0)
      wrong++, print_error("%s:%d: \"%s\" is not there; includes are written from the root\n",
                           f->path, n->line, n->name);
  }
  return wrong;
}

TEST(the_sources_keep_the_directions) {
  size_t wrong = 0, files = 0, includes = 0;
  FILLED(sources, all, sources_read(&all));
  for (size_t i = 0; i < all.count; i++) {
    if (!is_c(all.file[i].path)) continue;
    files++;
    includes += all.file[i].include_count;
    wrong += judge_file(&all.file[i]);
  }
  assert_int_equal(wrong, 0);
  /* The house was read and not an empty folder. */
  assert_true(files > 100);
  assert_true(includes > 3 * files / 2);
}

TEST(the_rule_refuses_wrong_directions) {
  assert_true(may_use("gl/plan/plan.c", "scenes/scene.h"));
  assert_true(may_use("scenes/scene.c", "colorimetry/image/image.h"));
  assert_true(may_use("cli/render/render.c", "validation/trace/tracer/tracer.h"));
  assert_false(may_use("validation/trace/tracer/tracer.c", "library/choice/picture_choice.h"));
  assert_false(may_use("validation/trace/tracer/tracer.c", "gl/plan/plan.h"));
  assert_false(may_use("gl/plan/plan.c", "validation/trace/tracer/tracer.h"));
  assert_false(may_use("base/file.c", "colorimetry/image/image.h"));
  assert_false(may_use("base/file.c", "spectral/optics.h"));
  assert_false(may_use("colorimetry/image/exr.c", "scenes/scene.h"));
  assert_false(may_use("scenes/scene.c", "gl/plan/plan.h"));
  assert_false(may_use("gl/plan/plan.c", "cli/base/command.h"));
  assert_false(may_use("gl/plan/plan.c", "plan.h"));
  assert_false(may_use("main.c", "gl/plan/plan.h"));
  assert_true(may_use("library/lib_scene.c", "gl/renderer.h"));
  assert_false(may_use("library/lib_scene.c", "cli/base/command.h"));
  assert_true(may_use("cli/render/render.c", "library/lib_scene.h"));
}

/* ---- headers that stay inside ---- */

/* The folder that a header's first comment says it is internal to; false: it says nothing. */
static bool read_inside(const char *path, char folder[SOURCES_MAX_PATH]) {
  char full[2 * SOURCES_MAX_PATH], text[4096];
  size_t used = 0;
  int c = EOF, before = EOF;
  snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", path);
  FILE *file = fopen(full, "r");
  assert_non_null(file);
  while (used + 1 < sizeof text && (c = fgetc(file)) != EOF && !(before == '*' && c == '/')) {
    before = c;
    if (c == '*' || c == '\n') c = ' ';
    if (c != ' ' || (used > 0 && text[used - 1] != ' ')) text[used++] = (char)c;
  }
  fclose(file);
  text[used] = '\0';
  const char *at = strstr(text, "Internal to ");
  if (at == NULL || sscanf(at, "Internal to %1023[^.:, ]", folder) != 1) return false;
  assert_true(folder[strlen(folder) - 1] == '/');
  return true;
}

/* What is wrong with the header's word about who may include it. */
static size_t judge_header(const sources *all, const char *header) {
  char folder[SOURCES_MAX_PATH] = "";
  const bool inside = read_inside(header, folder);
  size_t wrong = 0, others = 0;
  for (size_t i = 0; i < all->count; i++) {
    const source_file *f = &all->file[i];
    if (strcmp(sources_room(f->path), "tests") == 0) continue;
    for (size_t k = 0; k < f->include_count; k++) {
      if (strcmp(f->include[k].name, header) != 0) continue;
      others += strcmp(sources_room(f->path), sources_room(header)) != 0;
      if (!inside || strncmp(f->path, folder, strlen(folder)) == 0) continue;
      wrong++;
      print_error("%s: includes %s, which is internal to %s\n", f->path, header, folder);
    }
  }
  if (inside || others > 0 || strcmp(sources_room(header), "library") == 0) return wrong;
  print_error("%s: no other room includes it; it has to say which folder it is internal to\n",
              header);
  return wrong + 1;
}

TEST(headers_stay_inside) {
  size_t wrong = 0, headers = 0;
  FILLED(sources, all, sources_read(&all));
  for (size_t i = 0; i < all.count; i++) {
    const char *path = all.file[i].path;
    if (strcmp(sources_ending(path), "h") != 0 || strcmp(sources_room(path), "tests") == 0)
      continue;
    headers++;
    wrong += judge_header(&all, path);
  }
  assert_int_equal(wrong, 0);
  assert_true(headers > 200);
}

TEST(include_lines_are_understood) {
  char name[SOURCES_MAX_PATH];
  assert_true(sources_included_name("#include \"gl/plan/plan.h\"\n", name, sizeof name));
  assert_string_equal(name, "gl/plan/plan.h");
  assert_true(sources_included_name("  #  include  \"view.h\" /* near */\n", name, sizeof name));
  assert_string_equal(name, "view.h");
  assert_true(sources_included_name("#include <gl/plan/plan.h>\n", name, sizeof name));
  assert_false(sources_included_name("#include <math.h>\n", name, sizeof name));
  assert_false(sources_included_name("#include <sys/stat.h>\n", name, sizeof name));
  assert_false(sources_included_name("// include \"gl/plan/plan.h\"\n", name, sizeof name));
}

/* ---- symbols ---- */

typedef struct tally {
  size_t edges, wrong;
} tally;

static void judge_edge(void *user, const char *from, const char *to, const char *name) {
  tally *t = user;
  t->edges++;
  if (may_use(from, to)) return;
  t->wrong++;
  print_error("%s may not use %s of %s\n", from, name, to);
}

TEST(the_objects_keep_the_directions) {
  tally t = {0};
  FILLED(symbols, all, symbols_read(ABBE_NM, ABBE_OBJECT_LIST, &all));
  symbols_edges(&all, judge_edge, &t);
  assert_int_equal(t.wrong, 0);
  assert_true(t.edges > 1000);
}

TEST(lines_of_nm_are_understood) {
  symbol s = {0};
  char source[SOURCES_MAX_PATH];
  assert_true(symbols_source("/b/gl/CMakeFiles/abbe_gl.dir/plan/plan.c.o", source, sizeof source));
  assert_string_equal(source, "gl/plan/plan.c");
  assert_true(symbols_source("/b/gl/CMakeFiles/abbe_gl.dir/./a.c.o", source, sizeof source));
  assert_string_equal(source, "gl/a.c");
  assert_true(symbols_source("cli/CMakeFiles/abbe.dir/main.c.o", source, sizeof source));
  assert_string_equal(source, "cli/main.c");
  assert_false(symbols_source("/b/other/CMakeFiles/x.dir/x.c.o", source, sizeof source));
  assert_false(symbols_source("/b/gl/plan.c.o", source, sizeof source));
  assert_true(symbols_line("base/CMakeFiles/abbe_base.dir/file.c.o: abbe_file_read T 0 10\n", &s));
  assert_string_equal(s.source, "base/file.c");
  assert_string_equal(s.name, "abbe_file_read");
  assert_true(s.defined);
  free(s.source), free(s.name);
  assert_true(symbols_line("base/CMakeFiles/abbe_base.dir/file.c.o: malloc U         \n", &s));
  assert_false(s.defined);
  free(s.source), free(s.name);
  assert_false(symbols_line("base/CMakeFiles/abbe_base.dir/file.c.o: hidden t 0 10\n", &s));
  assert_false(symbols_line("base/CMakeFiles/abbe_base.dir/file.c.o: _ZN1aE T 0 10\n", &s));
}

static void count_edge(void *user, const char *from, const char *to, const char *name) {
  assert_string_equal(from, "gl/a.c");
  assert_string_equal(to, "gl/b.c");
  assert_string_equal(name, "of_b");
  ++*(size_t *)user;
}

TEST(who_wants_what_is_defined_is_found) {
  symbol list[] = {{"gl/a.c", "of_b", false},
                   {"gl/b.c", "of_b", true},
                   {"gl/b.c", "malloc", false},
                   {"gl/a.c", "malloc", false},
                   {"gl/a.c", "of_a", true}};
  size_t edges = 0;
  symbols_edges(&(symbols){sizeof list / sizeof *list, list}, count_edge, &edges);
  assert_int_equal(edges, 1);
}
