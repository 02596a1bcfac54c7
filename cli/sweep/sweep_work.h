/* sweep_work.h: what `abbe sweep` does with a scene: the reference, the rows, the front. */
#ifndef ABBE_CLI_SWEEP_SWEEP_WORK_H
#define ABBE_CLI_SWEEP_SWEEP_WORK_H

#include "validation/sweep/sweep.h"

#include <stdbool.h>

typedef struct abbe_sweep_request {
  const char *program;
  const char *scene, *materials;
  const char *csv, *plot, *report;
  const char *reference, *reference_map; /* files, or NULL: traced */
  abbe_context_backend backend;
  size_t width, height; /* pixels; 0: the scene's */
  size_t frames, passes, photons, texels;
  bool matched;             /* physics of the reference */
  bool growth;              /* instead of a sweep: how a frame's time grows */
  bool trace_only;          /* no rows */
  bool split;               /* a second one with matched physics */
  bool presets;             /* the grid is the front of the presets for the scene's class */
  const char *presets_file; /* NULL: the shipped ones */
  size_t grid_count;
  abbe_sweep_grid grid[ABBE_SWEEP_MAX_GRIDS];
  abbe_sweep_number error; /* that makes the front */
  bool quiet, json, list;
} abbe_sweep_request;

/* Traces or loads the reference, measures what the table at q->csv does not hold yet, keeps it
 * there row by row, and gives the whole table with its front marked. ABBE_CANCELLED where the user
 * stopped it: what is done is kept. */
abbe_result abbe_sweep_work(const abbe_sweep_request *q, abbe_sweep_table *out, abbe_error *error);

/* --growth: times how a frame grows, keeps the times at q->csv, draws and prints them. */
abbe_result abbe_sweep_grow(const abbe_sweep_request *q, abbe_error *error);

#endif
