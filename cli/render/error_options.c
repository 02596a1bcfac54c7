#include "cli/render/render_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "gl/accuracy/error_bars.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

enum { OPTION_ERROR_BARS = 0x700, OPTION_ERROR_PNG, OPTION_MEAN };

static const struct argp_option options[] = {
    {"error-bars", OPTION_ERROR_BARS, "N", OPTION_ARG_OPTIONAL,
     "layers stderr.*: what sampling leaves out, one standard error a pixel, from N variants of "
     "the "
     "picture (4) and a coarse one: as many more frames",
     4},
    {"error-png", OPTION_ERROR_PNG, "FILE.png", ABBE_ARGUMENT_WRITES, "the errors in false colours",
     4},
    {"mean", OPTION_MEAN, NULL, 0,
     "the picture is its mean with the variants, with that one's errors: nearer to the truth", 4},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_error_options *o = state->input;
  switch (key) {
  case OPTION_ERROR_BARS:
    o->asked = true;
    if (text != NULL)
      o->variants =
          abbe_command_count(o->program, "--error-bars", text, 2, ABBE_ERROR_BARS_MAX_VARIANTS);
    return 0;
  case OPTION_ERROR_PNG:
    o->png = abbe_command_target(state->name, "--error-png", text, ".png");
    return 0;
  case OPTION_MEAN:
    o->mean = true;
    return 0;
  case ARGP_KEY_END:
    if (!o->asked && (o->png != NULL || o->mean))
      argp_error(state, "%s goes with --error-bars", o->mean ? "--mean" : "--error-png");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const struct argp abbe_error_options_argp = {options, parse, NULL, NULL, NULL, NULL, NULL};

static abbe_result put(const abbe_error_options *o, const abbe_error_bars *bars,
                       abbe_image *picture, abbe_error *error) {
  char text[160];
  for (size_t p = 0; o->mean && p < picture->width * picture->height; p++)
    memcpy(picture->data + p * picture->channels, bars->mean.data + 3 * p, 3 * sizeof(float));
  snprintf(text, sizeof text,
           "of %s, from %zu variants and a coarse picture; what is not modelled is not in them",
           o->mean ? "the mean" : "the picture", bars->variants);
  abbe_result result = abbe_image_set_attribute(picture, "abbe:stderr", text, error);
  if (result == ABBE_OK) result = abbe_error_bars_attach(bars, picture, error);
  return result;
}

abbe_result abbe_error_options_work(const abbe_error_options *o, abbe_context *context,
                                    const abbe_scene *scene, abbe_renderer *renderer, bool quiet,
                                    abbe_image *picture, abbe_error_bars *out, abbe_error *error) {
  if (!o->asked) return ABBE_OK;
  abbe_progress progress;
  abbe_error_bars_desc desc = {.variants = o->variants,
                               .of_mean = o->mean,
                               .progress = abbe_progress_update,
                               .user = &progress};
  abbe_progress_begin(&progress, "error bars", quiet);
  abbe_result result = abbe_error_bars_make(context, scene, renderer, &desc, out, error);
  abbe_progress_end(&progress);
  if (result == ABBE_OK) result = put(o, out, picture, error);
  if (result == ABBE_OK && o->png != NULL) result = abbe_error_picture_write(o->png, out, error);
  return result;
}

static void describe_region(const abbe_error_bars_summary *s, const char *name, cJSON *bars) {
  if (s->pixels == 0) return;
  cJSON *region = cJSON_AddObjectToObject(bars, name);
  cJSON_AddNumberToObject(region, "pixels", (double)s->pixels);
  cJSON_AddNumberToObject(region, "relative_rmse", s->relative_rmse);
  cJSON_AddNumberToObject(region, "ciede2000_mean", s->ciede2000);
}

void abbe_error_options_describe(const abbe_error_options *o, const abbe_error_bars *bars,
                                 cJSON *root) {
  if (!o->asked) return;
  cJSON *object = cJSON_AddObjectToObject(root, "error_bars");
  cJSON_AddStringToObject(object, "of", o->mean ? "mean" : "picture");
  cJSON_AddStringToObject(object, "sees", "sampling and reconstruction, not the model");
  cJSON_AddNumberToObject(object, "variants", (double)bars->variants);
  cJSON_AddNumberToObject(object, "frames", (double)bars->frames);
  cJSON_AddNumberToObject(object, "ms", bars->ms);
  describe_region(&bars->caustic, "caustic", object);
  describe_region(&bars->whole, "picture", object);
}

void abbe_error_options_summarise(const abbe_error_options *o, const abbe_error_bars *bars) {
  if (!o->asked) return;
  bool caustic = bars->caustic.pixels > 0;
  const abbe_error_bars_summary *s = caustic ? &bars->caustic : &bars->whole;
  fprintf(stderr,
          "estimated error of the %s%s: %.2g %% of its mean, CIEDE2000 %.2g; what is not modelled "
          "is not in it (%zu more frames, %.1f s)\n",
          o->mean ? "mean's " : "", caustic ? "caustic" : "picture", 100 * s->relative_rmse,
          s->ciede2000, bars->frames, bars->ms / 1000);
}
