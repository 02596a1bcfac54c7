/* Which shells lie in which: points of each vote, along rays. */
#include "base/maths.h"
#include "scenes/mesh/bvh.h"
#include "scenes/mesh/shell_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FACES = 5, DIRECTIONS = 3 }; /* that vote, of which some may be where shells touch */

/* Shells that a ray meets, each with its first face there. */
typedef struct meetings {
  uint32_t *shell;
  size_t count;
  double *nearest; /* of every shell; infinity: not met */
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
 * tells by the side that it shows. */
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

static bool add_around(abbe_shells *out, uint32_t shell, const unsigned char *votes, size_t *used,
                       size_t *room) {
  abbe_shell *self = &out->shell[shell];
  self->first = (uint32_t)*used;
  for (size_t i = 0; i < out->count; i++) {
    if (2 * votes[i] <= FACES * DIRECTIONS || abbe_shells_cross(out, shell, (uint32_t)i)) continue;
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
