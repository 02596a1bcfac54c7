/* sweep_options.h: what `abbe sweep` is asked. Internal to cli/sweep/. */
#ifndef ABBE_CLI_SWEEP_SWEEP_OPTIONS_H
#define ABBE_CLI_SWEEP_SWEEP_OPTIONS_H

#include "cli/base/command.h"
#include "cli/base/rank_job.h"

#include "validation/sweep/studies/transport_study.h"
#include "validation/sweep/sweep_grid.h"
#include "validation/sweep/sweep_run.h"

#include <argp.h>
#include <stdbool.h>

#define ABBE_SWEEP_MAX_ARGUMENTS 64

typedef struct abbe_sweep_options {
  const char *program;           /* "abbe sweep" */
  const abbe_sweep_grids *grids; /* whose names --grid takes */
  size_t argument_count;
  const char *argument[ABBE_SWEEP_MAX_ARGUMENTS];
  const char *scene, *materials; /* scene: NULL where tables are shown */
  abbe_sweep_request work;       /* all but settings, scene_path and progress */
  const char *plot, *report;     /* files, or NULL */
  const char *write_presets;     /* file, or NULL */
  const char *presets;           /* file of the promises; NULL: the shipped ones */
  const char *grid;              /* a name, "presets", or NULL */
  bool listed, traced;    /* a list, or something of the reference that is traced, was given */
  abbe_sweep_grid list;   /* grid of the lists */
  abbe_command_part part; /* part of the settings */
  abbe_context_backend backend;
  bool scaling;    /* instead of a sweep: how a frame's time scales */
  bool estimators; /* instead: how far off estimators of receiver hits are */
  bool processes;  /* time whole processes too */
  bool quiet, json, list_only;
  const abbe_rank_job *job; /* the ranks that share the settings; NULL: one process */
} abbe_sweep_options;

/* Its input is an abbe_sweep_options with program, grids and defaults set. */
extern const struct argp abbe_sweep_options_argp;

/* Whether --grid names a study of transports. */
bool abbe_sweep_options_compares_transports(const abbe_sweep_options *options);

/* Whether a path names a table and no scene. */
bool abbe_sweep_options_is_table(const char *path);

#endif
