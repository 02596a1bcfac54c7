#include "gl/scene/gpu_scene.h"

#include "base/maths.h"
#include "gl/device/shader_maths.h"
#include "scenes/mesh/bvh.h"

#include <stdlib.h>

enum { CHILDREN = ABBE_RAY_CHILDREN, STACK = (CHILDREN - 1) * ABBE_BVH_MAX_DEPTH + CHILDREN };

/* What a packed node or its tree leads to, and in what box and cone. */
typedef struct child {
  double low[3], high[3];
  float axis[3], sine;
  int32_t to;
} child;

static float float_of(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

static double area_of(const child *c) {
  const double x = c->high[0] - c->low[0], y = c->high[1] - c->low[1], z = c->high[2] - c->low[2];
  return x * y + y * z + z * x;
}

static child child_of(const uint32_t (*texel)[4], size_t root, int32_t node, int k) {
  const uint32_t *box = texel[node + k], *cone = texel[node + 2] + 2 * k;
  child c = {.axis = {(int16_t)cone[0], (int16_t)(cone[0] >> 16), (int16_t)cone[1]},
             .sine = (int16_t)(cone[1] >> 16),
             .to = (int32_t)box[3]};
  for (int i = 0; i < 3; i++) {
    const double low = (double)float_of(texel[root][i]),
                 cell = (double)float_of(texel[root + 1][i]);
    c.low[i] = low + (double)(box[i] & 0xffffu) * cell;
    c.high[i] = low + (double)(box[i] >> 16) * cell;
  }
  return c;
}

/* Opens the largest of the children until there are as many as a node holds; returns how many. */
static int open_children(const uint32_t (*texel)[4], size_t root, child *c, int count) {
  while (count < CHILDREN) {
    int widest = -1;
    for (int k = 0; k < count; k++)
      if (c[k].to >= 0 && (widest < 0 || area_of(&c[k]) > area_of(&c[widest]))) widest = k;
    if (widest < 0) break;
    const int32_t node = c[widest].to;
    c[widest] = child_of(texel, root, node, 0);
    c[count++] = child_of(texel, root, node, 1);
  }
  return count;
}

static bool make_room(abbe_ray_trees *t) {
  if (t->count < t->capacity) return true;
  const size_t more = t->capacity * 3 / 2 + 64;
  abbe_ray_node *node = realloc(t->node, more * sizeof *node);
  if (node == NULL) return false;
  t->node = node;
  t->capacity = more;
  return true;
}

/* Adds a node of these; returns its number, or -1 without memory. */
static int32_t add_node(abbe_ray_trees *t, const uint32_t (*texel)[4], size_t root, const child *c,
                        int count) {
  if (!make_room(t)) return -1;
  const size_t at = t->count++;
  abbe_ray_node node = {.count = count};
  for (int k = 0; k < CHILDREN; k++) {
    for (int i = 0; i < 3; i++) {
      node.low[i][k] = k < count ? nextafterf((float)c[k].low[i], -INFINITY) : INFINITY;
      node.high[i][k] = k < count ? nextafterf((float)c[k].high[i], INFINITY) : -INFINITY;
      node.axis[i][k] = k < count ? c[k].axis[i] : 0;
    }
    node.sine[k] = k < count ? c[k].sine : 1;
    node.child[k] = k < count ? c[k].to : -1;
  }
  for (int k = 0; k < count; k++) {
    if (c[k].to < 0) continue;
    child below[CHILDREN] = {child_of(texel, root, c[k].to, 0), child_of(texel, root, c[k].to, 1)};
    node.child[k] = add_node(t, texel, root, below, open_children(texel, root, below, 2));
    if (node.child[k] < 0) return -1;
  }
  t->node[at] = node;
  return (int32_t)at;
}

abbe_result abbe_ray_trees_add(abbe_ray_trees *trees, const uint32_t (*texel)[4], size_t root,
                               size_t *at, abbe_error *error) {
  child whole = {.sine = INT16_MAX, .to = (int32_t)texel[root][3]};
  for (int i = 0; i < 3; i++) {
    whole.low[i] = (double)float_of(texel[root][i]);
    whole.high[i] = whole.low[i] + 65535 * (double)float_of(texel[root + 1][i]);
  }
  *at = trees->count;
  if (add_node(trees, texel, root, &whole, 1) < 0)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy");
  return ABBE_OK;
}

void abbe_ray_trees_free(abbe_ray_trees *trees) {
  free(trees->node);
  *trees = (abbe_ray_trees){0};
}

/* Of so many rays or fewer each is asked alone which children it meets. */
enum { RAYS = ABBE_RAYS, FEW = 2 };
#define EACH_RAY _Pragma("omp simd") for (int k = 0; k < RAYS; k++)

/* Rays from where they come to the tree. Those that are not asked for are at their end. */
typedef struct rays {
  float o[3][RAYS], inverse[3][RAYS], away[3][RAYS];
  float t_min[RAYS], t[RAYS], u[RAYS], v[RAYS], start[RAYS];
  int32_t triangle[RAYS];
} rays;

/* What children rays meet: a bit for each of the rays, and where the first enters. */
typedef struct meetings {
  int32_t met[CHILDREN];
  float enters[CHILDREN];
} meetings;

/* Triangle i on each ray. */
static inline void meet_triangle(const float (*triangle)[4], int i, const abbe_rays *in, rays *r) {
  const float(*of)[4] = triangle + 3 * (size_t)i;
  const v3 corner = vector_at(of[0]), e1 = vector_at(of[1]), e2 = vector_at(of[2]);
  EACH_RAY {
    const v3 d = {in->d[0][k], in->d[1][k], in->d[2][k]};
    const v3 from = {r->o[0][k] - corner.x, r->o[1][k] - corner.y, r->o[2][k] - corner.z};
    const v3 across = cross(d, e2), q = cross(from, e1);
    const float det = dot(e1, across), scale = 1 / det;
    const float u = dot(from, across) * scale, v = dot(d, q) * scale, t = dot(e2, q) * scale;
    const float best_t = r->t[k], best_u = r->u[k], best_v = r->v[k];
    const int32_t best = r->triangle[k];
    const bool nearer = (det != 0) & (det * in->side[k] >= 0) & (least(u, v) >= -2e-6f) &
                        (u + v <= 1.000002f) & (t > r->t_min[k]) & (t < best_t);
    r->t[k] = nearer ? t : best_t;
    r->u[k] = nearer ? u : best_u;
    r->v[k] = nearer ? v : best_v;
    r->triangle[k] = nearer ? i : best;
  }
}

static inline unsigned bits_of_lanes(const int32_t bit[RAYS]) {
  unsigned all = 0;
#pragma omp simd reduction(| : all)
  for (int k = 0; k < RAYS; k++) all |= (unsigned)bit[k];
  return all;
}

/* Ray number `of` and all children; returns a bit for each that it meets. */
static inline unsigned meet_alone(const abbe_ray_node *n, const rays *r, int of, meetings *to) {
  float start[3], inverse[3], away[3];
  const float *near[3], *far[3];
  for (int i = 0; i < 3; i++) {
    start[i] = r->o[i][of];
    inverse[i] = r->inverse[i][of];
    away[i] = r->away[i][of];
    near[i] = inverse[i] >= 0 ? n->low[i] : n->high[i];
    far[i] = inverse[i] >= 0 ? n->high[i] : n->low[i];
  }
  const float t_min = r->t_min[of], nearest = r->t[of];
  const int32_t bit = 1 << of;
  int32_t children[CHILDREN];
#pragma omp simd
  for (int k = 0; k < CHILDREN; k++) {
    const float x = (near[0][k] - start[0]) * inverse[0];
    const float y = (near[1][k] - start[1]) * inverse[1];
    const float z = (near[2][k] - start[2]) * inverse[2];
    const float far_x = (far[0][k] - start[0]) * inverse[0];
    const float far_y = (far[1][k] - start[1]) * inverse[1];
    const float far_z = (far[2][k] - start[2]) * inverse[2];
    const float turned =
        away[0] * n->axis[0][k] + away[1] * n->axis[1][k] + away[2] * n->axis[2][k] - n->sine[k];
    const float from = most(most(x, y), most(z, t_min));
    const float end = least(least(far_x, far_y), least(far_z, nearest));
    const bool met = (from <= end) & (turned <= 0);
    const float enters = to->enters[k];
    const int32_t before = to->met[k];
    to->met[k] = met ? before | bit : before;
    to->enters[k] = met & (from < enters) ? from : enters;
    children[k] = met ? 1 << k : 0;
  }
  return bits_of_lanes(children);
}

/* All rays and child c; returns a bit for each that meets it. */
static inline int32_t meet_child(const abbe_ray_node *n, const rays *r, int c, float *enters) {
  float from_here[RAYS], first = INFINITY;
  int32_t met[RAYS];
  EACH_RAY {
    float from = r->t_min[k], end = r->t[k], turned = -n->sine[c];
    for (int i = 0; i < 3; i++) {
      const float a = (n->low[i][c] - r->o[i][k]) * r->inverse[i][k];
      const float b = (n->high[i][c] - r->o[i][k]) * r->inverse[i][k];
      from = most(from, least(a, b));
      end = least(end, most(a, b));
      turned += r->away[i][k] * n->axis[i][c];
    }
    const bool meets = (from <= end) & (turned <= 0);
    met[k] = meets ? 1 << k : 0;
    from_here[k] = meets ? from : INFINITY;
  }
  const int32_t all = (int32_t)bits_of_lanes(met);
  if (all == 0) return 0;
#pragma omp simd reduction(min : first)
  for (int k = 0; k < RAYS; k++) first = least(first, from_here[k]);
  *enters = first;
  return all;
}

static inline unsigned meet_together(const abbe_ray_node *n, const rays *r, meetings *to) {
  unsigned children = 0;
  for (int c = 0; c < n->count; c++) {
    to->met[c] = meet_child(n, r, c, &to->enters[c]);
    children |= to->met[c] != 0 ? 1u << c : 0;
  }
  return children;
}

/* Rays that meet the tree's box begin there, however far that is: boxes are known to the tree's
 * size. Returns which do. */
static inline unsigned begin_at(const abbe_ray_node *root, const abbe_rays *in, unsigned mask,
                                rays *r) {
  int32_t meets[RAYS];
  EACH_RAY {
    float first = in->t_min[k], last = in->t[k];
    for (int i = 0; i < 3; i++) {
      const float d = in->d[i][k], tiny = d >= 0 ? 1e-20f : -1e-20f;
      const float inverse = 1 / (fabsf(d) >= 1e-20f ? d : tiny);
      const float low = (root->low[i][0] - in->o[i][k]) * inverse;
      const float high = (root->high[i][0] - in->o[i][k]) * inverse;
      r->inverse[i][k] = inverse;
      first = most(first, least(low, high));
      last = least(last, most(low, high));
    }
    const bool here = ((mask >> k & 1u) != 0) & (first <= last * 1.0000005f);
    const float start = here ? most(first, 0) : 0;
    for (int i = 0; i < 3; i++) {
      r->o[i][k] = in->o[i][k] + start * in->d[i][k];
      r->away[i][k] = in->side[k] * in->d[i][k];
    }
    r->start[k] = start;
    r->t_min[k] = in->t_min[k] - start;
    r->t[k] = here ? in->t[k] - start : -INFINITY;
    r->u[k] = r->v[k] = 0;
    r->triangle[k] = -1;
    meets[k] = here ? 1 << k : 0;
  }
  return bits_of_lanes(meets);
}

typedef struct waiting {
  float enters;
  int32_t to, mask;
} waiting;

/* Whether one of them may yet meet something there. */
static inline bool is_wanted(const waiting *w, const rays *r) {
  int32_t wanted[RAYS];
  EACH_RAY wanted[k] = r->t[k] > w->enters ? 1 << k : 0;
  return ((int32_t)bits_of_lanes(wanted) & w->mask) != 0;
}

SIDE_BY_SIDE __attribute__((flatten)) void abbe_ray_trees_meet(const abbe_ray_trees *trees,
                                                               size_t root,
                                                               const float (*triangle)[4],
                                                               unsigned mask, abbe_rays *in) {
  waiting stack[STACK];
  rays r;
  const unsigned begun = begin_at(&trees->node[root], in, mask, &r);
  size_t count = begun != 0;
  stack[0] =
      (waiting){.enters = -INFINITY, .to = trees->node[root].child[0], .mask = (int32_t)begun};
  while (count > 0) {
    const waiting w = stack[--count];
    if (!is_wanted(&w, &r)) continue;
    if (w.to < 0) {
      const int first = ~w.to >> 3, end = first + (~w.to & 7);
      for (int i = first; i < end; i++) meet_triangle(triangle, i, in, &r);
      continue;
    }
    const abbe_ray_node *n = &trees->node[w.to];
    meetings m = {.met = {0}};
    unsigned children = 0;
    if (__builtin_popcount((unsigned)w.mask) > FEW) {
      children = meet_together(n, &r, &m);
    } else {
      for (int k = 0; k < CHILDREN; k++) m.enters[k] = INFINITY;
      for (unsigned rest = (unsigned)w.mask; rest != 0; rest &= rest - 1)
        children |= meet_alone(n, &r, __builtin_ctz(rest), &m);
    }
    const size_t bottom = count;
    for (; children != 0; children &= children - 1) {
      const int k = __builtin_ctz(children);
      size_t at = count++; /* nearer ones are looked at first */
      for (; at > bottom && stack[at - 1].enters < m.enters[k]; at--) stack[at] = stack[at - 1];
      stack[at] = (waiting){.enters = m.enters[k], .to = n->child[k], .mask = m.met[k]};
    }
  }
  EACH_RAY {
    const bool met = r.triangle[k] >= 0;
    const float t = in->t[k], u = in->u[k], v = in->v[k];
    const int32_t before = in->triangle[k];
    in->t[k] = met ? r.t[k] + r.start[k] : t;
    in->u[k] = met ? r.u[k] : u;
    in->v[k] = met ? r.v[k] : v;
    in->triangle[k] = met ? r.triangle[k] : before;
  }
}
