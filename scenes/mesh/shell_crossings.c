/* Faces of shells that go through one another, or lie on one another. */
#include "base/maths.h"
#include "base/thread/watch.h"
#include "scenes/mesh/bvh.h"
#include "scenes/mesh/shell_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double height_over(const double triangle[9], const double n[3], const double p[3]) {
  double from[3];
  abbe_vector_subtract(p, triangle, from);
  return abbe_vector_dot(from, n);
}

/* Whether an edge of a goes through b, from more than the tolerance on one side to as much on the
 * other; where. */
static bool edge_goes_through(const double a[9], const double b[9], double tolerance,
                              double place[3]) {
  double n[3], height[3];
  abbe_vector_triangle(b, b + 3, b + 6, n);
  if (!abbe_vector_normalise(n)) return false;
  for (int k = 0; k < 3; k++) height[k] = height_over(b, n, a + 3 * k);
  for (int k = 0; k < 3; k++) {
    const int next = (k + 1) % 3;
    const double low = fmin(height[k], height[next]), high = fmax(height[k], height[next]);
    if (!(low < -tolerance && high > tolerance)) continue;
    abbe_bvh_hit hit;
    double d[3];
    abbe_vector_subtract(a + 3 * next, a + 3 * k, d);
    if (!abbe_bvh_meet(b, a + 3 * k, d, 0, 0, 1, &hit)) continue;
    for (int i = 0; i < 3; i++) place[i] = a[3 * k + i] + hit.t * d[i];
    return true;
  }
  return false;
}

static bool share_a_point(const uint32_t a[3], const uint32_t b[3]) {
  for (int i = 0; i < 9; i++)
    if (a[i / 3] == b[i % 3]) return true;
  return false;
}

static int by_pair(const void *a, const void *b) {
  const uint32_t *x = a, *y = b;
  if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
  return (x[1] > y[1]) - (x[1] < y[1]);
}

void abbe_shell_sort_crossings(abbe_shells *out) {
  size_t kept = 0;
  if (out->crossing_count > 0)
    qsort(out->crossing, out->crossing_count, sizeof *out->crossing, by_pair);
  for (size_t i = 0; i < out->crossing_count; i++)
    if (i == 0 || by_pair(out->crossing[i], out->crossing[i - 1]) != 0)
      memmove(out->crossing[kept++], out->crossing[i], sizeof *out->crossing);
  out->crossing_count = kept;
}

/* Doubles the room unless a quarter of it is free. */
static bool crossings_have_room(abbe_shell_search *s) {
  abbe_shells *out = s->out;
  if (out->crossing_count < s->room - s->room / 4) return true;
  const size_t room = s->room > 0 ? 2 * s->room : 64;
  void *more = realloc(out->crossing, room * sizeof *out->crossing);
  s->no_memory = s->no_memory || !more;
  if (!more) return false;
  out->crossing = more;
  s->room = room;
  return true;
}

static void add_crossing(abbe_shell_search *s, uint32_t a, uint32_t b, const double place[3]) {
  abbe_shells *out = s->out;
  if (a == b) {
    if (out->self_count++ == 0) memcpy(out->self_place, place, sizeof out->self_place);
    return;
  }
  if (out->crossing_count == 0) memcpy(out->place, place, sizeof out->place);
  if (out->crossing_count == s->room) {
    abbe_shell_sort_crossings(out);
    if (!crossings_have_room(s)) return;
  }
  uint32_t *pair = out->crossing[out->crossing_count++];
  pair[0] = a < b ? a : b;
  pair[1] = a < b ? b : a;
}

/* Whether b lies in a's plane and over a abbe_shell_part of it, not just beside it. */
static bool lie_on_one_another(const double a[9], const double b[9], double tolerance) {
  double n[3];
  abbe_vector_triangle(a, a + 3, a + 6, n);
  if (!abbe_vector_normalise(n)) return false;
  for (int k = 0; k < 3; k++)
    if (fabs(height_over(a, n, b + 3 * k)) > tolerance) return false;
  for (int side = 0; side < 6; side++) {
    const double *of = side < 3 ? a : b;
    double along[3], across[3], low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    abbe_vector_subtract(of + 3 * ((side + 1) % 3), of + 3 * (side % 3), along);
    abbe_vector_cross(n, along, across);
    if (!abbe_vector_normalise(across)) return false;
    for (int k = 0; k < 6; k++) {
      const double at = height_over(a, across, k < 3 ? a + 3 * k : b + 3 * (k - 3));
      low[k / 3] = fmin(low[k / 3], at);
      high[k / 3] = fmax(high[k / 3], at);
    }
    if (low[0] > high[1] - tolerance || low[1] > high[0] - tolerance) return false;
  }
  return true;
}

static void meet_faces(abbe_shell_search *s, uint32_t f, uint32_t g) {
  double place[3];
  if (s->t->shell[f] != s->t->shell[g] &&
      (lie_on_one_another(s->triangle[f], s->triangle[g], s->tolerance) ||
       lie_on_one_another(s->triangle[g], s->triangle[f], s->tolerance))) {
    s->out->flush_count++;
    for (int k = 0; k < 3; k++) place[k] = s->triangle[f][k];
    add_crossing(s, s->t->shell[f], s->t->shell[g], place);
    return;
  }
  if (share_a_point(s->t->face[f], s->t->face[g])) return;
  if (edge_goes_through(s->triangle[f], s->triangle[g], s->tolerance, place) ||
      edge_goes_through(s->triangle[g], s->triangle[f], s->tolerance, place))
    add_crossing(s, s->t->shell[f], s->t->shell[g], place);
}

enum { WORK_OF_A_PAIR = 4, ASKED = 1 << 14 };

/* Whether faces of the shells, NONE where there are several, may be such that are looked for. */
static bool are_looked_for(const abbe_shell_search *s, uint32_t a, uint32_t b) {
  return a == ABBE_TOPOLOGY_NONE || b == ABBE_TOPOLOGY_NONE || (a == b) == s->within;
}

static void meet_leaves(abbe_shell_search *s, const abbe_shell_tree *t, abbe_shell_part a,
                        abbe_shell_part b) {
  for (size_t i = a.first; i < a.last; i++)
    for (size_t k = a.node == b.node ? i + 1 : b.first; k < b.last; k++)
      if (are_looked_for(s, s->t->shell[t->face[i]], s->t->shell[t->face[k]]) &&
          abbe_shell_boxes_meet(&t->of_face[t->face[i]], &t->of_face[t->face[k]])) {
        s->work += WORK_OF_A_PAIR;
        meet_faces(s, t->face[i], t->face[k]);
      }
}

/* All pairs of faces of a and b whose boxes meet. */
static void meet_parts(abbe_shell_search *s, const abbe_shell_tree *t, abbe_shell_part a,
                       abbe_shell_part b) {
  const size_t faces_a = a.last - a.first, faces_b = b.last - b.first;
  if (++s->work % ASKED == 0 && !abbe_watch_goes_on()) s->work = s->most_work;
  if (abbe_shell_search_gives_up(s) || !are_looked_for(s, t->shell[a.node], t->shell[b.node]) ||
      !abbe_shell_boxes_meet(&t->node[a.node], &t->node[b.node]))
    return;
  if (faces_a <= ABBE_SHELL_LEAF && faces_b <= ABBE_SHELL_LEAF) {
    meet_leaves(s, t, a, b);
  } else if (a.node == b.node) {
    meet_parts(s, t, abbe_shell_part_child(a, 0), abbe_shell_part_child(a, 0));
    meet_parts(s, t, abbe_shell_part_child(a, 1), abbe_shell_part_child(a, 1));
    meet_parts(s, t, abbe_shell_part_child(a, 0), abbe_shell_part_child(a, 1));
  } else if (faces_a > faces_b) {
    meet_parts(s, t, abbe_shell_part_child(a, 0), b);
    meet_parts(s, t, abbe_shell_part_child(a, 1), b);
  } else {
    meet_parts(s, t, a, abbe_shell_part_child(b, 0));
    meet_parts(s, t, a, abbe_shell_part_child(b, 1));
  }
}

void abbe_shell_find_crossings(abbe_shell_search *s, const abbe_shell_tree *t, bool within) {
  const abbe_shell_part all = {0, 0, s->t->face_count};
  s->work = 0;
  s->within = within;
  meet_parts(s, t, all, all);
}

bool abbe_shells_cross(const abbe_shells *shells, uint32_t a, uint32_t b) {
  const uint32_t pair[2] = {a < b ? a : b, a < b ? b : a};
  return shells->crossing_count > 0 &&
         bsearch(pair, shells->crossing, shells->crossing_count, sizeof pair, by_pair) != NULL;
}
