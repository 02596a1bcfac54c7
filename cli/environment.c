#include "base/maths.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/scene_input.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/screen/screen_png.h"
#include "scenes/environment/environment_picture.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
  const char *program, *input, *out, *png;
  double exposure;
  bool json;
} request;

/* The measures that are printed; irradiances are on planes without anything before them. */
typedef struct measures {
  double up[3], down[3];     /* W/m2, on a plane that faces up, down */
  double brightest[3];       /* W/(m2 sr) */
  double elevation, azimuth; /* degrees, where that is */
  double gathered;           /* share of the light from the brightest hundredth of the sphere */
} measures;

static void find_brightest(const abbe_environment *e, measures *out) {
  const abbe_radiance_map *map = &e->map;
  size_t best = 0;
  double most = -1, own[3], world[3];
  for (size_t i = 0; i < map->width * map->height; i++) {
    const float *rgb = map->rgb + 3 * i;
    const double value =
        0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
    if (!(value > most)) continue;
    most = value;
    best = i;
  }
  for (size_t k = 0; k < 3; k++) out->brightest[k] = (double)map->rgb[3 * best + k];
  abbe_radiance_map_direction(map, (double)(best % map->width) + 0.5,
                              (double)(best / map->width) + 0.5, own);
  for (int i = 0; i < 3; i++)
    world[i] = e->to_map[i] * own[0] + e->to_map[3 + i] * own[1] + e->to_map[6 + i] * own[2];
  out->elevation = atan2(world[2], hypot(world[0], world[1])) * 180 / ABBE_PI;
  out->azimuth = atan2(world[1], world[0]) * 180 / ABBE_PI;
}

static abbe_result measure(const abbe_environment *e, measures *out, abbe_error *error) {
  abbe_environment_irradiance(e, (const double[3]){0, 0, 1}, out->up);
  abbe_environment_irradiance(e, (const double[3]){0, 0, -1}, out->down);
  find_brightest(e, out);
  return abbe_environment_brightest(e, 0.01, &out->gathered, error);
}

static void print_row(const char *name, const double rgb[3], const char *unit) {
  printf("%-18s %11.5g %11.5g %11.5g  %s\n", name, rgb[0], rgb[1], rgb[2], unit);
}

static abbe_result print(const request *r, const abbe_environment *e, const measures *m,
                         abbe_error *error) {
  if (!r->json) {
    printf("%zu x %zu texels, illuminant %s; linear Rec.709 relative to it\n\n", e->map.width,
           e->map.height, abbe_illuminant_name(&e->illuminant));
    print_row("mean radiance", e->mean, "W/(m2 sr)");
    print_row("irradiance up", m->up, "W/m2, on what faces up");
    print_row("irradiance down", m->down, "W/m2, on what faces down");
    print_row("brightest texel", m->brightest, "W/(m2 sr)");
    printf("%-18s elevation %.1f, azimuth %.1f degrees\n", "", m->elevation, m->azimuth);
    printf("%-18s %.1f %% of the light\n", "brightest 1 %", 100 * m->gathered);
    return ABBE_OK;
  }
  cJSON *root = cJSON_CreateObject();
  bool made = cJSON_AddNumberToObject(root, "width", (double)e->map.width) &&
              cJSON_AddNumberToObject(root, "height", (double)e->map.height) &&
              cJSON_AddStringToObject(root, "illuminant", abbe_illuminant_name(&e->illuminant)) &&
              cJSON_AddItemToObject(root, "mean", cJSON_CreateDoubleArray(e->mean, 3)) &&
              cJSON_AddItemToObject(root, "irradiance_up", cJSON_CreateDoubleArray(m->up, 3)) &&
              cJSON_AddItemToObject(root, "irradiance_down", cJSON_CreateDoubleArray(m->down, 3)) &&
              cJSON_AddItemToObject(root, "brightest", cJSON_CreateDoubleArray(m->brightest, 3)) &&
              cJSON_AddNumberToObject(root, "brightest_elevation", m->elevation) &&
              cJSON_AddNumberToObject(root, "brightest_azimuth", m->azimuth) &&
              cJSON_AddNumberToObject(root, "share_of_brightest_1_percent", m->gathered);
  const abbe_result result = abbe_command_print_json(made ? root : NULL, error);
  cJSON_Delete(root);
  return result;
}

/* As the world sees them, turned. */
static abbe_result make_image(const abbe_environment *e, abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  ABBE_TRY(abbe_image_make(e->map.width, e->map.height, 3, names, out, error));
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, out->xy);
  for (size_t i = 0; i < out->width * out->height; i++) {
    double direction[3], rgb[3];
    abbe_radiance_map_direction(&e->map, (double)(i % out->width) + 0.5,
                                (double)(i / out->width) + 0.5, direction);
    abbe_environment_radiance(e, direction, rgb);
    for (size_t k = 0; k < 3; k++) out->data[3 * i + k] = (float)rgb[k];
  }
  abbe_result result = abbe_image_set_attribute(out, "abbe:space",
                                                abbe_rgb_space_name(ABBE_RGB_SPACE_REC709), error);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(out, "abbe:illuminant", abbe_illuminant_name(&e->illuminant),
                                      error);
  return result;
}

static abbe_result write_pictures(const request *r, const abbe_environment *e, abbe_error *error) {
  abbe_image image = {0};
  abbe_result result = make_image(e, &image, error);
  if (result == ABBE_OK && r->out) result = abbe_exr_write(r->out, &image, error);
  const abbe_screen_png_desc screen = {.display = {.exposure = r->exposure}, .name = r->input};
  if (result == ABBE_OK && r->png) result = abbe_screen_png_write(r->png, &image, &screen, error);
  abbe_image_free(&image);
  return result;
}

static abbe_result say(const request *r, const abbe_environment *e, abbe_error *error) {
  measures m = {.gathered = 0};
  abbe_result result = measure(e, &m, error);
  if (result == ABBE_OK) result = print(r, e, &m, error);
  if (result == ABBE_OK && (r->out || r->png)) result = write_pictures(r, e, error);
  return result;
}

static bool ends_with(const char *text, const char *end) {
  const size_t length = strlen(text), tail = strlen(end);
  return length >= tail && strcmp(text + length - tail, end) == 0;
}

static abbe_result say_of_scene(const request *r, abbe_error *error) {
  abbe_scene scene = {0};
  abbe_result result = abbe_scene_input_load(r->program, r->input, NULL, &scene, error);
  if (result == ABBE_OK && scene.environment == NULL)
    result = abbe_error_set(error, ABBE_NOT_FOUND, "%s: the scene has no 'environment'", r->input);
  if (result == ABBE_OK) abbe_scene_input_note(&scene);
  if (result == ABBE_OK) result = say(r, scene.environment, error);
  abbe_scene_free(&scene);
  return result;
}

static abbe_result say_of_picture(const request *r, abbe_error *error) {
  abbe_environment e = {0};
  abbe_environment_turn(0, NULL, 0, e.to_map);
  abbe_result result =
      abbe_environment_picture_read(r->input, ABBE_LAYOUT_BY_ASPECT, &e.map, error);
  if (result == ABBE_OK && e.map.space_assumed) abbe_command_note_space(r->input);
  if (result == ABBE_OK) abbe_command_note_part(r->input, e.map.part);
  if (result == ABBE_OK) result = abbe_environment_prepare(&e, error);
  if (result == ABBE_OK) result = say(r, &e, error);
  abbe_environment_free(&e);
  return result;
}

enum { KEY_PNG = 256, KEY_EXPOSURE, KEY_JSON };

static const struct argp_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES,
     "the scene-linear picture, .exr; or that for a display, by its ending as --png", 0},
    {"png", KEY_PNG, "OUT.png", ABBE_ARGUMENT_WRITES,
     "the picture for a display, through OpenColorIO: .png, .webp, .jpg, .gif or .avif", 0},
    {"exposure", KEY_EXPOSURE, "STOPS", 0, "of the picture for a display, -60 to 60; without it, 0",
     0},
    {"json", KEY_JSON, NULL, 0, "as JSON, numbers in full", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_OUTPUT(request, 'o', out, png),
    ABBE_TAKE_OUTPUT(request, KEY_PNG, png, png),
    ABBE_TAKE_FLAG(request, KEY_JSON, json),
    ABBE_TAKE_ARGUMENT(request, input),
    ABBE_TAKE_NUMBER(request, KEY_EXPOSURE, exposure, -ABBE_DISPLAY_MAX_EXPOSURE,
                     ABBE_DISPLAY_MAX_EXPOSURE),
    ABBE_TAKE_NEEDED(request, input, "of which scene or picture?"),
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state) {
  return abbe_take_option(takes, key, arg, state) ? 0 : ARGP_ERR_UNKNOWN;
}

int abbe_command_environment(int argc, char **argv) {
  static const struct argp parser = {
      .options = options,
      .parser = parse,
      .args_doc = "SCENE.yaml|PICTURE",
      .doc = "Says how much light comes from all around: of a scene's 'environment', turned as it "
             "is there, or of an OpenEXR or Radiance picture. Writes it as a latitude-longitude "
             "picture, in linear Rec.709 relative to the illuminant.\v"
             "Examples:\n"
             "  abbe environment studio.yaml\n"
             "  abbe environment studio.yaml -o studio.exr --png studio.png\n"
             "  abbe environment courtyard.hdr --json\n",
  };
  request r = {.program = argv[0]};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  abbe_error error = {0};
  const bool scene = ends_with(r.input, ".yaml") || ends_with(r.input, ".yml");
  const abbe_result result = scene ? say_of_scene(&r, &error) : say_of_picture(&r, &error);
  return abbe_command_end(r.program, result, &error);
}
