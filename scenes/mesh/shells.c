#include "scenes/mesh/shells.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "scenes/mesh/bvh.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define TOUCHES 1e-6 /* share of the diagonal of the bounds */
#define UNPLACED UINT32_MAX

void abbe_shells_free(abbe_shells *shells) {
  if (!shells) return;
  free(shells->shell);
  free(shells->around);
  free(shells->crossing);
  memset(shells, 0, sizeof *shells);
}

/* ---- solids ---- */

typedef struct ranked {
  double volume;
  uint32_t shell;
} ranked;

static int by_volume(const void *a, const void *b) {
  const ranked *x = a, *y = b;
  if (x->volume != y->volume) return x->volume > y->volume ? -1 : 1;
  return (x->shell > y->shell) - (x->shell < y->shell);
}

/* What shells are shared out by. */
typedef struct sharing {
  ranked *rank;
  uint32_t *first, *other; /* whom each shell crosses: from first[i] to first[i + 1] */
  uint32_t *barred;        /* for each solid: the last shell, from 1, that may not join it */
  uint32_t *around;        /* for each solid: its shells around the current one */
} sharing;

static void sharing_free(sharing *h) {
  free(h->rank);
  free(h->first);
  free(h->other);
  free(h->barred);
  free(h->around);
}

static bool sharing_make(const abbe_shells *s, sharing *h) {
  *h = (sharing){.rank = malloc((s->count + 1) * sizeof *h->rank),
                 .first = calloc(s->count + 2, sizeof *h->first),
                 .other = malloc((2 * s->crossing_count + 1) * sizeof *h->other),
                 .barred = calloc(s->count + 1, sizeof *h->barred),
                 .around = calloc(s->count + 1, sizeof *h->around)};
  if (!(h->rank && h->first && h->other && h->barred && h->around)) return false;
  for (uint32_t i = 0; i < s->count; i++) h->rank[i] = (ranked){fabs(s->shell[i].volume), i};
  qsort(h->rank, s->count, sizeof *h->rank, by_volume);
  for (size_t i = 0; i < 2 * s->crossing_count; i++) h->first[s->crossing[i / 2][i % 2] + 2]++;
  for (size_t i = 2; i < s->count + 2; i++) h->first[i] += h->first[i - 1];
  for (size_t i = 0; i < 2 * s->crossing_count; i++)
    h->other[h->first[s->crossing[i / 2][i % 2] + 1]++] = s->crossing[i / 2][1 - i % 2];
  return true;
}

/* The first solid that the shell may join, of shells that are placed already, all larger; or a new
 * one. */
static uint32_t solid_for(const abbe_shells *s, const sharing *h, uint32_t shell) {
  const abbe_shell *self = &s->shell[shell];
  uint32_t solid = 0;
  for (uint32_t i = h->first[shell]; i < h->first[shell + 1]; i++) {
    const uint32_t of = s->shell[h->other[i]].solid;
    if (of != UNPLACED) h->barred[of] = shell + 1;
  }
  for (uint32_t i = self->first; i < self->last; i++) {
    const uint32_t of = s->shell[s->around[i]].solid;
    if (of != UNPLACED) h->around[of]++;
  }
  while (solid < s->solid_count &&
         (h->barred[solid] == shell + 1 || h->around[solid] % 2 != self->depth % 2))
    solid++;
  for (uint32_t i = self->first; i < self->last; i++) {
    const uint32_t of = s->shell[s->around[i]].solid;
    if (of != UNPLACED) h->around[of] = 0;
  }
  return solid;
}

static abbe_result share_out(abbe_shells *s, abbe_error *error) {
  sharing h;
  s->solid_count = 1;
  if (s->crossing_count == 0) return ABBE_OK;
  abbe_result result = ABBE_OK;
  if (!sharing_make(s, &h))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  for (size_t i = 0; i < s->count; i++) s->shell[i].solid = UNPLACED;
  for (size_t k = 0; k < s->count && result == ABBE_OK; k++) {
    const uint32_t shell = h.rank[k].shell, solid = solid_for(s, &h, shell);
    if (solid == s->solid_count && s->shell[shell].depth % 2 != 0)
      result = abbe_error_set(error, ABBE_GEOMETRY,
                              "hollows of the mesh cross one another or what is around them, at "
                              "(%g, %g, %g) for one; unite them in a modeller",
                              s->place[0], s->place[1], s->place[2]);
    s->shell[shell].solid = solid;
    if (solid == s->solid_count) s->solid_count++;
  }
  sharing_free(&h);
  return result;
}

/* ---- all of it ---- */

/* Shells that all cross or nest take the square of their number. What is done for them is counted,
 * in steps through the tree, and ends after seconds. */
#define MOST_WORK ((uint64_t)1 << 27)
#define MOST_WORK_A_FACE 1024u

static void measure(abbe_shell_search *s) {
  const abbe_topology *t = s->t;
  for (size_t f = 0; f < t->face_count; f++) {
    double n[3], from[3];
    const double *a = s->triangle[f];
    abbe_vector_triangle(a, a + 3, a + 6, n);
    abbe_vector_subtract(a, s->triangle[0], from);
    s->out->shell[t->shell[f]].volume += abbe_vector_dot(from, n) / 6;
  }
}

static abbe_result prepare(abbe_shell_search *s, const abbe_mesh *mesh, abbe_error *error) {
  s->out->shell = calloc(s->out->count + 1, sizeof *s->out->shell);
  s->triangle = abbe_bvh_triangles(mesh);
  if (!s->out->shell || !s->triangle)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  double low[3], high[3], size[3];
  memcpy(low, s->triangle[0], sizeof low);
  memcpy(high, low, sizeof high);
  for (size_t i = 0; i < 3 * s->t->face_count; i++)
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], s->triangle[i / 3][3 * (i % 3) + (size_t)k]);
      high[k] = fmax(high[k], s->triangle[i / 3][3 * (i % 3) + (size_t)k]);
    }
  abbe_vector_subtract(high, low, size);
  s->tolerance = TOUCHES * abbe_vector_length(size);
  measure(s);
  return ABBE_OK;
}

static abbe_result find_lie(abbe_shell_search *s, abbe_error *error) {
  abbe_shell_tree t;
  bool room = abbe_shell_tree_make(s, &t);
  s->most_work = MOST_WORK + MOST_WORK_A_FACE * (uint64_t)s->t->face_count;
  /* a surface too intricate to be searched for crossings of its own is taken to have none more */
  if (room && abbe_watch_goes_on()) abbe_shell_find_crossings(s, &t, true);
  if (room && s->out->count > 1 && abbe_watch_goes_on()) {
    abbe_shell_find_crossings(s, &t, false);
    abbe_shell_sort_crossings(s->out);
    if (!abbe_shell_search_gives_up(s)) room = abbe_shell_find_nesting(s, &t);
  }
  abbe_shell_tree_free(&t);
  const abbe_result wanted = abbe_watch_check(error);
  if (wanted != ABBE_OK) return wanted;
  if (!room || s->no_memory)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  if (s->out->count > 1 && abbe_shell_search_gives_up(s))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %zu parts of the mesh, of %zu faces, lie in and through one another "
                          "in too many places to be told apart; unite them in a modeller",
                          s->out->count, s->t->face_count);
  return ABBE_OK;
}

abbe_result abbe_shells_find(const abbe_mesh *mesh, const abbe_topology *topology, abbe_shells *out,
                             abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (topology->face_count == 0) return ABBE_OK;
  out->count = topology->shell_count;
  abbe_shell_search s = {.t = topology, .out = out};
  abbe_result result = prepare(&s, mesh, error);
  if (result == ABBE_OK) result = find_lie(&s, error);
  if (result == ABBE_OK) result = share_out(out, error);
  free(s.triangle);
  if (result != ABBE_OK) abbe_shells_free(out);
  return result;
}
