#include "scenes/samples/surface_samples.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>

/* A point's coordinates: its place, and its normal by as many metres as a turn counts for. */
enum { AXES = 6 };

typedef struct keyed {
  double key;
  uint32_t number;
} keyed;

typedef struct builder {
  const abbe_surface_samples *s;
  abbe_sample_node *node;
  size_t count;
  size_t *first;     /* [samples + 1] of each sample's candidates in `owned` */
  uint32_t *owned;   /* [candidates] by their owners */
  uint32_t *cluster; /* [samples] as they are halved */
  keyed *order;      /* space for a sort */
} builder;

static double coordinate(const abbe_surface_point *p, int axis, double turn) {
  return axis < 3 ? p->position[axis] : turn * p->normal[axis - 3];
}

static int by_key(const void *a, const void *b) {
  const keyed *x = a, *y = b;
  if (x->key != y->key) return x->key < y->key ? -1 : 1;
  return (x->number > y->number) - (x->number < y->number);
}

/* The axis along which the points differ most. */
static int widest(const abbe_surface_point *point, const uint32_t *number, size_t count,
                  double turn) {
  double most = -1;
  int found = 0;
  for (int axis = 0; axis < AXES; axis++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
      const double at = coordinate(&point[number[i]], axis, turn);
      low = fmin(low, at);
      high = fmax(high, at);
    }
    if (high - low > most) found = axis;
    most = fmax(most, high - low);
  }
  return found;
}

/* Orders the numbers so that the halves lie apart. */
static void halve(builder *b, const abbe_surface_point *point, uint32_t *number, size_t count,
                  double turn) {
  const int axis = widest(point, number, count, turn);
  for (size_t i = 0; i < count; i++)
    b->order[i] = (keyed){coordinate(&point[number[i]], axis, turn), number[i]};
  qsort(b->order, count, sizeof *b->order, by_key);
  for (size_t i = 0; i < count; i++) number[i] = b->order[i].number;
}

/* The point that is nearest to the middle of all. */
static uint32_t middle_of(const abbe_surface_point *point, const uint32_t *number, size_t count,
                          double turn) {
  double mean[AXES] = {0}, least = INFINITY;
  uint32_t found = number[0];
  for (size_t i = 0; i < count; i++)
    for (int axis = 0; axis < AXES; axis++)
      mean[axis] += coordinate(&point[number[i]], axis, turn) / (double)count;
  for (size_t i = 0; i < count; i++) {
    double far = 0;
    for (int axis = 0; axis < AXES; axis++) {
      const double off = coordinate(&point[number[i]], axis, turn) - mean[axis];
      far += off * off;
    }
    if (far < least) found = number[i];
    least = fmin(least, far);
  }
  return found;
}

static void hold(abbe_sample_node *node, const abbe_surface_point *p) {
  double apart[3];
  abbe_vector_subtract(p->position, node->at.position, apart);
  node->radius = fmax(node->radius, abbe_vector_length(apart));
  node->cone = fmin(node->cone, abbe_vector_dot(p->normal, node->at.normal));
}

static void hold_candidates(const builder *b, size_t sample, abbe_sample_node *node) {
  hold(node, &b->s->sample[sample]);
  for (size_t k = b->first[sample]; k < b->first[sample + 1]; k++)
    hold(node, &b->s->candidate[b->owned[k]]);
}

static size_t begin(builder *b, const abbe_surface_point *at, double area, uint32_t sample,
                    bool cluster) {
  b->node[b->count] =
      (abbe_sample_node){.at = *at, .area = area, .cone = 1, .sample = sample, .cluster = cluster};
  return b->count++;
}

/* Nodes of so many of a sample's candidates, `each` m2 of the surface. */
static void add_parts(builder *b, uint32_t sample, uint32_t *number, size_t count, double each) {
  const abbe_surface_point *point = b->s->candidate;
  const double turn = b->s->spacing;
  const uint32_t at = middle_of(point, number, count, turn);
  const size_t node = begin(b, &point[at], each * (double)count, sample, false);
  for (size_t i = 0; i < count; i++) hold(&b->node[node], &point[number[i]]);
  if (count > 1) {
    const size_t half = count / 2;
    halve(b, point, number, count, turn);
    add_parts(b, sample, number, half, each);
    add_parts(b, sample, number + half, count - half, each);
  }
  b->node[node].next = (uint32_t)b->count;
}

static void add_sample(builder *b, uint32_t sample) {
  uint32_t *number = b->owned + b->first[sample];
  const size_t count = b->first[sample + 1] - b->first[sample], half = count / 2;
  const size_t node = begin(b, &b->s->sample[sample], b->s->share[sample], sample, false);
  hold_candidates(b, sample, &b->node[node]);
  if (count > 1) {
    const double each = b->s->share[sample] / (double)count;
    halve(b, b->s->candidate, number, count, b->s->spacing);
    add_parts(b, sample, number, half, each);
    add_parts(b, sample, number + half, count - half, each);
  }
  b->node[node].next = (uint32_t)b->count;
}

/* turn: m, for which normals at right angles count. */
static void add_clusters(builder *b, uint32_t *number, size_t count, double turn) {
  if (count == 1) {
    add_sample(b, number[0]);
    return;
  }
  const abbe_surface_point *point = b->s->sample;
  const uint32_t at = middle_of(point, number, count, turn);
  const size_t node = begin(b, &point[at], 0, at, true), half = count / 2;
  for (size_t i = 0; i < count; i++) {
    b->node[node].area += b->s->share[number[i]];
    hold_candidates(b, number[i], &b->node[node]);
  }
  halve(b, point, number, count, turn);
  add_clusters(b, number, half, turn);
  add_clusters(b, number + half, count - half, turn);
  b->node[node].next = (uint32_t)b->count;
}

/* A quarter of the diagonal of what holds all samples. */
static double turn_of(const abbe_surface_samples *s) {
  double low[3], high[3], across[3];
  for (int k = 0; k < 3; k++) {
    low[k] = INFINITY;
    high[k] = -INFINITY;
  }
  for (size_t i = 0; i < s->count; i++)
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], s->sample[i].position[k]);
      high[k] = fmax(high[k], s->sample[i].position[k]);
    }
  abbe_vector_subtract(high, low, across);
  return 0.25 * abbe_vector_length(across);
}

static void sort_by_owner(builder *b) {
  const abbe_surface_samples *s = b->s;
  for (size_t i = 0; i < s->candidate_count; i++) b->first[s->owner[i] + 1]++;
  for (size_t i = 0; i < s->count; i++) b->first[i + 1] += b->first[i];
  for (size_t i = s->candidate_count; i-- > 0;) b->owned[--b->first[s->owner[i] + 1]] = (uint32_t)i;
  /* each first is now its predecessor's end less its own: where its owner's begin */
  for (size_t i = 0; i < s->count; i++) b->first[i] = b->first[i + 1];
  b->first[s->count] = s->candidate_count;
}

abbe_result abbe_sample_tree_make(const abbe_surface_samples *samples, abbe_sample_tree *out,
                                  abbe_error *error) {
  *out = (abbe_sample_tree){0};
  const size_t count = samples->count, candidates = samples->candidate_count;
  const size_t most = 2 * (count + candidates) + 1;
  builder b = {.s = samples,
               .node = calloc(most, sizeof *b.node),
               .first = calloc(count + 1, sizeof *b.first),
               .owned = calloc(candidates + 1, sizeof *b.owned),
               .cluster = calloc(count + 1, sizeof *b.cluster),
               .order = calloc(count + candidates + 1, sizeof *b.order)};
  const bool room =
      b.node != NULL && b.first != NULL && b.owned != NULL && b.cluster != NULL && b.order != NULL;
  if (room) {
    sort_by_owner(&b);
    for (size_t i = 0; i < count; i++) b.cluster[i] = (uint32_t)i;
    if (count > 0) add_clusters(&b, b.cluster, count, turn_of(samples));
  }
  free(b.first);
  free(b.owned);
  free(b.cluster);
  free(b.order);
  out->node = b.node;
  out->count = b.count;
  if (room) return ABBE_OK;
  abbe_sample_tree_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a tree of %zu samples", count);
}

void abbe_sample_tree_free(abbe_sample_tree *tree) {
  if (tree == NULL) return;
  free(tree->node);
  *tree = (abbe_sample_tree){0};
}
