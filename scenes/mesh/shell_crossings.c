/* Faces of shells that go through one another, or lie on one another. */
#include "base/maths.h"

#include "base/thread/watch.h"
#include "scenes/mesh/bvh.h"
#include "scenes/mesh/shells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Which shells lie in which: points of each vote, along rays. */

enum { FACES = 5, DIRECTIONS = 3 }; /* that vote, of which some may be where shells touch */

/* Shells that a ray meets, each with its first face there. */
typedef struct meetings {
  uint32_t *shell;
  size_t count;
  double *nearest; /* distance of every shell; infinity: not met */
  bool *leaves;    /* there the face shows its back */
} meetings;

static bool ray_enters(const abbe_shell_box *b, const double p[3], const double inverse[3]) {
  double from = 0, to = INFINITY;
  for (int k = 0; k < 3; k++) {
    const double low = (b->low[k] - p[k]) * inverse[k], high = (b->high[k] - p[k]) * inverse[k];
    from = fmax(from, fmin(low, high));
    to = fmin(to, fmax(low, high));
  }
  return from <= to;
}

static void meet_face_on_ray(const abbe_shell_search *s, uint32_t face, const double p[3],
                             const double d[3], meetings *met) {
  const double *a = s->triangle[face];
  const uint32_t shell = s->t->shell[face];
  abbe_bvh_hit hit;
  double n[3];
  if (!abbe_bvh_meet(a, p, d, 0, 0, met->nearest[shell], &hit)) return;
  if (isinf(met->nearest[shell])) met->shell[met->count++] = shell;
  met->nearest[shell] = hit.t;
  abbe_vector_triangle(a, a + 3, a + 6, n);
  met->leaves[shell] = abbe_vector_dot(n, d) > 0;
}

/* d has no zero among its components. */
static void follow(abbe_shell_search *s, const abbe_shell_tree *t, abbe_shell_part at,
                   const double p[3], const double d[3], const double inverse[3], meetings *met) {
  s->work++;
  if (abbe_shell_search_gives_up(s) || !ray_enters(&t->node[at.node], p, inverse)) return;
  if (at.last - at.first <= ABBE_SHELL_LEAF) {
    s->work += at.last - at.first;
    for (size_t i = at.first; i < at.last; i++) meet_face_on_ray(s, t->face[i], p, d, met);
  } else {
    for (int i = 0; i < 2; i++) follow(s, t, abbe_shell_part_child(at, i), p, d, inverse, met);
  }
}

/* Adds a vote for each other shell that the point lies in: along the ray the first face of a shell
 * shows by its side whether it does. */
static void vote(abbe_shell_search *s, const abbe_shell_tree *t, uint32_t self, const double p[3],
                 const double d[3], meetings *met, unsigned char *votes) {
  const abbe_shell_part all = {0, 0, s->t->face_count};
  const double inverse[3] = {1 / d[0], 1 / d[1], 1 / d[2]};
  met->count = 0;
  follow(s, t, all, p, d, inverse, met);
  for (size_t i = 0; i < met->count; i++) {
    const uint32_t other = met->shell[i];
    met->nearest[other] = INFINITY;
    if (other != self && met->leaves[other] == (s->out->shell[other].volume > 0)) votes[other]++;
  }
}

static void middle_of(const double triangle[9], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = (triangle[k] + triangle[3 + k] + triangle[6 + k]) / 3;
}

/* Faces of each shell, one after another: those of shell i from first[i] to first[i + 1]. */
static void sort_faces(const abbe_topology *t, uint32_t *first, uint32_t *face) {
  memset(first, 0, (t->shell_count + 1) * sizeof *first);
  for (size_t f = 0; f < t->face_count; f++) first[t->shell[f] + 1]++;
  for (size_t i = 0; i < t->shell_count; i++) first[i + 1] += first[i];
  for (size_t f = 0; f < t->face_count; f++) face[first[t->shell[f]]++] = (uint32_t)f;
  memmove(first + 1, first, t->shell_count * sizeof *first);
  first[0] = 0;
}

static int by_pair(const void *a, const void *b) {
  const uint32_t *x = a, *y = b;
  if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
  return (x[1] > y[1]) - (x[1] < y[1]);
}

/* Whether the shells do; of crossings in order. */
static bool shells_cross(const abbe_shells *shells, uint32_t a, uint32_t b) {
  const uint32_t pair[2] = {a < b ? a : b, a < b ? b : a};
  return shells->crossing_count > 0 &&
         bsearch(pair, shells->crossing, shells->crossing_count, sizeof pair, by_pair) != NULL;
}

static bool add_around(abbe_shells *out, uint32_t shell, const unsigned char *votes, size_t *used,
                       size_t *room) {
  abbe_shell *self = &out->shell[shell];
  self->first = (uint32_t)*used;
  for (size_t i = 0; i < out->count; i++) {
    if (2 * votes[i] <= FACES * DIRECTIONS || shells_cross(out, shell, (uint32_t)i)) continue;
    if (*used == *room) {
      const size_t more = *room > 0 ? 2 * *room : 64;
      void *larger = realloc(out->around, more * sizeof *out->around);
      if (!larger) return false;
      out->around = larger;
      *room = more;
    }
    out->around[(*used)++] = (uint32_t)i;
  }
  self->last = (uint32_t)*used;
  self->depth = self->last - self->first;
  return true;
}

bool abbe_shell_find_nesting(abbe_shell_search *s, const abbe_shell_tree *t) {
  static const double direction[DIRECTIONS][3] = {
      {0.5391, 0.7283, 0.4231}, {-0.8127, 0.3119, 0.4921}, {0.2713, -0.5881, -0.7619}};
  abbe_shells *out = s->out;
  const size_t count = out->count, faces = s->t->face_count;
  uint32_t *first = calloc(count + 2, sizeof *first), *face = calloc(faces + 1, sizeof *face);
  meetings met = {.shell = malloc((count + 1) * sizeof *met.shell),
                  .nearest = malloc((count + 1) * sizeof *met.nearest),
                  .leaves = malloc((count + 1) * sizeof *met.leaves)};
  unsigned char *votes = calloc(count + 1, 1);
  bool done = first && face && met.shell && met.nearest && met.leaves && votes;
  size_t used = 0, room = 0;
  for (size_t i = 0; done && i < count; i++) met.nearest[i] = INFINITY;
  if (done) sort_faces(s->t, first, face);
  for (uint32_t i = 0; done && !abbe_shell_search_gives_up(s) && i < count; i++) {
    const uint32_t own = first[i + 1] - first[i];
    memset(votes, 0, count);
    for (uint32_t k = 0; k < FACES; k++) {
      double p[3];
      middle_of(s->triangle[face[first[i] + (uint32_t)((uint64_t)own * k / FACES)]], p);
      for (int d = 0; d < DIRECTIONS; d++) vote(s, t, i, p, direction[d], &met, votes);
    }
    done = add_around(out, i, votes, &used, &room);
  }
  free(first);
  free(face);
  free(met.shell);
  free(met.nearest);
  free(met.leaves);
  free(votes);
  return done;
}

/* The tree of boxes over the faces of shells. */

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
enum { ASKED_FACES = 4096 }; /* over so many faces it is asked whether they are wanted */

static void grow(abbe_shell_tree *t, const uint32_t *shell, size_t node, size_t first,
                 size_t last) {
  abbe_shell_box *b = &t->node[node];
  if (last - first >= ASKED_FACES && !abbe_watch_goes_on()) return;
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

void abbe_shell_sort_crossings(abbe_shells *out) {
  size_t kept = 0;
  if (out->crossing_count > 0)
    qsort(out->crossing, out->crossing_count, sizeof *out->crossing, by_pair);
  for (size_t i = 0; i < out->crossing_count; i++)
    if (i == 0 || by_pair(out->crossing[i], out->crossing[i - 1]) != 0)
      memmove(out->crossing[kept++], out->crossing[i], sizeof *out->crossing);
  out->crossing_count = kept;
}

/* Doubles the capacity unless a quarter of it is free. */
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
