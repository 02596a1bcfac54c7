/* preset_options.h: a picture's settings by name, by error or by time, as options and in words. */
#ifndef ABBE_CLI_RENDER_PRESET_OPTIONS_H
#define ABBE_CLI_RENDER_PRESET_OPTIONS_H

#include "gl/accuracy/preset_choice.h"
#include "gl/device/statistics.h"

#include <argp.h>

struct cJSON;

typedef struct abbe_preset_options {
  const char *program; /* "abbe render" */
  abbe_preset_request request;
} abbe_preset_options;

/* An argp child: --preset, --max-error, --budget-ms, --presets. Its input is an
 * abbe_preset_options with program set. */
extern const struct argp abbe_preset_options_argp;

/* Adds "promise" to the statistics: what was chosen, promised and met; nothing where nothing was
 * asked for. `estimate` is the caustic's mean CIEDE2000 by the picture's error bars; below 0: not
 * known. */
void abbe_preset_options_describe(const abbe_preset_choice *choice,
                                  const abbe_statistics *statistics, double estimate,
                                  struct cJSON *root);
/* Says on stderr what was chosen, and what cannot be kept. */
void abbe_preset_options_note(const abbe_preset_choice *choice);

#endif
