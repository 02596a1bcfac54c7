#include "tests/house/graph.h"

#include "tests/house/lists.h"

void graph_free(graph *g) {
  for (size_t i = 0; i < g->count; i++) free(g->name[i]);
  for (size_t i = 0; i < g->edges; i++) free(g->edge[i].why);
  free(g->name);
  free(g->edge);
  *g = (graph){0};
}

static size_t node(graph *g, const char *name) {
  for (size_t i = 0; i < g->count; i++)
    if (strcmp(g->name[i], name) == 0) return i;
  g->name = grown(g->name, g->count, sizeof *g->name);
  g->name[g->count] = copy_of(name);
  return g->count++;
}

void graph_add(graph *g, const char *from, const char *to, const char *why) {
  size_t a = node(g, from), b = node(g, to);
  if (a == b) return;
  for (size_t i = 0; i < g->edges; i++)
    if (g->edge[i].from == a && g->edge[i].to == b) return;
  g->edge = grown(g->edge, g->edges, sizeof *g->edge);
  g->edge[g->edges++] = (graph_edge){a, b, copy_of(why)};
}

/* Tarjan's strongly connected components. */
typedef struct search {
  const graph *g;
  size_t *order, *low, *stack, *circle; /* order from 1; 0: not met */
  size_t met, height, circles;
} search;

static void go(search *s, size_t v) {
  s->order[v] = s->low[v] = ++s->met;
  s->stack[s->height++] = v;
  s->circle[v] = SIZE_MAX; /* on the stack */
  for (size_t i = 0; i < s->g->edges; i++) {
    if (s->g->edge[i].from != v) continue;
    size_t w = s->g->edge[i].to;
    if (s->order[w] == 0) go(s, w);
    if (s->circle[w] == SIZE_MAX && s->low[w] < s->low[v]) s->low[v] = s->low[w];
  }
  if (s->low[v] != s->order[v]) return;
  bool alone = s->stack[s->height - 1] == v;
  size_t number = alone ? 0 : ++s->circles, w;
  do {
    w = s->stack[--s->height];
    s->circle[w] = number;
  } while (w != v);
}

size_t graph_circles(const graph *g, size_t *circle) {
  FREED size_t *room = calloc(3 * g->count + 1, sizeof *room);
  assert_non_null(room);
  search s = FIELDS(.g = g, .order = room, .low = room + g->count, .stack = room + 2 * g->count,
                    .circle = circle);
  memset(circle, 0, g->count * sizeof *circle);
  for (size_t v = 0; v < g->count; v++)
    if (s.order[v] == 0) go(&s, v);
  return s.circles;
}

static bool is_among(const char *name, const char *const *list) {
  for (size_t i = 0; list[i] != NULL; i++)
    if (strcmp(list[i], name) == 0) return true;
  return false;
}

static void say_node(const graph *g, const size_t *circle, size_t v, const char *title) {
  print_error("%s: '%s' is in a circle:\n", title, g->name[v]);
  for (size_t i = 0; i < g->edges; i++) {
    const graph_edge *e = &g->edge[i];
    if (e->from == v && circle[e->to] == circle[v])
      print_error("    -> %s: %s\n", g->name[e->to], e->why);
  }
}

size_t graph_judge(const graph *g, const char *const *exceptions, const char *title) {
  FREED size_t *circle = calloc(g->count + 1, sizeof *circle);
  size_t wrong = 0;
  assert_non_null(circle);
  graph_circles(g, circle);
  for (size_t v = 0; v < g->count; v++) {
    if (circle[v] == 0 || is_among(g->name[v], exceptions)) continue;
    say_node(g, circle, v, title);
    wrong++;
  }
  for (size_t i = 0; exceptions[i] != NULL; i++) {
    bool needed = false;
    for (size_t v = 0; v < g->count; v++)
      needed = needed || (circle[v] > 0 && strcmp(g->name[v], exceptions[i]) == 0);
    if (needed) continue;
    print_error("%s: the exception '%s' is in no circle any more; take it out\n", title,
                exceptions[i]);
    wrong++;
  }
  return wrong;
}
