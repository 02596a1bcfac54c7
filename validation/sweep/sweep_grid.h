/* sweep_grid.h: the settings that a sweep measures, as lists of values for each axis.
 *
 * The named grids are here; what a scene makes of one is sweep.h's.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_GRID_H
#define ABBE_VALIDATION_SWEEP_SWEEP_GRID_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_SWEEP_MAX_VALUES 16 /* of one axis */
#define ABBE_SWEEP_MAX_GRIDS 28

/* Values of one axis; none: the profile's default. */
typedef struct abbe_sweep_values {
  size_t count;
  size_t value[ABBE_SWEEP_MAX_VALUES];
} abbe_sweep_values;

/* All combinations of its axes. A zeroed grid is the default profile's default. */
typedef struct abbe_sweep_grid {
  abbe_sweep_values profiles; /* abbe_profile */
  abbe_sweep_values wavelengths, photons, map, samples, upsample, exits;
  abbe_sweep_values fills;    /* abbe_fill */
  abbe_sweep_values models;   /* abbe_model */
  bool meshes; /* only where a refractor is a general mesh */
  size_t share_count;
  double share[ABBE_SWEEP_MAX_VALUES];
} abbe_sweep_grid;

/* X(code, name): quick shows the shape of the front in a few minutes; full has all axes; thin has
 * what many scenes in one run leave time for, with exits and shares that do not differ by scene. */
#define ABBE_SWEEP_GRIDS(X) X(QUICK, "quick") X(FULL, "full") X(THIN, "thin")
typedef enum abbe_sweep_grid_name {
#define ABBE_SWEEP_ENUM(code, name) ABBE_SWEEP_GRID_##code,
  ABBE_SWEEP_GRIDS(ABBE_SWEEP_ENUM)
#undef ABBE_SWEEP_ENUM
      ABBE_SWEEP_GRID_COUNT
} abbe_sweep_grid_name;

/* The parts of a named grid, at most ABBE_SWEEP_MAX_GRIDS; how many. */
size_t abbe_sweep_grid_make(abbe_sweep_grid_name name, abbe_sweep_grid *out);

#ifdef __cplusplus
}
#endif
#endif
