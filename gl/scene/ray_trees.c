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
  abbe_ray_node node;
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

typedef struct ray {
  v3 o, d;
  float from[3], inverse[3], away[3];
  bool forward[3];
  float side, t_min;
} ray;

static inline void meet_triangle(const float (*triangle)[4], int i, const ray *r,
                                 abbe_ray_hit *best) {
  const float(*of)[4] = triangle + 3 * (size_t)i;
  const v3 e1 = vector_at(of[1]), e2 = vector_at(of[2]), from = off(r->o, vector_at(of[0]));
  const v3 across = cross(r->d, e2), q = cross(from, e1);
  const float det = dot(e1, across), scale = 1 / det;
  const float u = dot(from, across) * scale, v = dot(r->d, q) * scale, t = dot(e2, q) * scale;
  if (det != 0 && det * r->side >= 0 && least(u, v) >= -2e-6f && u + v <= 1.000002f &&
      t > r->t_min && t < best->t)
    *best = (abbe_ray_hit){t, u, v, i};
}

/* Where the ray enters each child; returns a bit for each that it meets before `nearest`. */
static inline unsigned enter_children(const abbe_ray_node *n, const ray *r, float nearest,
                                      float *enters) {
  const float *near[3], *far[3];
  for (int i = 0; i < 3; i++) {
    near[i] = r->forward[i] ? n->low[i] : n->high[i];
    far[i] = r->forward[i] ? n->high[i] : n->low[i];
  }
  int met[CHILDREN];
#pragma omp simd
  for (int k = 0; k < CHILDREN; k++) {
    const float x = (near[0][k] - r->from[0]) * r->inverse[0];
    const float y = (near[1][k] - r->from[1]) * r->inverse[1];
    const float z = (near[2][k] - r->from[2]) * r->inverse[2];
    const float far_x = (far[0][k] - r->from[0]) * r->inverse[0];
    const float far_y = (far[1][k] - r->from[1]) * r->inverse[1];
    const float far_z = (far[2][k] - r->from[2]) * r->inverse[2];
    const float turned = r->away[0] * n->axis[0][k] + r->away[1] * n->axis[1][k] +
                         r->away[2] * n->axis[2][k] - n->sine[k];
    float from = x > y ? x : y, to = far_x < far_y ? far_x : far_y;
    from = from > z ? from : z;
    to = to < far_z ? to : far_z;
    from = from > r->t_min ? from : r->t_min;
    to = to < nearest ? to : nearest;
    enters[k] = from;
    met[k] = (from <= to) & (turned <= 0) ? 1 << k : 0;
  }
  unsigned all = 0;
#pragma omp simd reduction(| : all)
  for (int k = 0; k < CHILDREN; k++) all |= (unsigned)met[k];
  return all;
}

/* Whether the ray meets the tree's box; it begins there, after *start, however far that is: boxes
 * are known to the tree's size. */
static inline bool begin_at(const abbe_ray_node *root, const float o[3], const float d[3],
                            float t_min, float t_max, ray *r, float *start) {
  float first = t_min, last = t_max;
  for (int i = 0; i < 3; i++) {
    r->forward[i] = d[i] >= 0;
    r->inverse[i] = 1 / (fabsf(d[i]) >= 1e-20f ? d[i] : r->forward[i] ? 1e-20f : -1e-20f);
    const float low = (root->low[i][0] - o[i]) * r->inverse[i];
    const float high = (root->high[i][0] - o[i]) * r->inverse[i];
    first = most(first, least(low, high));
    last = least(last, most(low, high));
  }
  if (!(first <= last * 1.0000005f)) return false;
  *start = most(first, 0);
  for (int i = 0; i < 3; i++) r->from[i] = o[i] + *start * d[i];
  r->o = vector_at(r->from);
  r->d = vector_at(d);
  r->t_min = t_min - *start;
  return true;
}

SIDE_BY_SIDE bool abbe_ray_trees_meet(const abbe_ray_trees *trees, size_t root,
                                      const float (*triangle)[4], const float o[3],
                                      const float d[3], float side, float t_min,
                                      abbe_ray_hit *hit) {
  struct {
    float enters;
    int32_t to;
  } stack[STACK];
  ray r = {.side = side, .away = {side * d[0], side * d[1], side * d[2]}};
  float start;
  if (!begin_at(&trees->node[root], o, d, t_min, hit->t, &r, &start)) return false;
  abbe_ray_hit best = {.t = hit->t - start, .triangle = -1};
  size_t waiting = 1;
  stack[0].enters = -INFINITY;
  stack[0].to = trees->node[root].child[0];
  while (waiting > 0) {
    waiting--;
    const int32_t to = stack[waiting].to;
    if (stack[waiting].enters >= best.t) continue;
    if (to < 0) {
      const int first = ~to >> 3, end = first + (~to & 7);
      for (int i = first; i < end; i++) meet_triangle(triangle, i, &r, &best);
      continue;
    }
    float enters[CHILDREN];
    const abbe_ray_node *n = &trees->node[to];
    const size_t bottom = waiting;
    for (unsigned met = enter_children(n, &r, best.t, enters); met != 0; met &= met - 1) {
      const int k = __builtin_ctz(met);
      size_t at = waiting++; /* nearer ones are looked at first */
      for (; at > bottom && stack[at - 1].enters < enters[k]; at--) stack[at] = stack[at - 1];
      stack[at].enters = enters[k];
      stack[at].to = n->child[k];
    }
  }
  if (best.triangle < 0) return false;
  *hit = best;
  hit->t = best.t + start;
  return true;
}
