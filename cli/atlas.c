#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include "colorimetry/atlas/atlas.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <stdio.h>

typedef struct request {
  const char *program, *illuminant, *picture, *plot;
  abbe_atlas_desc desc;
  double step;
  bool json;
} request;

static bool is_shown(const request *r, const abbe_atlas *a, size_t i) {
  const size_t step = r->json ? 1 : (size_t)r->step;
  return i % step == 0 || i + 1 == a->count;
}

static void print_text(const request *r, const abbe_atlas *a) {
  printf("%s, %zu bands of %s over %g to %g nm; light of Y = 0.5 under D65\n",
         abbe_observer_text(a->observer), a->bands, r->illuminant != NULL ? r->illuminant : "D65",
         a->min_nm, a->max_nm);
  printf("\n%5s %8s %8s | %8s %8s %8s %7s |", "nm", "x", "y", "band x", "band y", "u'v'", "dE00");
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++) printf(" %8s", abbe_gamut_name((abbe_gamut)g));
  printf("\n");
  for (size_t i = 0; i < a->count; i++) {
    const abbe_atlas_row *row = &a->row[i];
    if (!is_shown(r, a, i)) continue;
    printf("%5g %8.5f %8.5f | %8.5f %8.5f %8.5f %7.3f |", row->lambda_nm, row->xy[0], row->xy[1],
           row->band_xy[0], row->band_xy[1], row->band_uv, row->band_difference);
    for (int g = 0; g < ABBE_GAMUT_COUNT; g++)
      printf(" %8.3f", row->difference[g][ABBE_GAMUT_MAP_WHITE]);
    printf("\n");
  }
  printf("last columns: CIEDE2000 of bringing the colour into the gamut, towards white at constant "
         "Oklab hue\n");
}

static bool add_gamuts(cJSON *o, const abbe_atlas_row *row) {
  cJSON *gamuts = cJSON_AddObjectToObject(o, "gamuts");
  bool made = gamuts != NULL;
  for (int g = 0; g < ABBE_GAMUT_COUNT && made; g++) {
    cJSON *one = cJSON_AddObjectToObject(gamuts, abbe_gamut_name((abbe_gamut)g));
    made = cJSON_AddNumberToObject(one, "excess", row->excess[g]) != NULL;
    for (int k = ABBE_GAMUT_MAP_CLIP; k < ABBE_GAMUT_MAP_COUNT && made; k++)
      made = cJSON_AddNumberToObject(one, abbe_gamut_map_name((abbe_gamut_map_kind)k),
                                     row->difference[g][k]) != NULL;
  }
  return made;
}

static abbe_result print_json(const abbe_atlas *a, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  bool made = cJSON_AddStringToObject(root, "observer", abbe_observer_name(a->observer)) != NULL &&
              cJSON_AddNumberToObject(root, "bands", (double)a->bands) != NULL;
  cJSON *list = cJSON_AddArrayToObject(root, "wavelengths");
  for (size_t i = 0; i < a->count && made; i++) {
    const abbe_atlas_row *row = &a->row[i];
    cJSON *o = cJSON_CreateObject();
    made = cJSON_AddItemToArray(list, o) &&
           cJSON_AddNumberToObject(o, "lambda_nm", row->lambda_nm) != NULL &&
           cJSON_AddItemToObject(o, "xy", cJSON_CreateDoubleArray(row->xy, 2)) &&
           cJSON_AddItemToObject(o, "band_xy", cJSON_CreateDoubleArray(row->band_xy, 2)) &&
           cJSON_AddNumberToObject(o, "band_uv_distance", row->band_uv) != NULL &&
           cJSON_AddNumberToObject(o, "band_ciede2000", row->band_difference) != NULL &&
           add_gamuts(o, row);
  }
  abbe_result result = abbe_command_print_json(made ? root : NULL, error);
  cJSON_Delete(root);
  return result;
}

static abbe_result run(request *r, abbe_error *error) {
  abbe_illuminant light = {0};
  abbe_atlas atlas = {0};
  abbe_result result = ABBE_OK;
  if (r->illuminant != NULL) result = abbe_illuminant_make(r->illuminant, &light, error);
  r->desc.illuminant = &light;
  if (result == ABBE_OK) result = abbe_atlas_make(&r->desc, &atlas, error);
  if (result == ABBE_OK && r->picture != NULL)
    result = abbe_atlas_picture(&atlas, r->picture, error);
  if (result == ABBE_OK && r->plot != NULL) result = abbe_atlas_plot(&atlas, r->plot, error);
  if (result == ABBE_OK && r->json)
    result = print_json(&atlas, error);
  else if (result == ABBE_OK)
    print_text(r, &atlas);
  abbe_atlas_free(&atlas);
  abbe_illuminant_free(&light);
  return result;
}

/* The command line */

enum { KEY_OBSERVER = 256, KEY_ILLUMINANT, KEY_RANGE, KEY_BANDS, KEY_STEP, KEY_PLOT, KEY_JSON };

static const struct argp_option options[] = {
    {"observer", KEY_OBSERVER, "NAME", 0, "1931, 1964, 2015-2 or 2015-10; without it, 1931", 0},
    {"illuminant", KEY_ILLUMINANT, "NAME|FILE", ABBE_ARGUMENT_READS,
     "of the light in the bands; without it, D65", 0},
    {"range", KEY_RANGE, "MIN:MAX", 0, "nm, within 380:730; without it, 400:700", 0},
    {"bands", KEY_BANDS, "N", 0, "that tile the range; without it, 21", 0},
    {"step", KEY_STEP, "NM", 0, "of the table's rows; without it, 20", 0},
    {"output", 'o', "FILE.png", ABBE_ARGUMENT_WRITES,
     "strips of colour for Display P3: the wavelengths above, the bands below", 0},
    {"plot", KEY_PLOT, "FILE", ABBE_ARGUMENT_WRITES,
     "differences from the truth over wavelength, as a .png or .svg", 0},
    {"json", KEY_JSON, NULL, 0, "every nm as JSON, numbers in full", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TEXT(request, KEY_ILLUMINANT, illuminant),
    ABBE_TAKE_RANGE(request, KEY_RANGE, desc.min_nm, desc.max_nm),
    ABBE_TAKE_COUNT(request, KEY_BANDS, desc.bands, 1, 4096),
    ABBE_TAKE_TARGET(request, 'o', picture, ".png"),
    ABBE_TAKE_TEXT(request, KEY_PLOT, plot),
    ABBE_TAKE_FLAG(request, KEY_JSON, json),
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state) {
  const char *names[ABBE_OBSERVER_COUNT];
  request *r = state->input;
  if (abbe_take_option(takes, key, arg, state)) return 0;
  switch (key) {
  case KEY_OBSERVER:
    for (int i = 0; i < ABBE_OBSERVER_COUNT; i++) names[i] = abbe_observer_name((abbe_observer)i);
    r->desc.observer = abbe_observer_find(arg);
    if (r->desc.observer == ABBE_OBSERVER_COUNT)
      r->desc.observer = (abbe_observer)abbe_command_choice(r->program, "--observer", arg, names,
                                                            ABBE_OBSERVER_COUNT);
    return 0;
  case KEY_STEP:
    r->step = (double)abbe_command_count(r->program, "--step", arg, 1, 350);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .doc = "Shows the colours of single wavelengths for an observer, what so many bands make of "
           "them, and how far each is from the truth in each display's gamut.\v"
           "Examples:\n"
           "  abbe atlas\n"
           "  abbe atlas --bands 7 -o seven.png --plot seven.svg\n"
           "  abbe atlas --observer 1964 --illuminant A --range 420:680 --json\n",
};

int abbe_command_atlas(int argc, char **argv) {
  request r = {.program = argv[0], .step = 20};
  abbe_arguments_parse(&parser, 0, argc, argv, &r);
  abbe_error error = {0};
  return abbe_command_end(r.program, run(&r, &error), &error);
}
