#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include "colorimetry/image/image.h"
#include "colorimetry/picture_gamut/gamut_check.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <stdio.h>

typedef struct request {
  const char *program, *path, *overlay, *diagram;
  abbe_gamut gamut;
  bool json;
} request;

static double share_outside(const abbe_gamut_check *c) {
  return (double)c->outside / (double)c->lit;
}

static void print_text(const request *r, const abbe_image *image, const abbe_gamut_check *c) {
  printf("%s: %zu x %zu pixels, %s%s, against %s\n", r->path, c->width, c->height, c->space.text,
         c->space.assumed ? " (assumed: the file does not say)" : "", abbe_gamut_text(c->gamut));
  printf("  lit pixels              %zu\n", c->lit);
  printf("  outside                 %zu, %.4g %% of them, with %.4g %% of the light\n", c->outside,
         100 * share_outside(c), 100 * c->light_outside);
  if (c->outside == 0) return;
  printf("  excess, mean            %.4g of the greatest component\n", c->excess_mean);
  printf("  excess, greatest        %.4g at (%d, %d)\n", c->excess_greatest,
         (int)c->x + (int)image->display_window.x0, (int)c->y + (int)image->display_window.y0);
  printf("\n%-10s %10s %10s %10s %10s\n", "mapped by", "CIEDE2000", "greatest", "hue, deg",
         "greatest");
  for (int k = ABBE_GAMUT_MAP_CLIP; k < ABBE_GAMUT_MAP_COUNT; k++) {
    const abbe_gamut_cost *cost = &c->cost[k];
    printf("%-10s %10.4g %10.4g %10.4g %10.4g\n", abbe_gamut_map_name((abbe_gamut_map_kind)k),
           cost->mean, cost->greatest, cost->hue_mean, cost->hue_greatest);
  }
  printf("means over the pixels outside; white is D65 at Y = %.4g, hue is Oklab's\n", c->white_y);
}

static bool add_costs(cJSON *root, const abbe_gamut_check *c) {
  cJSON *maps = cJSON_AddObjectToObject(root, "mapped_by");
  bool made = maps != NULL;
  for (int k = ABBE_GAMUT_MAP_CLIP; made && k < ABBE_GAMUT_MAP_COUNT; k++) {
    const abbe_gamut_cost *cost = &c->cost[k];
    cJSON *o = cJSON_AddObjectToObject(maps, abbe_gamut_map_name((abbe_gamut_map_kind)k));
    made = cJSON_AddNumberToObject(o, "ciede2000_mean", cost->mean) != NULL &&
           cJSON_AddNumberToObject(o, "ciede2000_max", cost->greatest) != NULL &&
           cJSON_AddNumberToObject(o, "hue_mean_deg", cost->hue_mean) != NULL &&
           cJSON_AddNumberToObject(o, "hue_max_deg", cost->hue_greatest) != NULL;
  }
  return made;
}

static abbe_result print_json(const request *r, const abbe_image *image, const abbe_gamut_check *c,
                              abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  const int at[2] = {(int)c->x + (int)image->display_window.x0,
                     (int)c->y + (int)image->display_window.y0};
  bool made = cJSON_AddStringToObject(root, "file", r->path) != NULL &&
              cJSON_AddStringToObject(root, "space", c->space.text) != NULL &&
              cJSON_AddBoolToObject(root, "space_assumed", c->space.assumed) != NULL &&
              cJSON_AddStringToObject(root, "gamut", abbe_gamut_name(c->gamut)) != NULL &&
              cJSON_AddNumberToObject(root, "width", (double)c->width) != NULL &&
              cJSON_AddNumberToObject(root, "height", (double)c->height) != NULL &&
              cJSON_AddNumberToObject(root, "lit", (double)c->lit) != NULL &&
              cJSON_AddNumberToObject(root, "infinite", (double)c->odd.infinite) != NULL &&
              cJSON_AddNumberToObject(root, "nan", (double)c->odd.nan) != NULL &&
              cJSON_AddNumberToObject(root, "outside", (double)c->outside) != NULL &&
              cJSON_AddNumberToObject(root, "share_outside", share_outside(c)) != NULL &&
              cJSON_AddNumberToObject(root, "light_outside", c->light_outside) != NULL &&
              cJSON_AddNumberToObject(root, "excess_mean", c->excess_mean) != NULL &&
              cJSON_AddNumberToObject(root, "excess_max", c->excess_greatest) != NULL &&
              cJSON_AddItemToObject(root, "excess_max_at", cJSON_CreateIntArray(at, 2)) &&
              cJSON_AddNumberToObject(root, "white_y", c->white_y) != NULL;
  if (made) made = add_costs(root, c);
  abbe_result result = abbe_command_print_json(made ? root : NULL, error);
  cJSON_Delete(root);
  return result;
}

static abbe_result report(const request *r, const abbe_image *image, abbe_error *error) {
  abbe_gamut_check check = {0};
  abbe_result result = abbe_gamut_check_make(image, r->path, r->gamut, &check, error);
  if (result == ABBE_OK && check.space.assumed) abbe_command_note_space(r->path);
  if (result == ABBE_OK) abbe_command_note_odd(r->path, &check.odd, "left out");
  if (result == ABBE_OK && r->overlay != NULL)
    result = abbe_gamut_check_overlay(&check, r->overlay, error);
  if (result == ABBE_OK && r->diagram != NULL)
    result = abbe_gamut_check_diagram(&check, r->diagram, r->path, error);
  if (result == ABBE_OK && r->json)
    result = print_json(r, image, &check, error);
  else if (result == ABBE_OK)
    print_text(r, image, &check);
  abbe_gamut_check_free(&check);
  return result;
}

/* The command line */

enum { KEY_SPACE = 256, KEY_OVERLAY, KEY_DIAGRAM, KEY_JSON };

static const struct argp_option options[] = {
    {"space", KEY_SPACE, "NAME", 0,
     "whose gamut: rec709, p3, rec2020 or acescg; without it, rec709", 0},
    {"overlay", KEY_OVERLAY, "FILE.png", ABBE_ARGUMENT_WRITES,
     "the picture in grey, what is outside in colours", 0},
    {"diagram", KEY_DIAGRAM, "FILE", ABBE_ARGUMENT_WRITES,
     "its chromaticities in x, y and u', v', with the locus and the gamuts: a .png or .svg", 0},
    {"json", KEY_JSON, NULL, 0, "as JSON, numbers in full", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TARGET(request, KEY_OVERLAY, overlay, ".png"),
    ABBE_TAKE_TEXT(request, KEY_DIAGRAM, diagram),
    ABBE_TAKE_FLAG(request, KEY_JSON, json),
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state) {
  const char *names[ABBE_GAMUT_COUNT];
  request *r = state->input;
  if (abbe_take_option(takes, key, arg, state)) return 0;
  switch (key) {
  case KEY_SPACE:
    for (int i = 0; i < ABBE_GAMUT_COUNT; i++) names[i] = abbe_gamut_name((abbe_gamut)i);
    r->gamut = (abbe_gamut)abbe_command_choice(r->program, "--space", arg, names, ABBE_GAMUT_COUNT);
    return 0;
  default:
    return abbe_arguments_one_file(key, arg, &r->path, state);
  }
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "FILE.exr",
    .doc = "Says how much of a picture a display's gamut cannot hold, where, by how much, and what "
           "each way of bringing it inside costs.\v"
           "The excess of a colour is what its least component is below 0, over its greatest.\n\n"
           "Examples:\n"
           "  abbe gamut gem.exr\n"
           "  abbe gamut gem.exr --space p3 --overlay outside.png\n"
           "  abbe gamut gem.exr --space rec2020 --diagram gamut.svg --json\n",
};

int abbe_command_gamut(int argc, char **argv) {
  request r = {.program = argv[0], .gamut = ABBE_GAMUT_REC709};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  abbe_error error = {0};
  abbe_image image = {0};
  abbe_result result = abbe_command_read_picture(r.path, &image, &error);
  if (result == ABBE_OK) result = report(&r, &image, &error);
  abbe_image_free(&image);
  return abbe_command_end(r.program, result, &error);
}
