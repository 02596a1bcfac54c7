/* graph.h: who leads to whom, and where that goes round in a circle. */
#ifndef ABBE_TESTS_HOUSE_GRAPH_H
#define ABBE_TESTS_HOUSE_GRAPH_H

#include <stddef.h>

typedef struct graph_edge {
  size_t from, to;
  char *why; /* the first reason */
} graph_edge;

/* Zero-initialise. */
typedef struct graph {
  size_t count, edges;
  char **name;      /* [count] */
  graph_edge *edge; /* [edges], each pair once */
} graph;

void graph_free(graph *g);
/* from leads to to; both are known from now on. An edge to itself is none. */
void graph_add(graph *g, const char *from, const char *to, const char *why);
/* Into circle[g->count] the number, from 1, of the circle (strongly connected nodes) that each node
 * is in, or 0; returns how many there are. */
size_t graph_circles(const graph *g, size_t *circle);
/* How much is wrong: each node in a circle that is not among the exceptions (NULL ends them), with
 * its edges inside it, and each exception that is in none. Prints them under the title. */
size_t graph_judge(const graph *g, const char *const *exceptions, const char *title);

#endif
