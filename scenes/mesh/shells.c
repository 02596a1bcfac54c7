#include "scenes/mesh/shells.h"

#include "scenes/geometry/vector.h"
#include "scenes/mesh/hierarchy.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define TOUCHES 1e-6 /* of the diagonal of the bounds */
#define UNPLACED UINT32_MAX

void abbe_shells_free(abbe_shells *shells) {
  if (!shells) return;
  free(shells->shell);
  free(shells->around);
  free(shells->crossing);
  memset(shells, 0, sizeof *shells);
}

/* What is needed while they are looked at. */
typedef struct search {
  const abbe_topology *t;
  double (*triangle)[9]; /* [face_count] */
  double tolerance;
  abbe_shells *out;
  size_t room; /* for crossings */
  uint64_t work, most_work;
  bool within; /* crossings are looked for within shells, else between them */
  bool no_memory;
} search;

/* Shells that all cross or nest take the square of their number. What is done for them is counted,
 * in steps through the tree, and ends after seconds. */
#define MOST_WORK ((uint64_t)1 << 27)
#define MOST_WORK_A_FACE 1024u
enum { WORK_OF_A_PAIR = 4 };

static bool gives_up(const search *s) {
  return s->no_memory || s->work > s->most_work;
}

/* ---- a tree of boxes, each over half of the faces of the one above ---- */

typedef struct box {
  double low[3], high[3];
} box;

enum { LEAF = 4 }; /* faces */

typedef struct tree {
  uint32_t *face;  /* [count] in the order of the leaves */
  box *of_face;    /* [face_count] */
  box *node;       /* node i is over the faces of 2 i + 1 and 2 i + 2 */
  uint32_t *shell; /* of all faces of the node; NONE: of several */
} tree;

static bool boxes_meet(const box *a, const box *b) {
  for (int k = 0; k < 3; k++)
    if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return false;
  return true;
}

static void widen(box *b, const box *by) {
  for (int k = 0; k < 3; k++) {
    if (by->low[k] < b->low[k]) b->low[k] = by->low[k];
    if (by->high[k] > b->high[k]) b->high[k] = by->high[k];
  }
}

static double middle_along(const box *b, int axis) {
  return b->low[axis] + b->high[axis];
}

/* Puts the lesser half along the axis first (quickselect). */
static void halve(const tree *t, size_t first, size_t last, size_t half, int axis) {
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
static void grow(tree *t, const uint32_t *shell, size_t node, size_t first, size_t last) {
  box *b = &t->node[node];
  *b = t->of_face[t->face[first]];
  t->shell[node] = shell[t->face[first]];
  for (size_t i = first + 1; i < last; i++) {
    widen(b, &t->of_face[t->face[i]]);
    if (shell[t->face[i]] != t->shell[node]) t->shell[node] = ABBE_TOPOLOGY_NONE;
  }
  if (last - first <= LEAF) return;
  int axis = 0;
  for (int k = 1; k < 3; k++)
    if (b->high[k] - b->low[k] > b->high[axis] - b->low[axis]) axis = k;
  const size_t half = (first + last) / 2;
  halve(t, first, last, half, axis);
  grow(t, shell, 2 * node + 1, first, half);
  grow(t, shell, 2 * node + 2, half, last);
}

static void tree_free(tree *t) {
  free(t->face);
  free(t->of_face);
  free(t->node);
  free(t->shell);
}

static bool tree_make(const search *s, tree *t) {
  const size_t faces = s->t->face_count;
  size_t nodes = 1;
  for (size_t over = faces; over > LEAF; over = (over + 1) / 2) nodes = 2 * nodes + 1;
  *t = (tree){.face = malloc((faces + 1) * sizeof *t->face),
              .of_face = malloc((faces + 1) * sizeof *t->of_face),
              .node = malloc(nodes * sizeof *t->node),
              .shell = malloc(nodes * sizeof *t->shell)};
  if (!t->face || !t->of_face || !t->node || !t->shell) return false;
  for (size_t f = 0; f < faces; f++) {
    const double *at = s->triangle[f];
    box *b = &t->of_face[f];
    t->face[f] = (uint32_t)f;
    for (int k = 0; k < 3; k++) {
      b->low[k] = fmin(fmin(at[k], at[3 + k]), at[6 + k]) - s->tolerance;
      b->high[k] = fmax(fmax(at[k], at[3 + k]), at[6 + k]) + s->tolerance;
    }
  }
  grow(t, s->t->shell, 0, 0, faces);
  return true;
}

/* ---- crossings ---- */

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
    abbe_hierarchy_hit hit;
    double d[3];
    abbe_vector_subtract(a + 3 * next, a + 3 * k, d);
    if (!abbe_hierarchy_meet(b, a + 3 * k, d, 0, 0, 1, &hit)) continue;
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

/* In order, each pair once. */
static void sort_crossings(abbe_shells *out) {
  size_t kept = 0;
  if (out->crossing_count > 0)
    qsort(out->crossing, out->crossing_count, sizeof *out->crossing, by_pair);
  for (size_t i = 0; i < out->crossing_count; i++)
    if (i == 0 || by_pair(out->crossing[i], out->crossing[i - 1]) != 0)
      memmove(out->crossing[kept++], out->crossing[i], sizeof *out->crossing);
  out->crossing_count = kept;
}

/* Doubles the room unless a quarter of it is free. */
static bool crossings_have_room(search *s) {
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

static void add_crossing(search *s, uint32_t a, uint32_t b, const double place[3]) {
  abbe_shells *out = s->out;
  if (a == b) {
    if (out->self_count++ == 0) memcpy(out->self_place, place, sizeof out->self_place);
    return;
  }
  if (out->crossing_count == 0) memcpy(out->place, place, sizeof out->place);
  if (out->crossing_count == s->room) {
    sort_crossings(out);
    if (!crossings_have_room(s)) return;
  }
  uint32_t *pair = out->crossing[out->crossing_count++];
  pair[0] = a < b ? a : b;
  pair[1] = a < b ? b : a;
}

/* Whether b lies in a's plane and over a part of it, not just beside it. */
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

static void meet_faces(search *s, uint32_t f, uint32_t g) {
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

/* A node and the faces that it is over. */
typedef struct part {
  size_t node, first, last;
} part;

static part child_of(part p, int which) {
  const size_t half = (p.first + p.last) / 2;
  return which == 0 ? (part){2 * p.node + 1, p.first, half} : (part){2 * p.node + 2, half, p.last};
}

/* Whether faces of the shells, NONE where there are several, may be such that are looked for. */
static bool are_looked_for(const search *s, uint32_t a, uint32_t b) {
  return a == ABBE_TOPOLOGY_NONE || b == ABBE_TOPOLOGY_NONE || (a == b) == s->within;
}

static void meet_leaves(search *s, const tree *t, part a, part b) {
  for (size_t i = a.first; i < a.last; i++)
    for (size_t k = a.node == b.node ? i + 1 : b.first; k < b.last; k++)
      if (are_looked_for(s, s->t->shell[t->face[i]], s->t->shell[t->face[k]]) &&
          boxes_meet(&t->of_face[t->face[i]], &t->of_face[t->face[k]])) {
        s->work += WORK_OF_A_PAIR;
        meet_faces(s, t->face[i], t->face[k]);
      }
}

/* All pairs of faces of a and b whose boxes meet. */
static void meet_parts(search *s, const tree *t, part a, part b) {
  const size_t faces_a = a.last - a.first, faces_b = b.last - b.first;
  s->work++;
  if (gives_up(s) || !are_looked_for(s, t->shell[a.node], t->shell[b.node]) ||
      !boxes_meet(&t->node[a.node], &t->node[b.node]))
    return;
  if (faces_a <= LEAF && faces_b <= LEAF) {
    meet_leaves(s, t, a, b);
  } else if (a.node == b.node) {
    meet_parts(s, t, child_of(a, 0), child_of(a, 0));
    meet_parts(s, t, child_of(a, 1), child_of(a, 1));
    meet_parts(s, t, child_of(a, 0), child_of(a, 1));
  } else if (faces_a > faces_b) {
    meet_parts(s, t, child_of(a, 0), b);
    meet_parts(s, t, child_of(a, 1), b);
  } else {
    meet_parts(s, t, a, child_of(b, 0));
    meet_parts(s, t, a, child_of(b, 1));
  }
}

static void find_crossings(search *s, const tree *t, bool within) {
  const part all = {0, 0, s->t->face_count};
  s->work = 0;
  s->within = within;
  meet_parts(s, t, all, all);
}

static bool cross(const abbe_shells *shells, uint32_t a, uint32_t b) {
  const uint32_t pair[2] = {a < b ? a : b, a < b ? b : a};
  return shells->crossing_count > 0 &&
         bsearch(pair, shells->crossing, shells->crossing_count, sizeof pair, by_pair) != NULL;
}

/* ---- nesting ---- */

static void measure(search *s) {
  const abbe_topology *t = s->t;
  for (size_t f = 0; f < t->face_count; f++) {
    double n[3], from[3];
    const double *a = s->triangle[f];
    abbe_vector_triangle(a, a + 3, a + 6, n);
    abbe_vector_subtract(a, s->triangle[0], from);
    s->out->shell[t->shell[f]].volume += abbe_vector_dot(from, n) / 6;
  }
}

enum { FACES = 5, DIRECTIONS = 3 }; /* that vote, of which some may be where shells touch */

/* Shells that a ray meets, each with its first face there. */
typedef struct meetings {
  uint32_t *shell;
  size_t count;
  double *nearest; /* of every shell; infinity: not met */
  bool *leaves;    /* there the face shows its back */
} meetings;

static bool ray_enters(const box *b, const double p[3], const double inverse[3]) {
  double from = 0, to = INFINITY;
  for (int k = 0; k < 3; k++) {
    const double low = (b->low[k] - p[k]) * inverse[k], high = (b->high[k] - p[k]) * inverse[k];
    from = fmax(from, fmin(low, high));
    to = fmin(to, fmax(low, high));
  }
  return from <= to;
}

static void meet_face_on_ray(const search *s, uint32_t face, const double p[3], const double d[3],
                             meetings *met) {
  const double *a = s->triangle[face];
  const uint32_t shell = s->t->shell[face];
  abbe_hierarchy_hit hit;
  double n[3];
  if (!abbe_hierarchy_meet(a, p, d, 0, 0, met->nearest[shell], &hit)) return;
  if (isinf(met->nearest[shell])) met->shell[met->count++] = shell;
  met->nearest[shell] = hit.t;
  abbe_vector_triangle(a, a + 3, a + 6, n);
  met->leaves[shell] = abbe_vector_dot(n, d) > 0;
}

/* d has no zero among its components. */
static void follow(search *s, const tree *t, part at, const double p[3], const double d[3],
                   const double inverse[3], meetings *met) {
  s->work++;
  if (gives_up(s) || !ray_enters(&t->node[at.node], p, inverse)) return;
  if (at.last - at.first <= LEAF) {
    s->work += at.last - at.first;
    for (size_t i = at.first; i < at.last; i++) meet_face_on_ray(s, t->face[i], p, d, met);
  } else {
    for (int i = 0; i < 2; i++) follow(s, t, child_of(at, i), p, d, inverse, met);
  }
}

/* Adds a vote for each other shell that the point lies in: along the ray the first face of a shell
 * tells by the side that it shows. */
static void vote(search *s, const tree *t, uint32_t self, const double p[3], const double d[3],
                 meetings *met, unsigned char *votes) {
  const part all = {0, 0, s->t->face_count};
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

static bool add_around(abbe_shells *out, uint32_t shell, const unsigned char *votes, size_t *used,
                       size_t *room) {
  abbe_shell *self = &out->shell[shell];
  self->first = (uint32_t)*used;
  for (size_t i = 0; i < out->count; i++) {
    if (2 * votes[i] <= FACES * DIRECTIONS || cross(out, shell, (uint32_t)i)) continue;
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

static bool find_nesting(search *s, const tree *t) {
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
  for (uint32_t i = 0; done && !gives_up(s) && i < count; i++) {
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
  uint32_t *barred;        /* of each solid: the last shell, from 1, that may not join it */
  uint32_t *around;        /* of each solid: its shells around the one at hand */
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

static abbe_result prepare(search *s, const abbe_mesh *mesh, abbe_error *error) {
  s->out->shell = calloc(s->out->count + 1, sizeof *s->out->shell);
  s->triangle = abbe_hierarchy_triangles(mesh);
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

static abbe_result find_lie(search *s, abbe_error *error) {
  tree t;
  bool room = tree_make(s, &t);
  s->most_work = MOST_WORK + MOST_WORK_A_FACE * (uint64_t)s->t->face_count;
  /* a surface too intricate to be searched for crossings of its own is taken to have none more */
  if (room) find_crossings(s, &t, true);
  if (room && s->out->count > 1) {
    find_crossings(s, &t, false);
    sort_crossings(s->out);
    if (!gives_up(s)) room = find_nesting(s, &t);
  }
  tree_free(&t);
  if (!room || s->no_memory)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  if (s->out->count > 1 && gives_up(s))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %zu parts of the mesh, of %zu faces, lie in and through one another "
                          "in too many places to be told apart; unite them in a modeller",
                          s->out->count, s->t->face_count);
  return ABBE_OK;
}

abbe_result abbe_shells_find(const abbe_mesh *mesh, const abbe_topology *topology, abbe_shells *out,
                             abbe_error *error) {
  ABBE_REQUIRE(mesh && topology && out, error);
  memset(out, 0, sizeof *out);
  if (topology->face_count == 0) return ABBE_OK;
  out->count = topology->shell_count;
  search s = {.t = topology, .out = out};
  abbe_result result = prepare(&s, mesh, error);
  if (result == ABBE_OK) result = find_lie(&s, error);
  if (result == ABBE_OK) result = share_out(out, error);
  free(s.triangle);
  if (result != ABBE_OK) abbe_shells_free(out);
  return result;
}
