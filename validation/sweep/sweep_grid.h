/* sweep_grid.h: the settings that a sweep measures, as lists of values for each axis.
 *
 * Named grids are read from grids.yaml, which is compiled in; what a scene makes of one is found by
 * its plan.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_GRID_H
#define ABBE_VALIDATION_SWEEP_SWEEP_GRID_H

#include "base/error.h"
#include "gl/plan/facts/render_desc.h"
#include "scenes/scene.h"
#include "validation/tradeoff/sweep_table.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_SWEEP_MAX_VALUES 16 /* values of one axis */

/* Values of one axis; none: the profile's default. */
typedef struct abbe_sweep_values {
  size_t count;
  size_t value[ABBE_SWEEP_MAX_VALUES];
} abbe_sweep_values;

/* All combinations of its axes. A zeroed grid is the default profile's default. */
typedef struct abbe_sweep_grid {
  abbe_sweep_values profiles; /* abbe_profile, or one of those below */
  abbe_sweep_values wavelengths, photons, map, samples, upsample, exits, history;
  abbe_sweep_values passes;     /* for the tracer; there photons count too, and nothing else */
  abbe_sweep_values fills;      /* abbe_fill */
  abbe_sweep_values models;     /* abbe_model */
  abbe_sweep_values polygons;   /* bits of ABBE_POLYGONS */
  abbe_sweep_values directions; /* abbe_direction */
  bool meshes;                  /* only where a refractor is a general mesh */
  size_t share_count;
  double share[ABBE_SWEEP_MAX_VALUES];
} abbe_sweep_grid;

/* Contestants beside the profiles, as values of that axis: the tracer, and it filtered; the default
 * profile with soft light through so many pinholes. */
#define ABBE_SWEEP_PROFILE_TRACE ABBE_PROFILE_COUNT
#define ABBE_SWEEP_PROFILE_TRACE_FILTER (ABBE_PROFILE_COUNT + 1)
#define ABBE_SWEEP_PROFILE_PINHOLE (ABBE_PROFILE_COUNT + 2)
#define ABBE_SWEEP_PINHOLES(X) X(64) X(256) X(1024)
#define ABBE_SWEEP_PROFILE_COUNT (ABBE_PROFILE_COUNT + 5)
extern const char *const abbe_sweep_profiles[ABBE_SWEEP_PROFILE_COUNT];
#define ABBE_SWEEP_TRACE_PASSES 4 /* where none are requested, and of 512 x 512 photons */
#define ABBE_SWEEP_TRACE_PHOTONS 512

#define ABBE_SWEEP_MAX_GRIDS 8  /* grids of a file */
#define ABBE_SWEEP_MAX_PARTS 64 /* parts of a named grid */

typedef struct abbe_sweep_named_grid {
  char name[16];
  size_t count;
  abbe_sweep_grid *part; /* [count] */
} abbe_sweep_named_grid;

/* A zeroed struct is empty. */
typedef struct abbe_sweep_grids {
  size_t count;
  abbe_sweep_named_grid grid[ABBE_SWEEP_MAX_GRIDS];
} abbe_sweep_grids;

/* From a file, or with NULL the shipped ones. ABBE_SCHEMA, ABBE_PARSE and ABBE_IO name file, line
 * and key. */
abbe_result abbe_sweep_grids_load(const char *path, abbe_sweep_grids *out, abbe_error *error);
void abbe_sweep_grids_free(abbe_sweep_grids *grids);

/* What is to be drawn: every setting of the grids once, resolved by the scene's plan, in order.
 * Those that a contestant cannot make of this scene are left out: *refused counts them and `why`
 * (may be NULL) says of the first. ABBE_INVALID_ARGUMENT where none remains or they are too many.
 * *out is malloc'd. */
abbe_result abbe_sweep_grid_expand(const abbe_scene *scene, const abbe_sweep_grid *grids,
                                   size_t count, abbe_sweep_setting **out, size_t *out_count,
                                   size_t *refused, abbe_error *why, abbe_error *error);

#endif
