#include "cli/render/render_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "gl/accuracy/frame_times.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { OPTION_PRESET = 0x600, OPTION_FOR, OPTION_TOOL };

static const abbe_option options[] = {
    {"preset", OPTION_PRESET, "NAME", 0, "draft, balanced or accurate, as measured for such scenes",
     2, ABBE_TAKE_BY_KEY},
    {"max-error", 0, "E", 0,
     "the fastest tool and settings that promise a mean CIEDE2000 of at most E in the caustic; "
     "what "
     "is traced goes on until its own passes tell that",
     2, ABBE_TAKE_NUMBER(abbe_preset_options, request.max_error, 1e-6, 1e6)},
    {"budget-ms", 0, "T", 0,
     "the most accurate tool and settings that take at most T ms on this machine", 2,
     ABBE_TAKE_NUMBER(abbe_preset_options, request.budget_ms, 1e-3, 1e9)},
    {"for", OPTION_FOR, "picture|frame", 0,
     "whose time these mean: this picture's, from the start of the program to its end, or a "
     "frame's "
     "once the scene stands (picture)",
     2, ABBE_TAKE_BY_KEY},
    {"tool", OPTION_TOOL, "NAME", 0,
     "for these: render, trace or trace-filter (whatever serves best)", 2, ABBE_TAKE_BY_KEY},
    {"presets", 0, "FILE", ABBE_ARGUMENT_READS, "others than the shipped ones", 2,
     ABBE_TAKE_TEXT(abbe_preset_options, request.file)},
    {0}};

#define ABBE_NAME_OF(code, name) name,
static const char *const names[] = {ABBE_PRESETS(ABBE_NAME_OF)};
#define ABBE_TOOL_OF(code, name) name,
static const char *const tools[] = {ABBE_PICTURE_TOOLS(ABBE_TOOL_OF)};
static const char *const times[] = {"picture", "frame"};

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_preset_options *o = state->input;
  abbe_preset_request *q = &o->request;
  int asked;
  switch (key) {
  case OPTION_PRESET:
    q->name = names[abbe_command_choice(o->program, "--preset", text, names, ABBE_PRESET_COUNT)];
    return 0;
  case OPTION_FOR:
    o->of_frame = abbe_command_choice(o->program, "--for", text, times, 2) == 1;
    o->of_picture = !o->of_frame;
    return 0;
  case OPTION_TOOL:
    o->tool = abbe_command_choice(o->program, "--tool", text, tools, ABBE_PICTURE_TOOL_COUNT);
    return 0;
  case ARGP_KEY_END:
    asked = (q->name != NULL) + (q->max_error > 0) + (q->budget_ms > 0);
    if (q->file != NULL && asked == 0)
      argp_error(state,
                 "--presets '%s' is a file for --preset, --max-error or --budget-ms to read "
                 "from, and none of them is given",
                 q->file);
    if (asked == 0 && (o->of_frame || o->of_picture || o->tool >= 0))
      argp_error(state, "--for and --tool go with --preset, --max-error or --budget-ms");
    if (o->of_frame && o->tool > 0)
      argp_error(state, "--for frame chooses settings of the renderer; --tool %s makes no frames",
                 tools[o->tool]);
    if (asked > 1) argp_error(state, "--preset, --max-error and --budget-ms: one of them");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const abbe_parser abbe_preset_options_argp = {.options = options, .parse = parse};

static void add_unrest(double unrest, cJSON *p) {
  if (isfinite(unrest)) cJSON_AddNumberToObject(p, "unrest", unrest);
}

/* On a busy machine, before the work begins. */
static void note_unrest(double unrest) {
  char text[120];
  abbe_frame_times_say_unrest(unrest, "note: ", text, sizeof text);
  if (*text != '\0') fprintf(stderr, "%s; times may not be kept\n", text);
}

void abbe_preset_options_describe(const abbe_preset_choice *c, const abbe_statistics *s,
                                  double estimate, cJSON *root) {
  char text[200];
  if (c->point == NULL) return;
  const abbe_preset_point *point = c->point;
  const abbe_preset_request *q = &c->request;
  cJSON *p = cJSON_AddObjectToObject(root, "promise");
  if (q->name != NULL) cJSON_AddStringToObject(p, "preset", q->name);
  if (q->max_error > 0) cJSON_AddNumberToObject(p, "max_error", q->max_error);
  if (q->budget_ms > 0) cJSON_AddNumberToObject(p, "budget_ms", q->budget_ms);
  abbe_preset_describe(&point->desc, text, sizeof text);
  cJSON_AddStringToObject(p, "settings", text);
  cJSON_AddStringToObject(p, "class", abbe_preset_class_name(c->front->of));
  cJSON_AddStringToObject(p, "measured_on", c->front->scenes);
  cJSON_AddStringToObject(p, "run", c->presets.run);
  cJSON_AddBoolToObject(p, "possible", c->kept);
  cJSON_AddBoolToObject(p, "overridden", c->overridden);
  cJSON_AddStringToObject(p, "error_name", c->presets.error);
  cJSON_AddNumberToObject(p, "error", point->error);
  cJSON_AddNumberToObject(p, "error_at_worst", point->worst);
  cJSON_AddNumberToObject(p, "error_at_best", point->least);
  cJSON_AddNumberToObject(p, "margin", c->front->margin);
  cJSON_AddNumberToObject(p, "margin_scenes", (double)c->front->margin_scenes);
  /* Only a reference gives the error: abbe sweep, abbe compare. */
  if (estimate >= 0 && strcmp(c->presets.error, "caustic_de") == 0) {
    cJSON_AddNumberToObject(p, "error_met", estimate);
    cJSON_AddStringToObject(p, "error_met_is", "an estimate by error bars: sampling alone");
  } else {
    cJSON_AddNullToObject(p, "error_met");
  }
  if (c->timed) cJSON_AddNumberToObject(p, "ms", c->promised_ms);
  if (c->timed) add_unrest(c->unrest, p);
  cJSON_AddNumberToObject(p, "ms_met", s->frame_ms);
  if (q->budget_ms > 0) cJSON_AddBoolToObject(p, "budget_met", s->frame_ms <= q->budget_ms);
}

void abbe_preset_options_describe_picture(const abbe_picture_choice *c, double ms, double error_met,
                                          cJSON *root) {
  char text[300];
  if (c->point == NULL) return;
  const abbe_picture_point *point = c->point;
  const abbe_picture_request *q = &c->request;
  cJSON *p = cJSON_AddObjectToObject(root, "promise");
  cJSON_AddStringToObject(p, "for", "picture");
  if (q->name != NULL) cJSON_AddStringToObject(p, "preset", q->name);
  if (q->max_error > 0) cJSON_AddNumberToObject(p, "max_error", q->max_error);
  if (q->budget_ms > 0) cJSON_AddNumberToObject(p, "budget_ms", q->budget_ms);
  abbe_picture_describe(point, text, sizeof text);
  cJSON_AddStringToObject(p, "tool", abbe_picture_tool_name(point->tool));
  cJSON_AddStringToObject(p, "settings", text);
  cJSON_AddStringToObject(p, "class", abbe_preset_class_name(c->front.of));
  cJSON_AddStringToObject(p, "measured_on", c->front.scenes);
  cJSON_AddBoolToObject(p, "possible", c->kept);
  cJSON_AddNumberToObject(p, "error", c->promised_error);
  cJSON_AddNumberToObject(p, "margin", c->front.margin[point->tool]);
  cJSON_AddNumberToObject(p, "margin_scenes", (double)c->front.margin_scenes);
  const bool told = abbe_picture_choice_tells(c);
  cJSON_AddBoolToObject(p, "checked", told || error_met >= 0);
  if (error_met >= 0) {
    cJSON_AddNumberToObject(p, "error_met", error_met);
    cJSON_AddStringToObject(p, "error_met_is",
                            !told       ? "an estimate by error bars: sampling alone"
                            : c->others ? "an estimate by traced passes"
                                        : "an estimate by half of its passes");
  } else {
    cJSON_AddNullToObject(p, "error_met");
  }
  abbe_picture_choice_say_error(c, text, sizeof text);
  cJSON_AddStringToObject(p, "error_is", text);
  if (c->passes > 0) cJSON_AddNumberToObject(p, "passes", (double)c->passes);
  if (c->passes > 0) cJSON_AddBoolToObject(p, "traced_instead", c->traced_instead);
  if (told) {
    cJSON_AddNumberToObject(p, "error_at_most", c->met.bound);
    if (q->max_error > 0) cJSON_AddBoolToObject(p, "error_kept", c->met.bound <= q->max_error);
  }
  if (c->timed) cJSON_AddNumberToObject(p, "ms", c->promised_ms);
  if (c->timed) add_unrest(c->unrest, p);
  cJSON_AddNumberToObject(p, "ms_met", ms);
  if (q->budget_ms > 0) cJSON_AddBoolToObject(p, "budget_met", ms <= q->budget_ms);
}

void abbe_preset_options_note_overridden(bool overridden) {
  if (overridden)
    fprintf(stderr,
            "note: options, or a mirror or an eye in glass, stand against that choice; what it "
            "promises is void\n");
}

void abbe_preset_options_note_picture(const abbe_picture_choice *c) {
  char text[300];
  if (c->point == NULL) return;
  const abbe_picture_point *point = c->point;
  abbe_picture_describe(point, text, sizeof text);
  fprintf(stderr,
          "note: %s; a mean CIEDE2000 of at most %.3g in the caustic is %s, by what was measured "
          "on %s",
          text, c->promised_error, c->request.max_error > 0 ? "promised" : "expected",
          c->front.scenes);
  if (c->timed) fprintf(stderr, "; %.0f ms from start to end are promised", c->promised_ms);
  fprintf(stderr, "\n");
  note_unrest(c->unrest);
  if (!c->kept && c->request.max_error > 0)
    fprintf(stderr, "note: nothing is known to keep %g; this is the most accurate\n",
            c->request.max_error);
  if (!c->kept && c->request.budget_ms > 0)
    fprintf(stderr, "note: nothing is known to take %g ms here; this is the fastest\n",
            c->request.budget_ms);
}

void abbe_preset_options_note_error(const abbe_picture_choice *c) {
  char text[300];
  if (c->point == NULL) return;
  const bool told = abbe_picture_choice_tells(c), own = c->point->tool != ABBE_PICTURE_RENDER;
  abbe_picture_choice_say_error(c, text, sizeof text);
  fprintf(stderr, "note: the error is %s", text);
  if (c->traced_instead)
    fprintf(stderr, ", of what they made; it is taken, for the rendered picture's is not known to "
                    "be that small");
  else if (told && own && !c->others && c->passes > c->point->passes)
    fprintf(stderr, "; %zu were too few for what is asked", c->point->passes);
  else if (told && c->met.estimate > c->promised_error)
    fprintf(stderr, "; that is more, for this scene's light is of another kind");
  fprintf(stderr, "\n");
}

void abbe_preset_options_note(const abbe_preset_choice *c) {
  char text[200];
  if (c->point == NULL) return;
  const abbe_preset_point *point = c->point;
  const abbe_preset_request *q = &c->request;
  abbe_preset_describe(&point->desc, text, sizeof text);
  fprintf(stderr, "note: %s; %s was %.3g to %.3g on %s, and at most %.3g is promised", text,
          c->presets.error_text, point->least, point->worst, c->front->scenes, point->error);
  if (c->timed) fprintf(stderr, "; %.0f ms are promised", c->promised_ms);
  fprintf(stderr, "\n");
  note_unrest(c->unrest);
  abbe_preset_options_note_overridden(c->overridden);
  if (!c->kept && q->max_error > 0)
    fprintf(stderr, "note: no settings are known to keep %g; these are the most accurate\n",
            q->max_error);
  if (!c->kept && q->budget_ms > 0)
    fprintf(stderr, "note: no settings are known to take %g ms here; these are the fastest\n",
            q->budget_ms);
}
