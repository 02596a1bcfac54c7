/* The tree of boxes over the faces of shells. */
#include "scenes/mesh/shell_search.h"

#include "base/thread/watch.h"

#include <math.h>
#include <stdlib.h>

static void widen(abbe_shell_box *b, const abbe_shell_box *by) {
  for (int k = 0; k < 3; k++) {
    if (by->low[k] < b->low[k]) b->low[k] = by->low[k];
    if (by->high[k] > b->high[k]) b->high[k] = by->high[k];
  }
}

static double middle_along(const abbe_shell_box *b, int axis) {
  return b->low[axis] + b->high[axis];
}

/* Puts the lesser half along the axis first (quickselect). */
static void halve(const abbe_shell_tree *t, size_t first, size_t last, size_t half, int axis) {
  while (last - first > 1) {
    const double pivot = middle_along(&t->of_face[t->face[first + (last - first) / 2]], axis);
    size_t i = first, k = last - 1;
    for (;;) {
      while (middle_along(&t->of_face[t->face[i]], axis) < pivot) i++;
      while (middle_along(&t->of_face[t->face[k]], axis) > pivot) k--;
      if (i >= k) break;
      const uint32_t other = t->face[i];
      t->face[i++] = t->face[k];
      t->face[k--] = other;
    }
    /* all before i are at most the pivot, all from i on at least */
    if (half < i)
      last = i;
    else if (half > k)
      first = k + 1;
    else
      return;
  }
}

/* shell: of each face */
enum { ASKED = 4096 }; /* over so many faces it is asked whether they are wanted */

static void grow(abbe_shell_tree *t, const uint32_t *shell, size_t node, size_t first,
                 size_t last) {
  abbe_shell_box *b = &t->node[node];
  if (last - first >= ASKED && !abbe_watch_goes_on()) return;
  *b = t->of_face[t->face[first]];
  t->shell[node] = shell[t->face[first]];
  for (size_t i = first + 1; i < last; i++) {
    widen(b, &t->of_face[t->face[i]]);
    if (shell[t->face[i]] != t->shell[node]) t->shell[node] = ABBE_TOPOLOGY_NONE;
  }
  if (last - first <= ABBE_SHELL_LEAF) return;
  int axis = 0;
  for (int k = 1; k < 3; k++)
    if (b->high[k] - b->low[k] > b->high[axis] - b->low[axis]) axis = k;
  const size_t half = (first + last) / 2;
  halve(t, first, last, half, axis);
  grow(t, shell, 2 * node + 1, first, half);
  grow(t, shell, 2 * node + 2, half, last);
}

void abbe_shell_tree_free(abbe_shell_tree *t) {
  free(t->face);
  free(t->of_face);
  free(t->node);
  free(t->shell);
}

bool abbe_shell_tree_make(const abbe_shell_search *s, abbe_shell_tree *t) {
  const size_t faces = s->t->face_count;
  size_t nodes = 1;
  for (size_t over = faces; over > ABBE_SHELL_LEAF; over = (over + 1) / 2) nodes = 2 * nodes + 1;
  *t = (abbe_shell_tree){.face = malloc((faces + 1) * sizeof *t->face),
                         .of_face = malloc((faces + 1) * sizeof *t->of_face),
                         .node = malloc(nodes * sizeof *t->node),
                         .shell = malloc(nodes * sizeof *t->shell)};
  if (!t->face || !t->of_face || !t->node || !t->shell) return false;
  for (size_t f = 0; f < faces; f++) {
    const double *at = s->triangle[f];
    abbe_shell_box *b = &t->of_face[f];
    t->face[f] = (uint32_t)f;
    for (int k = 0; k < 3; k++) {
      b->low[k] = fmin(fmin(at[k], at[3 + k]), at[6 + k]) - s->tolerance;
      b->high[k] = fmax(fmax(at[k], at[3 + k]), at[6 + k]) + s->tolerance;
    }
  }
  grow(t, s->t->shell, 0, 0, faces);
  return true;
}
