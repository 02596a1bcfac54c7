#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include "validation/measure/outline.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>

enum { OPTION_MINUS = 0x100, OPTION_SHARE, OPTION_BLUR, OPTION_JSON };

typedef struct request {
  const char *program, *file[2], *minus;
  int files;
  abbe_outline_options outline;
  bool json;
} request;

static const struct argp_option options[] = {
    {"minus", OPTION_MINUS, "DARK.exr", ABBE_ARGUMENT_READS,
     "the last picture without its caustic, to take off", 0},
    {"share", OPTION_SHARE, "X", 0, "of the light inside the outline (0.9)", 0},
    {"blur", OPTION_BLUR, "PIXELS", 0, "smoothing before all else, 0 to 64 (1)", 0},
    {"json", OPTION_JSON, NULL, 0, "as JSON", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TEXT(request, OPTION_MINUS, minus),
    ABBE_TAKE_NUMBER(request, OPTION_SHARE, outline.share, 0.001, 1),
    ABBE_TAKE_FLAG(request, OPTION_JSON, json),
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  if (abbe_take_option(takes, key, text, state)) return 0;
  switch (key) {
  case OPTION_BLUR:
    q->outline.blur = abbe_command_number(q->program, "--blur", text, 0, 64);
    if (q->outline.blur == 0) q->outline.blur = -1;
    return 0;
  case ARGP_KEY_ARG:
    if (q->files == 2) argp_error(state, "two pictures at the most; '%s' is one too many", text);
    q->file[q->files++] = text;
    return 0;
  case ARGP_KEY_END:
    if (q->files == 0) argp_error(state, "which picture? Give one or two OpenEXR files");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static void print_text(const abbe_outline o[2], int count, const abbe_outline_agreement *a) {
  printf("%-28s", "");
  for (int i = 0; i < count; i++) printf("  %-26s", count == 1 ? "" : i == 0 ? "first" : "second");
  printf("%s\n%-28s", count == 2 ? "  agreement" : "", "light");
  for (int i = 0; i < count; i++) printf("  %-26.6g", o[i].light);
  if (count == 2) printf("  second / first %.4f", a->light_ratio);
  printf("\n%-28s", "inside the outline, pixels");
  for (int i = 0; i < count; i++) printf("  %-26zu", o[i].mask.inside);
  if (count == 2)
    printf("  overlap %.3f, apart %.2f pixels (95 %%: %.2f)", a->overlap, a->mean_apart,
           a->p95_apart);
  printf("\n%-28s", "tinted share");
  for (int i = 0; i < count; i++) printf("  %-26.3f", o[i].tinted);
  printf("\n");
  for (int h = 0; h < ABBE_OUTLINE_HUE_COUNT; h++) {
    printf("%-28s", abbe_outline_hue_name((abbe_outline_hue)h));
    for (int i = 0; i < count; i++) {
      const abbe_outline_place *p = &o[i].place[h];
      printf("  %5.1f %% at %6.1f, %6.1f    ", 100 * p->share, p->x, p->y);
    }
    if (count == 2) printf("  overlap %.3f, apart %.2f pixels", a->hue[h].overlap, a->hue[h].apart);
    printf("\n");
  }
}

static cJSON *describe(const char *path, const abbe_outline *o) {
  cJSON *root = cJSON_CreateObject(), *hues = cJSON_CreateArray();
  cJSON_AddStringToObject(root, "file", path);
  cJSON_AddNumberToObject(root, "light", o->light);
  cJSON_AddNumberToObject(root, "tinted", o->tinted);
  cJSON_AddNumberToObject(root, "inside", (double)o->mask.inside);
  cJSON_AddItemToObject(root, "hues", hues);
  for (int h = 0; h < ABBE_OUTLINE_HUE_COUNT; h++) {
    cJSON *hue = cJSON_CreateObject();
    cJSON_AddStringToObject(hue, "name", abbe_outline_hue_name((abbe_outline_hue)h));
    cJSON_AddNumberToObject(hue, "share", o->place[h].share);
    cJSON_AddNumberToObject(hue, "x", o->place[h].x);
    cJSON_AddNumberToObject(hue, "y", o->place[h].y);
    cJSON_AddNumberToObject(hue, "spread", o->place[h].spread);
    cJSON_AddItemToArray(hues, hue);
  }
  return root;
}

static abbe_result print_json(const request *q, const abbe_outline o[2],
                              const abbe_outline_agreement *a, abbe_error *error) {
  cJSON *root = cJSON_CreateObject(), *pictures = cJSON_AddArrayToObject(root, "pictures");
  for (int i = 0; i < q->files; i++) cJSON_AddItemToArray(pictures, describe(q->file[i], &o[i]));
  if (q->files == 2) {
    cJSON *both = cJSON_AddObjectToObject(root, "agreement");
    cJSON_AddNumberToObject(both, "light_ratio", a->light_ratio);
    cJSON_AddNumberToObject(both, "overlap", a->overlap);
    cJSON_AddNumberToObject(both, "mean_apart", a->mean_apart);
    cJSON_AddNumberToObject(both, "p95_apart", a->p95_apart);
    cJSON *hues = cJSON_AddArrayToObject(both, "hues");
    for (int h = 0; h < ABBE_OUTLINE_HUE_COUNT; h++) {
      cJSON *hue = cJSON_CreateObject();
      cJSON_AddStringToObject(hue, "name", abbe_outline_hue_name((abbe_outline_hue)h));
      cJSON_AddNumberToObject(hue, "overlap", a->hue[h].overlap);
      cJSON_AddNumberToObject(hue, "apart", a->hue[h].apart);
      cJSON_AddItemToArray(hues, hue);
    }
  }
  abbe_result result = abbe_command_print_json(root, error);
  cJSON_Delete(root);
  return result;
}

int abbe_command_outline(int argc, char **argv) {
  static const struct argp argp = {
      options,
      parse,
      "FIRST.exr [SECOND.exr]",
      "Says where a caustic's light and each of its hues fall in a picture, and how far a second "
      "one "
      "agrees. Of pictures that keep the caustic apart (layer caustic) it looks at that.\v"
      "Examples:\n"
      "  abbe outline map.exr\n"
      "  abbe outline traced.exr rendered.exr --json\n"
      "  abbe outline traced.exr povray.exr --minus povray-dark.exr --share 0.8\n",
      NULL,
      NULL,
      NULL};
  request q = {.program = argv[0]};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_outline outline[2] = {{0}};
  abbe_outline_agreement agreement = {0};
  abbe_image place[2][2] = {{{0}}};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < q.files && result == ABBE_OK; i++) {
    const char *minus = i == q.files - 1 ? q.minus : NULL;
    result = abbe_outline_load(q.file[i], minus, &q.outline, &outline[i], place[i], &error);
    if (result == ABBE_OK) abbe_command_note_part(q.file[i], place[i][0].part);
    if (result == ABBE_OK && minus != NULL) abbe_command_note_part(minus, place[i][1].part);
  }
  if (result == ABBE_OK && q.files == 2)
    result = abbe_image_check_place(place[0], q.file[0], place[1], q.file[1], &error);
  if (result == ABBE_OK && q.files == 2)
    result = abbe_outline_compare(&outline[0], &outline[1], &agreement, &error);
  if (result == ABBE_OK && q.json) result = print_json(&q, outline, &agreement, &error);
  if (result == ABBE_OK && !q.json) print_text(outline, q.files, &agreement);
  for (int i = 0; i < 2; i++) abbe_outline_free(&outline[i]);
  return abbe_command_end(q.program, result, &error);
}
