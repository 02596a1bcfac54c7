#include "gl/scene/bvh_nodes.h"

#include "base/thread/watch.h"
#include "scenes/geometry/vector.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The grid is a little wider than the tree, and boxes than what they hold by MARGIN cells: more
 * than what a ray that starts at the tree loses by rounding. */
enum { ASKED = 4096 }; /* over so many triangles it is asked whether the tree is wanted */
enum { TREE_TEXELS = 2, NODE_TEXELS = 3, GRID_LOW = 200, GRID_CELLS = 65000, CONE_UNIT = 32767 };
static const double MARGIN = 0.0625;

/* A triangle's unit normal as floats know it, to an angle of `unsure`; below 0: it has none at all.
 */
typedef struct facing {
  double n[3], unsure;
} facing;

typedef struct packer {
  const abbe_bvh *h;
  facing *facing; /* of each triangle, in the tree's order */
  size_t first_texel, first_triangle, texels;
  double low[3], cell[3];
  uint32_t (*out)[4];
} packer;

size_t abbe_bvh_nodes_count(const abbe_bvh *h) {
  return TREE_TEXELS + NODE_TEXELS * ((h->node_count - 1) / 2);
}

static uint32_t bits_of(double x) {
  float f = (float)x;
  uint32_t bits;
  memcpy(&bits, &f, sizeof bits);
  return bits;
}

static void lay_grid(packer *p) {
  const abbe_bvh_node *root = p->h->node;
  double widest = 0;
  for (int k = 0; k < 3; k++) widest = fmax(widest, (double)root->max[k] - (double)root->min[k]);
  for (int k = 0; k < 3; k++) {
    /* a flat tree has its depth, too, and what lies in a point is not divided by nothing */
    double wide = fmax((double)root->max[k] - (double)root->min[k], 1e-3 * widest);
    wide = fmax(wide, 1e-6 * fmax(fabs((double)root->min[k]), 1e-20));
    p->cell[k] = (double)(float)(wide / GRID_CELLS);
    p->low[k] = (double)(float)((double)root->min[k] - GRID_LOW * p->cell[k]);
    p->out[0][k] = bits_of(p->low[k]);
    p->out[1][k] = bits_of(p->cell[k]);
  }
}

static void pack_box(const packer *p, const abbe_bvh_node *n, uint32_t out[4]) {
  for (int k = 0; k < 3; k++) {
    double low = floor(((double)n->min[k] - p->low[k]) / p->cell[k] - MARGIN);
    double high = ceil(((double)n->max[k] - p->low[k]) / p->cell[k] + MARGIN);
    out[k] = (uint32_t)fmax(low, 0) | (uint32_t)fmin(high, 65535) << 16;
  }
}

static facing facing_of(const double t[9]) {
  facing out = {.unsure = -1};
  double e1[3], e2[3], *n = out.n;
  abbe_vector_subtract(t + 3, t, e1);
  abbe_vector_subtract(t + 6, t, e2);
  abbe_vector_cross(e1, e2, n);
  double length = sqrt(abbe_vector_dot(n, n));
  double edges = sqrt(abbe_vector_dot(e1, e1) * abbe_vector_dot(e2, e2));
  if (!(length > 16 * (double)FLT_EPSILON * edges)) return out;
  for (int k = 0; k < 3; k++) n[k] /= length;
  out.unsure = asin(fmin(8 * (double)FLT_EPSILON * edges / length, 1));
  return out;
}

/* The cone of the normals of so many triangles; one that is wider than this leaves nothing out. */
static void pack_cone(const packer *p, size_t first, size_t count, uint32_t out[2]) {
  static const double too_wide = 1.5;
  double axis[3] = {0, 0, 0}, widest = 0;
  bool all = true;
  for (size_t i = first; i < first + count && all; i++) {
    all = p->facing[i].unsure >= 0;
    for (int k = 0; k < 3; k++) axis[k] += all ? p->facing[i].n[k] : 0;
  }
  double length = sqrt(abbe_vector_dot(axis, axis)), snorm[3] = {0, 0, 0}, sine = CONE_UNIT;
  if (all && length > 0) {
    for (int k = 0; k < 3; k++) snorm[k] = round(axis[k] / length * CONE_UNIT);
    length = sqrt(abbe_vector_dot(snorm, snorm));
    for (size_t i = first; i < first + count && widest < too_wide; i++) {
      double cosine = abbe_vector_dot(snorm, p->facing[i].n) / length;
      widest = fmax(widest, acos(fmin(fmax(cosine, -1), 1)) + p->facing[i].unsure);
    }
    /* one more for what the shader's dot product loses */
    if (widest < too_wide) sine = fmin(ceil(length * sin(widest)) + 1, CONE_UNIT);
  }
  if (sine >= CONE_UNIT) snorm[0] = snorm[1] = snorm[2] = 0;
  uint16_t word[4];
  for (int k = 0; k < 3; k++) word[k] = (uint16_t)(int16_t)snorm[k];
  word[3] = (uint16_t)sine;
  out[0] = word[0] | (uint32_t)word[1] << 16;
  out[1] = word[2] | (uint32_t)word[3] << 16;
}

static size_t count_below(const abbe_bvh *h, const abbe_bvh_node *n, size_t *first) {
  if (n->count > 0) {
    *first = (size_t)n->first;
    return (size_t)n->count;
  }
  size_t behind, count = count_below(h, h->node + n->first, first);
  return count + count_below(h, h->node + n->first + 1, &behind);
}

/* Returns what the node leads to. */
static int32_t pack(packer *p, const abbe_bvh_node *n) {
  if (n->count > 0)
    return ~(int32_t)(((size_t)n->first + p->first_triangle) << 3 | (size_t)n->count);
  size_t at = p->texels;
  p->texels += NODE_TEXELS;
  for (size_t k = 0; k < 2; k++) {
    const abbe_bvh_node *child = p->h->node + n->first + k;
    size_t first, count = count_below(p->h, child, &first);
    if (count >= ASKED && !abbe_watch_goes_on()) return 0;
    pack_box(p, child, p->out[at + k]);
    pack_cone(p, first, count, p->out[at + 2] + 2 * k);
    p->out[at + k][3] = (uint32_t)pack(p, child);
  }
  return (int32_t)(p->first_texel + at);
}

abbe_result abbe_bvh_nodes_pack(const abbe_bvh *h, const double (*triangle)[9], size_t first_texel,
                                size_t first_triangle, uint32_t (*out)[4], abbe_error *error) {
  assert(h->node_count > 0);
  packer p = {.h = h,
              .facing = malloc((h->triangle_count + 1) * sizeof *p.facing),
              .first_texel = first_texel,
              .first_triangle = first_triangle,
              .texels = TREE_TEXELS,
              .out = out};
  if (p.facing == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy");
  for (size_t i = 0; i < h->triangle_count; i++) p.facing[i] = facing_of(triangle[h->triangle[i]]);
  lay_grid(&p);
  out[1][3] = 0;
  out[0][3] = (uint32_t)pack(&p, h->node);
  free(p.facing);
  return abbe_watch_check(error);
}
