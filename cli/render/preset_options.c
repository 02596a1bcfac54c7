#include "cli/render/preset_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "validation/sweep/sweep.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

enum { OPTION_PRESET = 0x600, OPTION_MAX_ERROR, OPTION_BUDGET, OPTION_PRESETS };

static const struct argp_option options[] = {
    {"preset", OPTION_PRESET, "NAME", 0, "draft, balanced or accurate, as measured for such scenes",
     2},
    {"max-error", OPTION_MAX_ERROR, "E", 0,
     "the fastest settings whose mean CIEDE2000 in the caustic was at most E", 2},
    {"budget-ms", OPTION_BUDGET, "T", 0,
     "the most accurate settings that take at most T ms on this machine", 2},
    {"presets", OPTION_PRESETS, "FILE", ABBE_ARGUMENT_READS, "others than the shipped ones", 2},
    {0}};

#define ABBE_NAME_OF(code, name) name,
static const char *const names[] = {ABBE_PRESETS(ABBE_NAME_OF)};

static bool is_asked(const abbe_preset_options *o) {
  return o->name != NULL || o->max_error > 0 || o->budget_ms > 0;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_preset_options *o = state->input;
  switch (key) {
  case OPTION_PRESET:
    o->name = names[abbe_command_choice(o->program, "--preset", text, names, ABBE_PRESET_COUNT)];
    return 0;
  case OPTION_MAX_ERROR:
    o->max_error = abbe_command_number(o->program, "--max-error", text, 1e-6, 1e6);
    return 0;
  case OPTION_BUDGET:
    o->budget_ms = abbe_command_number(o->program, "--budget-ms", text, 1e-3, 1e9);
    return 0;
  case OPTION_PRESETS:
    o->file = text;
    return 0;
  case ARGP_KEY_END:
    if (o->file != NULL && !is_asked(o))
      argp_error(state,
                 "--presets '%s' is a file for --preset, --max-error or --budget-ms to read "
                 "from, and none of them is given",
                 o->file);
    if ((o->name != NULL) + (o->max_error > 0) + (o->budget_ms > 0) > 1)
      argp_error(state, "--preset, --max-error and --budget-ms: one of them");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const struct argp abbe_preset_options_argp = {options, parse, NULL, NULL, NULL, NULL, NULL};

static abbe_result find_named(abbe_preset_options *o, abbe_error *error) {
  int i = 0;
  while (names[i] != o->name) i++;
  o->point = o->front->named[i];
  if (o->point < o->front->count) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_NOT_FOUND, "there is no '%s' for scenes of the class %s in %s%s", o->name,
      abbe_preset_class_name(o->front->of), o->file != NULL ? o->file : "the shipped presets",
      i == ABBE_PRESET_ACCURATE ? ": no sweep of one measured settings finer than the defaults"
                                : "");
}

abbe_result abbe_preset_options_resolve(abbe_preset_options *o, abbe_context *context,
                                        const abbe_scene *scene, bool timed, abbe_render_desc *desc,
                                        abbe_error *error) {
  abbe_plan plan;
  abbe_preset_speed speed = {0};
  if (!is_asked(o)) return ABBE_OK;
  if (desc->profile != ABBE_PROFILE_DEFAULT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "presets are of the default profile; a thesis profile has none");
  abbe_result result = abbe_presets_load(o->file, &o->presets, error);
  if (result == ABBE_OK) result = abbe_plan_make(scene, desc, &plan, error);
  if (result != ABBE_OK) return result;
  result = abbe_presets_find(&o->presets, &plan, &o->front, error);
  abbe_plan_free(&plan);
  o->timed = timed || o->budget_ms > 0;
  if (result == ABBE_OK && o->name != NULL) result = find_named(o, error);
  if (result == ABBE_OK && o->timed)
    result = abbe_preset_calibrate(context, scene, o->front, desc, &speed, error);
  if (result != ABBE_OK) return result;
  o->chosen = o->kept = true;
  if (o->budget_ms > 0)
    o->point = abbe_preset_for_time(o->front, &speed, o->budget_ms, &o->kept);
  else if (o->max_error > 0)
    o->point = abbe_preset_for_error(o->front, o->max_error, &o->kept);
  const abbe_preset_point *point = &o->front->point[o->point];
  o->promised_ms = abbe_preset_ms(point, &speed);
  o->overridden = !abbe_preset_apply(point, desc);
  return ABBE_OK;
}

void abbe_preset_options_free(abbe_preset_options *o) {
  abbe_presets_free(&o->presets);
}

static void describe_point(const abbe_preset_options *o, char *out, size_t size) {
  abbe_sweep_setting setting;
  abbe_sweep_setting_of(&o->front->point[o->point].desc, &setting);
  abbe_sweep_setting_describe(&setting, out, size);
}

void abbe_preset_options_describe(const abbe_preset_options *o, const abbe_statistics *s,
                                  double estimate, cJSON *root) {
  char text[200];
  if (!o->chosen) return;
  const abbe_preset_point *point = &o->front->point[o->point];
  cJSON *p = cJSON_AddObjectToObject(root, "promise");
  if (o->name != NULL) cJSON_AddStringToObject(p, "preset", o->name);
  if (o->max_error > 0) cJSON_AddNumberToObject(p, "max_error", o->max_error);
  if (o->budget_ms > 0) cJSON_AddNumberToObject(p, "budget_ms", o->budget_ms);
  describe_point(o, text, sizeof text);
  cJSON_AddStringToObject(p, "settings", text);
  cJSON_AddStringToObject(p, "class", abbe_preset_class_name(o->front->of));
  cJSON_AddStringToObject(p, "measured_on", o->front->scenes);
  cJSON_AddStringToObject(p, "run", o->presets.run);
  cJSON_AddBoolToObject(p, "possible", o->kept);
  cJSON_AddBoolToObject(p, "overridden", o->overridden);
  cJSON_AddStringToObject(p, "error_name", o->presets.error);
  cJSON_AddNumberToObject(p, "error", point->error);
  cJSON_AddNumberToObject(p, "error_at_worst", point->worst);
  cJSON_AddNumberToObject(p, "error_at_best", point->least);
  cJSON_AddNumberToObject(p, "margin", o->front->margin);
  cJSON_AddNumberToObject(p, "margin_scenes", (double)o->front->margin_scenes);
  /* Only a reference tells the error: abbe sweep, abbe compare. */
  if (estimate >= 0 && strcmp(o->presets.error, "caustic_de") == 0) {
    cJSON_AddNumberToObject(p, "error_met", estimate);
    cJSON_AddStringToObject(p, "error_met_is", "an estimate by error bars: sampling alone");
  } else {
    cJSON_AddNullToObject(p, "error_met");
  }
  if (o->timed) cJSON_AddNumberToObject(p, "ms", o->promised_ms);
  cJSON_AddNumberToObject(p, "ms_met", s->frame_ms);
  if (o->budget_ms > 0) cJSON_AddBoolToObject(p, "budget_met", s->frame_ms <= o->budget_ms);
}

void abbe_preset_options_note(const abbe_preset_options *o) {
  char text[200];
  if (!o->chosen) return;
  const abbe_preset_point *point = &o->front->point[o->point];
  describe_point(o, text, sizeof text);
  fprintf(stderr, "note: %s; %s was %.3g to %.3g on %s, and at most %.3g is promised", text,
          o->presets.error_text, point->least, point->worst, o->front->scenes, point->error);
  if (o->timed) fprintf(stderr, "; %.0f ms are promised", o->promised_ms);
  fprintf(stderr, "\n");
  if (o->overridden)
    fprintf(stderr, "note: options stand against that choice; what it promises is void\n");
  if (!o->kept && o->max_error > 0)
    fprintf(stderr, "note: no settings are known to keep %g; these are the most accurate\n",
            o->max_error);
  if (!o->kept && o->budget_ms > 0)
    fprintf(stderr, "note: no settings are known to take %g ms here; these are the fastest\n",
            o->budget_ms);
}
