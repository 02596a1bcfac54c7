/* render_options.h: the options that `abbe render` and `abbe plan` share: the scene and the
 * request.
 * Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_RENDER_OPTIONS_H
#define ABBE_CLI_RENDER_RENDER_OPTIONS_H

#include "cli/options/scene_input.h"
#include "gl/plan/plan.h"

#include <argp.h>
#include <stdbool.h>

typedef struct abbe_render_options {
  const char *program;   /* "abbe render" */
  const char *scene;     /* path */
  const char *materials; /* table to use instead of the scene's */
  abbe_scene_input_changes changes;
  abbe_render_desc desc;
  bool unfilled;              /* of thesis, the map before its fill */
  const char *volume_path;    /* NULL: none */
  abbe_caustic_volume volume; /* the volume in that file; the loader frees it */
} abbe_render_options;

/* An argp child: the table of settings, size, range …, and the scene as the one argument. Its input
 * is an abbe_render_options with program set. */
const struct argp *abbe_render_options_argp(void);
/* Those of them that `abbe methods --help` shows: seldom wanted, or of published methods, pinholes
 * and caustic volumes alone. */
const struct argp_option *abbe_render_options_aside(void);

/* The volume that is named, into the request; errors of abbe_volume_file_read. */
abbe_result abbe_render_options_load_volume(abbe_render_options *request, abbe_error *error);

/* abbe_command_end for a request: once the scene is loaded, an invalid argument is the request's
 * own and ends with ABBE_EXIT_USAGE. */
int abbe_render_options_end(const abbe_render_options *request, bool scene_loaded,
                            abbe_result result, abbe_error *error);

#endif
