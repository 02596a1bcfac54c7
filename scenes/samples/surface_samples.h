/* surface_samples.h: a few points that stand for surfaces, spread over them by area
 * [WandStrasser2003].
 *
 * Candidates are many points, uniform by area, at random or evenly. They are gone through in their
 * order, and each that is nearer to a kept one than a radius is dropped, so that samples are as
 * dense on all surfaces, whatever way these face. It knows no light.
 */
#ifndef ABBE_SCENES_SAMPLES_SURFACE_SAMPLES_H
#define ABBE_SCENES_SAMPLES_SURFACE_SAMPLES_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_SURFACE_MAX_SAMPLES 4096

typedef struct abbe_surface_point {
  double position[3], normal[3]; /* m; unit, interpolated between the corners' */
  uint32_t mesh;                 /* which of those given */
} abbe_surface_point;

typedef struct abbe_surface_samples {
  size_t count;
  abbe_surface_point *sample; /* [count] */
  double *share;              /* [count] m2: of the candidates that are nearest to it; they sum to
                                 area */
  double area;                /* area of all meshes, m2 */
  double spacing;             /* sqrt(area / count), m */
  double reach;               /* the radius, m */
  size_t candidate_count;
  abbe_surface_point *candidate; /* [candidate_count], in their order */
  uint32_t *owner;               /* [candidate_count] the sample nearest to each */
} abbe_surface_samples;

/* What is asked for. Zeros: 1 sample. */
typedef struct abbe_surface_sampling {
  size_t count;  /* at most so many are kept, and nearly as many */
  uint64_t seed; /* seed of the candidates */
  bool sided;    /* points whose normals are more than 90 degrees apart are on different sides of a
                    sheet: neither drops the other */
  bool even; /* candidates follow an additive recurrence, which fills the surfaces evenly: shares
                are then closer to the area that is nearest */
} abbe_surface_sampling;

/* Makes samples of all faces of the meshes together; faces without area are never met.
 * ABBE_INVALID_ARGUMENT for more than ABBE_SURFACE_MAX_SAMPLES, ABBE_GEOMETRY where there is no
 * area, ABBE_NO_MEMORY. */
abbe_result abbe_surface_samples_make(const abbe_mesh *const *mesh, size_t mesh_count,
                                      const abbe_surface_sampling *sampling,
                                      abbe_surface_samples *out, abbe_error *error);
void abbe_surface_samples_free(abbe_surface_samples *samples);

/* How the normals of surfaces turn around sampled places, by regression over the denser points
 * around them [WandStrasser2003]. */

/* Along along[0] and along[1], unit tangents that with the normal are a right-handed frame, the
 * normal turns by curvature[0] and curvature[1] (1/m, the first of the greater amount; above 0
 * where normals spread) towards them. */
typedef struct abbe_surface_curvature {
  double along[2][3];
  double curvature[2];
} abbe_surface_curvature;

/* Fits a linear normal for each sample, over the candidates within a spacing whose normals are less
 * than 60 degrees from its own: their mean normal is that of the tangent plane. out: [count].
 * Places with too few candidates are flat. ABBE_NO_MEMORY. */
abbe_result abbe_surface_curvature_fit(const abbe_surface_samples *samples,
                                       abbe_surface_curvature *out, abbe_error *error);

/* Points in cubic cells, by a hash of the cell: who is within a cell's edge of a
 * place.
 *
 * The points are the caller's; the grid holds their numbers. It may grow while it is asked. */

typedef struct abbe_point_grid {
  double cell;    /* edge of a cell, m */
  uint32_t *head; /* [mask + 1] last number of a cell's chain, or UINT32_MAX */
  uint32_t *next; /* [capacity] */
  uint32_t *key;  /* [capacity] of each number's cell, which separates those of a chain */
  size_t mask, room;
} abbe_point_grid;

/* Makes an empty grid for numbers below `room`; cell > 0. ABBE_INVALID_ARGUMENT, ABBE_NO_MEMORY. */
abbe_result abbe_point_grid_make(double cell, size_t room, abbe_point_grid *out, abbe_error *error);
void abbe_point_grid_free(abbe_point_grid *grid);

/* Adds a number below the capacity, once, at its place. */
void abbe_point_grid_add(abbe_point_grid *grid, const double at[3], size_t number);

/* Called with a number of such a cell; false: no more. */
typedef bool (*abbe_point_visit)(void *user, size_t number);
/* All numbers of the 27 cells around a place: those of all points no farther than a cell's edge are
 * among them. */
void abbe_point_grid_visit(const abbe_point_grid *grid, const double at[3], abbe_point_visit visit,
                           void *user);

/* Samples of surfaces as a tree: clusters of samples above, parts of each below, for
 * who takes few of what is far and many of what is near, as light cuts do [Walter2005].
 *
 * A node stands for all below it by one point. Clusters hold samples that are near each other and
 * face alike; a sample's parts are the candidates that are nearest to it, halved again and again.
 * Who looks from a place goes down until a node is small enough there: the nodes where they stop
 * are a cut, which counts every piece of the surfaces once. The tree knows no light and makes no
 * cut. */

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
