#include "cli/render/render_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/options/picture_options.h"
#include "gl/plan/facts/render_desc.h"
#include "scenes/volume/caustic_volume.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Keys of the table's settings begin where the others end. */
enum { OPTION_POLYGONS = 0x100, OPTION_OBSERVER, OPTION_SETTING };

static const abbe_option others[] = {
    {"size", 0, "WxH", 0, "pixels; the scene's own without", 1,
     ABBE_TAKE_SIZE(abbe_render_options, desc.width, desc.height, ABBE_RENDER_MAX_SIDE)},
    {"range", 0, "FROM:TO", 0, "wavelengths in nm (380:780)", 1,
     ABBE_TAKE_RANGE(abbe_render_options, desc.min_nm, desc.max_nm)},
    {"observer", OPTION_OBSERVER, "NAME", 0, ABBE_OBSERVER_HELP, 1, ABBE_TAKE_BY_KEY},
    {"volume", 0, "FILE.exr", ABBE_ARGUMENT_READS,
     "the caustic volume that caustics are looked up in", 1,
     ABBE_TAKE_TEXT(abbe_render_options, volume_path)},
    {"materials", 0, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1,
     ABBE_TAKE_TEXT(abbe_render_options, materials)},
    ABBE_OPTIONS(abbe_render_options, &abbe_scene_input_options, changes, NULL, 0),
    ABBE_OPTIONS(abbe_render_options, &abbe_studio_options, changes, NULL, 0),
    {"alpha", 0, NULL, 0, ABBE_SCENE_INPUT_ALPHA_HELP, 1,
     ABBE_TAKE_FLAG(abbe_render_options, changes.alpha)}};
static const abbe_option others_aside[] = {
    {"unfilled", 0, NULL, 0, "of thesis, the map before its fill", 1,
     ABBE_TAKE_FLAG(abbe_render_options, unfilled)},
    {"polygons", OPTION_POLYGONS, "LIST", 0,
     "of wyman2006's quads and triangles: even beams, light by corners, those between surfaces "
     "culled, drawn in-light, such as corners,culled (none)",
     1, ABBE_TAKE_BY_KEY}};

enum {
  OTHERS = sizeof others / sizeof *others,
  ASIDE = sizeof others_aside / sizeof *others_aside,
  MOST_OPTIONS = 64,
  HELP_SIZE = 320
};

/* What a choice may be, but for what is taken without it. */
static size_t list_names(const abbe_render_setting *s, char *out, size_t size) {
  size_t used = 0;
  out[0] = '\0';
  for (size_t i = 0; i < s->name_count; i++) {
    if (strcmp(s->names[i], "auto") == 0 || strcmp(s->names[i], "default") == 0) continue;
    if (used < size)
      used += (size_t)snprintf(out + used, size - used, "%s%s", used > 0 ? ", " : "", s->names[i]);
  }
  return used;
}

/* A setting's help, with its range or names and its default. */
static void describe(const abbe_render_setting *s, char out[HELP_SIZE]) {
  char range[HELP_SIZE] = "";
  const size_t length = strlen(s->help);
  if (s->kind == ABBE_SETTING_COUNT)
    snprintf(range, sizeof range, ", %.0f to %.0f", s->least, s->most);
  else if (s->kind == ABBE_SETTING_CHOICE && length > 1 && s->help[length - 2] == ':')
    list_names(s, range, sizeof range);
  snprintf(out, HELP_SIZE, s->default_ != NULL ? "%s%s (%s)" : "%s%s", s->help, range, s->default_);
}

/* Options of the settings that are shown aside, or of the others; flags are argp's, of each.
 * Returns how many there are. */
static size_t list_settings(bool aside, int flags, abbe_option *out) {
  static char help[MOST_OPTIONS][HELP_SIZE];
  static const char *const arguments[] = {
      [ABBE_SETTING_COUNT] = "N", [ABBE_SETTING_NUMBER] = "X", [ABBE_SETTING_CHOICE] = "NAME"};
  size_t count = 0;
  for (size_t i = 0; i < abbe_render_settings_count && i < MOST_OPTIONS; i++) {
    const abbe_render_setting *s = &abbe_render_settings[i];
    if (s->option == NULL || s->aside != aside) continue;
    describe(s, help[i]);
    out[count++] =
        (abbe_option){s->option, OPTION_SETTING + (int)i, arguments[s->kind], flags, help[i],
                      1,         ABBE_TAKE_BY_KEY};
  }
  return count;
}

#define NAME_OF(code, name, bit) name,
#define BIT_OF(code, name, bit) bit,

/* A list of words, as bits. */
static unsigned read_polygons(const char *program, const char *text) {
  static const char *const names[] = {ABBE_POLYGONS(NAME_OF)};
  static const unsigned bits[] = {ABBE_POLYGONS(BIT_OF)};
  enum { COUNT = sizeof names / sizeof *names };
  unsigned all = 0;
  for (const char *at = text; at != NULL;) {
    const size_t length = strcspn(at, ",");
    char word[32];
    snprintf(word, sizeof word, "%.*s", (int)length, at);
    all |= bits[abbe_command_choice(program, "--polygons", word, names, COUNT)];
    at = at[length] == ',' ? at + length + 1 : NULL;
  }
  return all;
}

static void take_setting(const abbe_render_setting *s, const char *text, const char *program,
                         abbe_render_desc *desc) {
  char option[32];
  void *value = abbe_render_setting_in(s, desc);
  snprintf(option, sizeof option, "--%s", s->option);
  switch (s->kind) {
  case ABBE_SETTING_COUNT:
    *(size_t *)value =
        abbe_command_count(program, option, text, (unsigned long)s->least, (unsigned long)s->most);
    break;
  case ABBE_SETTING_NUMBER:
    *(double *)value = abbe_command_number(program, option, text, s->least, s->most);
    break;
  case ABBE_SETTING_CHOICE:
    *(int *)value = abbe_command_choice(program, option, text, s->names, (int)s->name_count);
    break;
  case ABBE_SETTING_FLAG:
    *(bool *)value = true;
    break;
  }
}

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_render_options *o = state->input;
  abbe_render_desc *d = &o->desc;
  const char *p = o->program;
  if (key >= OPTION_SETTING && key < OPTION_SETTING + (int)abbe_render_settings_count) {
    take_setting(&abbe_render_settings[key - OPTION_SETTING], text, p, d);
    return 0;
  }
  switch (key) {
  case OPTION_POLYGONS:
    d->polygons = read_polygons(p, text);
    return 0;
  case OPTION_OBSERVER:
    d->observer = abbe_spectral_options_observer(p, text);
    return 0;
  case ARGP_KEY_ARG:
    abbe_scene_input_take_file(&o->changes, &o->scene, text, state);
    return 0;
  case ARGP_KEY_END:
    if (o->scene == NULL)
      argp_error(
          state,
          "which scene? Give a file such as scenes/gem.yaml, or a stone's such as round.asc");
    o->changes.studio.columns = d->width;
    o->changes.studio.rows = d->height;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static abbe_option options[OTHERS + MOST_OPTIONS];
const abbe_parser abbe_render_options_argp = {
    .options = options, .parse = parse, .args_doc = "SCENE.yaml\nSTONE.asc..."};

void abbe_render_options_begin(void) {
  memcpy(options, others, sizeof others);
  size_t count = OTHERS + list_settings(false, 0, options + OTHERS);
  count += list_settings(true, OPTION_HIDDEN, options + count);
  for (int i = 0; i < ASIDE; i++) {
    options[count + i] = others_aside[i];
    options[count + i].flags |= OPTION_HIDDEN;
  }
}

const abbe_option *abbe_render_options_aside(void) {
  static abbe_option aside[MOST_OPTIONS];
  const size_t count = list_settings(true, 0, aside);
  memcpy(aside + count, others_aside, sizeof others_aside);
  for (size_t i = 0; i < count + ASIDE; i++) aside[i].take.kind = 0;
  return aside;
}

abbe_result abbe_render_options_load_volume(abbe_render_options *request, abbe_error *error) {
  if (request->volume_path == NULL) return ABBE_OK;
  ABBE_TRY(abbe_volume_file_read(request->volume_path, &request->volume, error));
  request->desc.volume = &request->volume;
  return ABBE_OK;
}

int abbe_render_options_end(const abbe_render_options *request, bool scene_loaded,
                            abbe_result result, abbe_error *error) {
  int code = abbe_command_end(request->program, result, error);
  return scene_loaded && result == ABBE_INVALID_ARGUMENT ? ABBE_EXIT_USAGE : code;
}

enum { OPTION_ERROR_BARS = 0x700 };

static const abbe_option error_options[] = {
    {"error-bars", OPTION_ERROR_BARS, "N", OPTION_ARG_OPTIONAL,
     "layers stderr.*: what sampling leaves out, one standard error a pixel, from N variants of "
     "the "
     "picture (4) and a coarse one: as many more frames",
     4, ABBE_TAKE_BY_KEY},
    {"error-png", 0, "FILE.png", ABBE_ARGUMENT_WRITES, "the errors in false colours", 4,
     ABBE_TAKE_TARGET(abbe_error_options, png, ".png")},
    {"mean", 0, NULL, 0,
     "the picture is its mean with the variants, with that one's errors: nearer to the truth", 4,
     ABBE_TAKE_FLAG(abbe_error_options, mean)},
    {0}};

static error_t error_options_parse(int key, char *text, struct argp_state *state) {
  abbe_error_options *o = state->input;
  switch (key) {
  case OPTION_ERROR_BARS:
    o->asked = true;
    if (text != NULL)
      o->variants =
          abbe_command_count(o->program, "--error-bars", text, 2, ABBE_ERROR_BARS_MAX_VARIANTS);
    return 0;
  case ARGP_KEY_END:
    if (!o->asked && (o->png != NULL || o->mean))
      argp_error(state, "%s goes with --error-bars", o->mean ? "--mean" : "--error-png");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const abbe_parser abbe_error_options_argp = {.options = error_options,
                                             .parse = error_options_parse};

static abbe_result put(const abbe_error_options *o, const abbe_error_bars *bars,
                       abbe_image *picture, abbe_error *error) {
  char text[160];
  for (size_t p = 0; o->mean && p < picture->width * picture->height; p++)
    memcpy(picture->data + p * picture->channels, bars->mean.data + 3 * p, 3 * sizeof(float));
  snprintf(text, sizeof text,
           "of %s, from %zu variants and a coarse picture; what is not modelled is not in them",
           o->mean ? "the mean" : "the picture", bars->variants);
  ABBE_TRY(abbe_image_set_attribute(picture, "abbe:stderr", text, error));
  return abbe_error_bars_attach(bars, picture, error);
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
