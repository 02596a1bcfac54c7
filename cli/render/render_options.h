/* render_options.h: the options that `abbe render` and `abbe plan` share: the scene and the
 * request.
 * Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_RENDER_OPTIONS_H
#define ABBE_CLI_RENDER_RENDER_OPTIONS_H

#include "cli/base/arguments.h"
#include "cli/options/scene_input.h"
#include "gl/accuracy/error_bars.h"
#include "gl/accuracy/preset.h"
#include "gl/device/statistics.h"
#include "gl/plan/plan.h"
#include "library/choice/picture_choice.h"

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
extern const abbe_parser abbe_render_options_argp;
/* Makes the options of the table, those that are shown aside as hidden ones; to be called first. */
void abbe_render_options_begin(void);
/* Those of them that `abbe methods --help` shows: seldom wanted, or of published methods, pinholes
 * and caustic volumes alone. */
const abbe_option *abbe_render_options_aside(void);

/* The volume that is named, into the request; errors of abbe_volume_file_read. */
abbe_result abbe_render_options_load_volume(abbe_render_options *request, abbe_error *error);

/* abbe_command_end for a request: once the scene is loaded, an invalid argument is the request's
 * own and ends with ABBE_EXIT_USAGE. */
int abbe_render_options_end(const abbe_render_options *request, bool scene_loaded,
                            abbe_result result, abbe_error *error);

/* A picture's own error: --error-bars and what is written of it. */

struct cJSON;

typedef struct abbe_error_options {
  const char *program; /* "abbe render" */
  const char *png;     /* the errors in false colours, or NULL */
  bool asked, mean;
  size_t variants; /* 0: the default */
} abbe_error_options;

/* An argp child: --error-bars, --error-png, --mean. Its input is an abbe_error_options with program
 * set. */
extern const abbe_parser abbe_error_options_argp;

/* Draws the variants under a progress bar, puts the errors into the picture as layers and, with
 * --mean, the mean into its first three channels; writes --error-png. Nothing where nothing was
 * requested. */
abbe_result abbe_error_options_work(const abbe_error_options *options, abbe_context *context,
                                    const abbe_scene *scene, abbe_renderer *renderer, bool quiet,
                                    abbe_image *picture, abbe_error_bars *out, abbe_error *error);

/* Adds "error_bars" to the statistics, and says the summary on stderr; nothing likewise. */
void abbe_error_options_describe(const abbe_error_options *options, const abbe_error_bars *bars,
                                 struct cJSON *root);
void abbe_error_options_summarise(const abbe_error_options *options, const abbe_error_bars *bars);

/* A picture's tool and settings by name, by error or by time, as options and in words. */

struct cJSON;

typedef struct abbe_preset_options {
  const char *program; /* "abbe render" */
  abbe_preset_request request;
  bool of_frame;   /* --for frame */
  bool of_picture; /* --for picture: not by default alone */
  int tool;        /* --tool: an abbe_picture_tool; below 0: any */
} abbe_preset_options;

/* An argp child: --preset, --max-error, --budget-ms, --for, --tool, --presets. Its input is an
 * abbe_preset_options with program set and tool -1. */
extern const abbe_parser abbe_preset_options_argp;

/* Adds "promise" to the statistics: what was chosen, promised and met; nothing where nothing was
 * requested. `estimate` is the caustic's mean CIEDE2000 by the picture's error bars; below 0: not
 * known. */
void abbe_preset_options_describe(const abbe_preset_choice *choice,
                                  const abbe_statistics *statistics, double estimate,
                                  struct cJSON *root);
/* The same of a whole picture; ms is the process's time, error_met what the tool knows of its own
 * error (below 0: nothing). */
void abbe_preset_options_describe_picture(const abbe_picture_choice *choice, double ms,
                                          double error_met, struct cJSON *root);
/* Says on stderr what was chosen, and what cannot be kept. */
void abbe_preset_options_note(const abbe_preset_choice *choice);
void abbe_preset_options_note_picture(const abbe_picture_choice *choice);
/* Says so where what was chosen is drawn with other settings. */
void abbe_preset_options_note_overridden(bool overridden);
/* Prints on stderr what is known of the picture's error once it is there: estimated or only
 * expected. */
void abbe_preset_options_note_error(const abbe_picture_choice *choice);

#endif
