/* Nothing in the house leads back to where it came from: no circle of files by their includes, of
 * objects by the symbols that they define and want, of folders by both. */
#include "tests/check.h"
#include "tests/house/graph.h"
#include "tests/house/sources.h"
#include "tests/house/symbols.h"

/* Nothing is excepted. */
static const char *const none[] = {NULL};

static void add_folders(graph *folders, const char *from, const char *to, const char *what) {
  char a[SOURCES_MAX_PATH], b[SOURCES_MAX_PATH], why[3 * SOURCES_MAX_PATH];
  snprintf(why, sizeof why, "%s, of %s", what, from);
  graph_add(folders, sources_folder(from, a), sources_folder(to, b), why);
}

/* Shaders include each other by their names alone, each of which is there once. */
static const char *whole_path(const sources *all, const char *name) {
  if (strchr(name, '/') != NULL) return name;
  for (size_t i = 0; i < all->count; i++) {
    const char *slash = strrchr(all->file[i].path, '/');
    if (slash != NULL && strcmp(slash + 1, name) == 0) return all->file[i].path;
  }
  return name;
}

typedef struct graphs {
  graph objects, folders;
} graphs;

static void add_symbol(void *user, const char *from, const char *to, const char *name) {
  graphs *g = user;
  graph_add(&g->objects, from, to, name);
  add_folders(&g->folders, from, to, name);
}

TEST(the_house_has_no_circles) {
  graph files = {0};
  graphs g = {0};
  FILLED(sources, all, sources_read(&all));
  for (size_t i = 0; i < all.count; i++)
    for (size_t k = 0; k < all.file[i].include_count; k++) {
      const char *from = all.file[i].path, *to = whole_path(&all, all.file[i].include[k].name);
      graph_add(&files, from, to, "an include");
      add_folders(&g.folders, from, to, to);
    }
  FILLED(symbols, names, symbols_read(ABBE_NM, ABBE_OBJECT_LIST, &names));
  symbols_edges(&names, add_symbol, &g);
  size_t wrong = graph_judge(&files, none, "files by includes");
  wrong += graph_judge(&g.objects, none, "objects by symbols");
  wrong += graph_judge(&g.folders, none, "folders");
  assert_true(files.count > 500 && files.edges > 1500);
  assert_true(g.objects.count > 150 && g.objects.edges > 500);
  assert_true(g.folders.count > 30 && g.folders.edges > 100);
  graph_free(&files);
  graph_free(&g.objects);
  graph_free(&g.folders);
  assert_int_equal(wrong, 0);
}

/* ---- the judge, judged ---- */

typedef struct pair {
  const char *from, *to;
} pair;

static graph graph_of(const pair *pairs, size_t count) {
  graph g = {0};
  for (size_t i = 0; i < count; i++) graph_add(&g, pairs[i].from, pairs[i].to, "known");
  return g;
}
#define GRAPH(...) graph_of((pair[]){__VA_ARGS__}, sizeof((pair[]){__VA_ARGS__}) / sizeof(pair))

/* The names of the nodes in circles, each with its circle's number, as they were met. */
static const char *circles_of(graph g) {
  static char text[100];
  size_t circle[16], used = 0;
  assert_true(g.count <= 16);
  text[0] = '\0';
  graph_circles(&g, circle);
  for (size_t i = 0; i < g.count; i++)
    if (circle[i] > 0)
      used += (size_t)snprintf(text + used, sizeof text - used, "%s%zu", g.name[i], circle[i]);
  graph_free(&g);
  return text;
}

TEST(circles_are_found_and_only_they) {
  assert_string_equal(circles_of((graph){0}), "");
  assert_string_equal(circles_of(GRAPH({"a", "b"}, {"b", "c"}, {"a", "c"})), "");
  assert_string_equal(circles_of(GRAPH({"a", "a"}, {"a", "b"})), "");
  assert_string_equal(circles_of(GRAPH({"a", "b"}, {"b", "a"})), "a1b1");
  assert_string_equal(circles_of(GRAPH({"x", "a"}, {"a", "b"}, {"b", "c"}, {"c", "a"}, {"c", "y"})),
                      "a1b1c1");
  /* two circles that share a node are one; two of which one leads to the other are two */
  assert_string_equal(circles_of(GRAPH({"a", "b"}, {"b", "a"}, {"b", "c"}, {"c", "b"})), "a1b1c1");
  assert_string_equal(circles_of(GRAPH({"a", "b"}, {"b", "a"}, {"b", "c"}, {"c", "d"}, {"d", "c"})),
                      "a2b2c1d1");
  /* a diamond is none; closed at its far end it is one */
  assert_string_equal(circles_of(GRAPH({"a", "b"}, {"a", "c"}, {"b", "d"}, {"c", "d"})), "");
  assert_string_equal(circles_of(GRAPH({"a", "b"}, {"a", "c"}, {"b", "d"}, {"c", "d"}, {"d", "a"})),
                      "a1b1c1d1");
}

TEST(exceptions_are_few_and_needed) {
  OWNED(graph, g) = GRAPH({"a", "b"}, {"b", "a"}, {"b", "c"});
  assert_int_equal(graph_judge(&g, (const char *const[]){"a", "b", NULL}, "known"), 0);
  print_message("the next lines are of graphs made wrong on purpose\n");
  assert_int_equal(graph_judge(&g, none, "on purpose"), 2);
  assert_int_equal(graph_judge(&g, (const char *const[]){"a", NULL}, "on purpose"), 1);
  assert_int_equal(graph_judge(&g, (const char *const[]){"a", "b", "c", NULL}, "on purpose"), 1);
  assert_int_equal(graph_judge(&g, (const char *const[]){"a", "b", "gone", NULL}, "on purpose"), 1);
}
