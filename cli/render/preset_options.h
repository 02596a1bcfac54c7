/* preset_options.h: a picture's settings by name, by error or by time, and what that promises. */
#ifndef ABBE_CLI_RENDER_PRESET_OPTIONS_H
#define ABBE_CLI_RENDER_PRESET_OPTIONS_H

#include "gl/accuracy/preset.h"
#include "gl/device/statistics.h"

#include <argp.h>
#include <stdbool.h>

struct cJSON;

typedef struct abbe_preset_options {
  const char *program; /* "abbe render" */
  const char *name;    /* of --preset, or NULL */
  const char *file;    /* of presets, or NULL: the shipped ones */
  double max_error;    /* 0: none */
  double budget_ms;    /* 0: none */
  /* After abbe_preset_options_resolve, where one was asked for: */
  bool chosen;
  abbe_presets presets;
  const abbe_preset_front *front;
  size_t point;
  bool kept;       /* the bound can be kept, by the front */
  bool overridden; /* an option of its own stands against the choice */
  bool timed;      /* promised_ms is known */
  double promised_ms;
} abbe_preset_options;

/* An argp child: --preset, --max-error, --budget-ms, --presets. Its input is an
 * abbe_preset_options with program set. */
extern const struct argp abbe_preset_options_argp;

/* Chooses and fills the fields of desc that are 0. With a time to keep, or `timed`, this machine's
 * speed is measured by a quick frame first. ABBE_INVALID_ARGUMENT for the thesis profile. */
abbe_result abbe_preset_options_resolve(abbe_preset_options *options, abbe_context *context,
                                        const abbe_scene *scene, bool timed, abbe_render_desc *desc,
                                        abbe_error *error);
void abbe_preset_options_free(abbe_preset_options *options);

/* Adds "promise" to the statistics: what was chosen, promised and met; nothing where nothing was
 * asked for. `estimate` is the caustic's mean CIEDE2000 by the picture's error bars; below 0: not
 * known. */
void abbe_preset_options_describe(const abbe_preset_options *options,
                                  const abbe_statistics *statistics, double estimate,
                                  struct cJSON *root);
/* Says on stderr what was chosen, and what cannot be kept. */
void abbe_preset_options_note(const abbe_preset_options *options);

#endif
