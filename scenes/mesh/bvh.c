#include "scenes/mesh/bvh.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "scenes/geometry/disjoint_sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* COST: of a step down the tree, in triangles met. */
enum { BINS = 16, LEAF = 4, SURE_LEAF = 1, COST = 1, HALVING_DEPTH = 28 };
enum { PART = 1 << 16 }; /* looks at triangles between two questions whether it goes on */

typedef struct box {
  double min[3], max[3];
} box;

typedef struct builder {
  const box *bounds; /* box of each triangle */
  const double (*middle)[3];
  uint32_t *order;
  abbe_bvh_node *node;
  size_t node_count, depth;
  size_t looks; /* at triangles, since it was asked */
  bool stopped;
} builder;

static const box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* The lesser of two numbers, finite or infinite, without a call. */
static double least(double a, double b) {
  return a < b ? a : b;
}

static double most(double a, double b) {
  return a > b ? a : b;
}

static void grow(box *b, const double p[3]) {
  for (int k = 0; k < 3; k++) {
    b->min[k] = least(b->min[k], p[k]);
    b->max[k] = most(b->max[k], p[k]);
  }
}

/* other: may hold nothing */
static void join(box *b, const box *other) {
  for (int k = 0; k < 3; k++) {
    b->min[k] = least(b->min[k], other->min[k]);
    b->max[k] = most(b->max[k], other->max[k]);
  }
}

static double area(const box *b) {
  double x = b->max[0] - b->min[0], y = b->max[1] - b->min[1], z = b->max[2] - b->min[2];
  return x >= 0 ? x * y + y * z + z * x : 0;
}

static float below(double x) {
  float f = (float)x;
  return (double)f <= x ? f : nextafterf(f, -INFINITY);
}

static float above(double x) {
  float f = (float)x;
  return (double)f >= x ? f : nextafterf(f, INFINITY);
}

static void set_box(abbe_bvh_node *node, const box *b) {
  for (int k = 0; k < 3; k++) {
    node->min[k] = below(b->min[k]);
    node->max[k] = above(b->max[k]);
  }
}

static int bin_of(double x, double low, double high) {
  int bin = (int)((x - low) / (high - low) * BINS);
  return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

typedef struct split {
  int axis, bin; /* triangles in bins up to this one go first */
  double cost;
} split;

/* The cheapest of BINS - 1 places along one axis. */
static void try_axis(const builder *b, size_t first, size_t count, int axis, const box *middles,
                     split *best) {
  box bin[BINS], right[BINS];
  size_t number[BINS] = {0}, behind[BINS] = {0};
  double low = middles->min[axis], high = middles->max[axis];
  if (!(high > low)) return;
  for (int i = 0; i < BINS; i++) bin[i] = nothing;
  for (size_t i = first; i < first + count; i++) {
    int k = bin_of(b->middle[b->order[i]][axis], low, high);
    number[k]++;
    join(&bin[k], &b->bounds[b->order[i]]);
  }
  box sum = nothing;
  for (int i = BINS - 1; i > 0; i--) {
    join(&sum, &bin[i]);
    right[i] = sum;
    behind[i] = number[i] + (i < BINS - 1 ? behind[i + 1] : 0);
  }
  sum = nothing;
  size_t before = 0;
  for (int i = 0; i < BINS - 1; i++) {
    join(&sum, &bin[i]);
    before += number[i];
    if (before == 0 || behind[i + 1] == 0) continue;
    double cost = area(&sum) * (double)before + area(&right[i + 1]) * (double)behind[i + 1];
    if (cost < best->cost) *best = (split){axis, i, cost};
  }
}

/* Sorts the range by the split; returns how many come first. */
static size_t part(builder *b, size_t first, size_t count, const split *s, const box *middles) {
  size_t i = first, end = first + count;
  while (i < end) {
    double x = b->middle[b->order[i]][s->axis];
    if (bin_of(x, middles->min[s->axis], middles->max[s->axis]) <= s->bin) {
      i++;
    } else {
      uint32_t other = b->order[--end];
      b->order[end] = b->order[i];
      b->order[i] = other;
    }
  }
  return i - first;
}

/* Before so many triangles are looked at. */
static bool goes_on(builder *b, size_t count) {
  b->looks += count;
  if (b->looks < PART) return !b->stopped;
  b->looks = 0;
  b->stopped = !abbe_watch_goes_on();
  return !b->stopped;
}

static void build(builder *b, size_t node, size_t first, size_t count, size_t depth) {
  box bounds = nothing, middles = nothing;
  if (!goes_on(b, count)) return;
  for (size_t i = first; i < first + count; i++) {
    join(&bounds, &b->bounds[b->order[i]]);
    grow(&middles, b->middle[b->order[i]]);
  }
  set_box(&b->node[node], &bounds);
  split best = {-1, 0, INFINITY};
  if (count > SURE_LEAF && depth < HALVING_DEPTH)
    for (int axis = 0; axis < 3 && goes_on(b, count); axis++)
      try_axis(b, first, count, axis, &middles, &best);
  if (b->stopped) return;
  double whole = area(&bounds);
  bool worth = best.axis >= 0 && COST * whole + best.cost < whole * (double)count;
  if (count <= LEAF && !worth) {
    b->node[node].first = (int32_t)first;
    b->node[node].count = (int32_t)count;
    return;
  }
  /* where no place separates triangles, and too far down, halves end it */
  size_t left = best.axis >= 0 ? part(b, first, count, &best, &middles) : count / 2;
  size_t child = b->node_count;
  b->node_count += 2;
  b->node[node].first = (int32_t)child;
  b->node[node].count = 0;
  if (depth + 1 > b->depth) b->depth = depth + 1;
  build(b, child, first, left, depth + 1);
  build(b, child + 1, first + left, count - left, depth + 1);
}

abbe_result abbe_bvh_make(const double (*triangle)[9], size_t count, abbe_bvh *out,
                          abbe_error *error) {
  *out = (abbe_bvh){0};
  if (count == 0)
    return abbe_error_set(error, ABBE_GEOMETRY, "a BVH needs a triangle; there is none");
  if (count > ABBE_MESH_MAX_FACES)
    return abbe_error_set(error, ABBE_GEOMETRY, "a BVH holds at most %u triangles, not %zu",
                          ABBE_MESH_MAX_FACES, count);
  box *bounds = malloc(count * sizeof *bounds);
  double(*middle)[3] = malloc(count * sizeof *middle);
  abbe_bvh h = {.node = malloc(2 * count * sizeof *h.node),
                .triangle_count = count,
                .triangle = malloc(count * sizeof *h.triangle)};
  abbe_result result = ABBE_OK;
  if (bounds == NULL || middle == NULL || h.node == NULL || h.triangle == NULL) {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a BVH over %zu triangles", count);
    abbe_bvh_free(&h);
  } else {
    for (size_t i = 0; i < count; i++) {
      h.triangle[i] = (uint32_t)i;
      bounds[i] = nothing;
      for (int c = 0; c < 3; c++) grow(&bounds[i], triangle[i] + 3 * c);
      for (int k = 0; k < 3; k++) middle[i][k] = 0.5 * (bounds[i].min[k] + bounds[i].max[k]);
    }
    builder b = {.bounds = bounds,
                 .middle = (const double(*)[3])middle,
                 .order = h.triangle,
                 .node = h.node,
                 .node_count = 1};
    build(&b, 0, 0, count, 0);
    h.node_count = b.node_count;
    h.depth = b.depth;
    if (b.stopped) {
      abbe_bvh_free(&h);
      result = abbe_watch_check(error);
    }
    *out = h;
  }
  free(bounds);
  free(middle);
  return result;
}

void abbe_bvh_free(abbe_bvh *h) {
  if (h == NULL) return;
  free(h->node);
  free(h->triangle);
  *h = (abbe_bvh){0};
}

/* ---- rays ---- */

/* [MollerTrumbore1997] */
bool abbe_bvh_meet(const double triangle[9], const double o[3], const double d[3], int side,
                   double t_min, double t_max, abbe_bvh_hit *hit) {
  double e1[3], e2[3], across[3], from[3], q[3];
  abbe_vector_subtract(triangle + 3, triangle, e1);
  abbe_vector_subtract(triangle + 6, triangle, e2);
  abbe_vector_cross(d, e2, across);
  double det = abbe_vector_dot(e1, across);
  if (det == 0 || (side != 0 && det * side < 0)) return false;
  abbe_vector_subtract(o, triangle, from);
  abbe_vector_cross(from, e1, q);
  double u = abbe_vector_dot(from, across) / det, v = abbe_vector_dot(d, q) / det;
  double t = abbe_vector_dot(e2, q) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && t > t_min && t < t_max)) return false;
  hit->t = t;
  hit->u = u;
  hit->v = v;
  return true;
}

/* Where the ray enters the box, or infinity. */
static double enter(const abbe_bvh_node *node, const double o[3], const double inverse[3],
                    double t_min, double t_max) {
  double from = t_min, to = t_max;
  for (int k = 0; k < 3; k++) {
    double a = ((double)node->min[k] - o[k]) * inverse[k];
    double b = ((double)node->max[k] - o[k]) * inverse[k];
    from = most(from, least(a, b));
    to = least(to, most(a, b));
  }
  return from <= to ? from : INFINITY;
}

bool abbe_bvh_trace(const abbe_bvh *h, const double (*triangle)[9], const double o[3],
                    const double d[3], int side, double t_min, double t_max, abbe_bvh_hit *hit) {
  struct {
    const abbe_bvh_node *node;
    double from;
  } stack[ABBE_BVH_MAX_DEPTH + 1];
  size_t waiting = 0;
  double inverse[3];
  bool found = false;
  for (int k = 0; k < 3; k++) inverse[k] = 1 / (fabs(d[k]) > 1e-30 ? d[k] : copysign(1e-30, d[k]));
  stack[0].node = h->node;
  stack[0].from = enter(h->node, o, inverse, t_min, t_max);
  if (!isinf(stack[0].from)) waiting++;
  while (waiting > 0) {
    const abbe_bvh_node *node = stack[--waiting].node;
    if (stack[waiting].from > t_max) continue;
    for (int i = 0; i < node->count; i++) {
      uint32_t index = h->triangle[node->first + i];
      if (!abbe_bvh_meet(triangle[index], o, d, side, t_min, t_max, hit)) continue;
      hit->index = index;
      t_max = hit->t;
      found = true;
    }
    if (node->count > 0) continue;
    const abbe_bvh_node *a = h->node + node->first;
    const double from[2] = {enter(a, o, inverse, t_min, t_max),
                            enter(a + 1, o, inverse, t_min, t_max)};
    const int near = from[1] < from[0];
    for (int i = 0; i < 2; i++) {
      const int child = i == 0 ? !near : near;
      if (isinf(from[child])) continue;
      stack[waiting].node = a + child;
      stack[waiting++].from = from[child];
    }
  }
  return found;
}

/* ---- meshes ---- */

double (*abbe_bvh_triangles(const abbe_mesh *mesh))[9] {
  double(*triangle)[9] = malloc((mesh->face_count + 1) * sizeof *triangle);
  for (size_t i = 0; triangle != NULL && i < mesh->face_count; i++)
    for (int c = 0; c < 3; c++)
      memcpy(triangle[i] + 3 * c, mesh->position[mesh->face[i][c]], sizeof *mesh->position);
  return triangle;
}

typedef struct corner {
  double key[6]; /* position, normal */
  uint32_t vertex;
} corner;

static int by_key(const void *a, const void *b) {
  const corner *x = a, *y = b;
  for (int k = 0; k < 6; k++)
    if (x->key[k] != y->key[k]) return x->key[k] < y->key[k] ? -1 : 1;
  return 0;
}

size_t abbe_bvh_parts(const abbe_mesh *mesh, uint32_t *group) {
  size_t vertices = mesh->vertex_count, groups = 0;
  corner *sorted = malloc((vertices + 1) * sizeof *sorted);
  uint32_t *parent = malloc((vertices + 1) * sizeof *parent);
  if (sorted != NULL && parent != NULL) {
    for (size_t i = 0; i < vertices; i++) {
      parent[i] = (uint32_t)i;
      sorted[i].vertex = (uint32_t)i;
      memcpy(sorted[i].key, mesh->position[i], sizeof *mesh->position);
      /* the same normal summed in another order */
      for (int k = 0; k < 3; k++) sorted[i].key[3 + k] = round(1e5 * mesh->normal[i][k]);
    }
    qsort(sorted, vertices, sizeof *sorted, by_key);
    for (size_t i = 1; i < vertices; i++)
      if (by_key(&sorted[i - 1], &sorted[i]) == 0)
        abbe_disjoint_sets_unite(parent, sorted[i].vertex, sorted[i - 1].vertex);
    for (size_t i = 0; i < mesh->face_count; i++)
      for (int c = 1; c < 3; c++)
        abbe_disjoint_sets_unite(parent, mesh->face[i][c], mesh->face[i][0]);
    uint32_t *number = (uint32_t *)sorted; /* no longer wanted */
    memset(number, 0, vertices * sizeof *number);
    for (size_t i = 0; i < mesh->face_count; i++) {
      uint32_t root = abbe_disjoint_sets_find(parent, mesh->face[i][0]);
      if (number[root] == 0) number[root] = (uint32_t)++groups;
      group[i] = number[root] - 1;
    }
  }
  free(sorted);
  free(parent);
  return groups;
}
