/* sample_tree.h: samples of surfaces as a tree: clusters of samples above, parts of each below, for
 * who takes few of what is far and many of what is near, as light cuts do [Walter2005].
 *
 * A node stands for all below it by one point. Clusters hold samples that are near each other and
 * face alike; a sample's parts are the candidates that are nearest to it, halved again and again.
 * Who looks from a place goes down until a node is small enough there: the nodes where they stop
 * are a cut, which counts every piece of the surfaces once. The tree knows no light and makes no
 * cut.
 */
#ifndef ABBE_SCENES_SAMPLES_SAMPLE_TREE_H
#define ABBE_SCENES_SAMPLES_SAMPLE_TREE_H

#include "base/error.h"
#include "scenes/samples/surface_samples.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct abbe_sample_node {
  abbe_surface_point
      at;          /* that stands for all below: a sample, or of a part one of its candidates */
  double area;     /* m2, of all below */
  double radius;   /* m, of the ball around `at` that holds every point below */
  double cone;     /* least cosine of its normal and theirs */
  uint32_t sample; /* that it is, is part of, or whose point stands for the cluster */
  uint32_t next;   /* the first node after it that is not below it */
  bool cluster;    /* holds several samples */
} abbe_sample_node;

/* Depth first: what is below a node follows it, up to `next`. */
typedef struct abbe_sample_tree {
  size_t
      count; /* every sample is in it once, with parts where more than one candidate is its own */
  abbe_sample_node *node;
} abbe_sample_tree;

/* ABBE_NO_MEMORY. */
abbe_result abbe_sample_tree_make(const abbe_surface_samples *samples, abbe_sample_tree *out,
                                  abbe_error *error);
void abbe_sample_tree_free(abbe_sample_tree *tree);

#endif
