/* error_options.h: a picture's own error: --error-bars and what is written of it.
 * Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_ERROR_OPTIONS_H
#define ABBE_CLI_RENDER_ERROR_OPTIONS_H

#include "gl/accuracy/error_bars.h"

#include <argp.h>
#include <stdbool.h>

struct cJSON;

typedef struct abbe_error_options {
  const char *program; /* "abbe render" */
  const char *png;     /* the errors in false colours, or NULL */
  bool asked, mean;
  size_t variants; /* 0: the default */
} abbe_error_options;

/* An argp child: --error-bars, --error-png, --mean. Its input is an abbe_error_options with program
 * set. */
extern const struct argp abbe_error_options_argp;

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

#endif
