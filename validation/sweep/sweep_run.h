/* sweep_run.h: a sweep from start to end: the references, then row by row what the table does not
 * hold yet. It can be stopped at any time and goes on where it was.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_RUN_H
#define ABBE_VALIDATION_SWEEP_SWEEP_RUN_H

#include "gl/device/context.h"
#include "scenes/scene.h"
#include "validation/sweep/sweep_reference.h"
#include "validation/tradeoff/sweep_table.h"

/* What is in progress ("reference", "matched", "sweep" or "processes"), and how much of it is done,
 * 0 to 1; false stops. */
typedef bool (*abbe_sweep_progress)(void *user, const char *what, double done);

typedef struct abbe_sweep_request {
  const char *program;                   /* with its version, for the table */
  const char *scene_path;                /* as the table names it */
  const char *table;                     /* where the rows are kept, a .csv */
  const char *reference, *reference_map; /* files; both NULL: traced */
  abbe_sweep_reference_desc traced;      /* how; its progress, user and stop are not looked at */
  const char *references;                /* beside which file traced ones are; NULL: the table */
  bool decompose;                        /* a second reference, of matched physics */
  bool trace_only;                       /* no rows */
  size_t frames;                         /* behind each median */
  /* A program whose whole processes are timed, warm ones of all rows, cold ones of each
   * contestant's own fronts of a frame's time and the caustic's errors; or NULL. */
  const char *run;
  const char *materials, *backend; /* for these processes, as abbe_sweep_process_desc has them */
  size_t setting_count;
  const abbe_sweep_setting *setting;
  abbe_sweep_number time, error; /* that make the front; time: one of abbe_sweep_times */
  abbe_sweep_progress progress;
  void *user;
  const volatile int *stop; /* other than 0 stops a trace midway; or NULL */
} abbe_sweep_request;

/* Gives the whole table with its front marked; an empty one with trace_only. ABBE_CANCELLED where
 * it was stopped: what is done is kept. ABBE_INVALID_ARGUMENT where the table is of another scene,
 * reference, program or machine. */
abbe_result abbe_sweep_run(abbe_context *context, const abbe_scene *scene,
                           const abbe_sweep_request *request, abbe_sweep_table *out,
                           abbe_error *error);

/* The settings of the presets' front (in that file, or NULL: the shipped ones) for the scene, to
 * see whether they keep their promise; malloc'd. ABBE_UNSUPPORTED where there is no front for it.
 */
abbe_result abbe_sweep_preset_settings(const abbe_scene *scene, const char *presets,
                                       abbe_sweep_setting **out, size_t *out_count,
                                       abbe_error *error);

#endif
