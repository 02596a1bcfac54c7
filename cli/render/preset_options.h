/* preset_options.h: a picture's tool and settings by name, by error or by time, as options and in
 * words. Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_PRESET_OPTIONS_H
#define ABBE_CLI_RENDER_PRESET_OPTIONS_H

#include "gl/accuracy/preset_choice.h"
#include "gl/device/statistics.h"
#include "library/choice/picture_choice.h"

#include <argp.h>

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
extern const struct argp abbe_preset_options_argp;

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
