#include "base/number.h"
#include "base/text.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/options/picture_options.h"
#include "cli/options/scene_input.h"
#include "colorimetry/image/exr.h"
#include "spectral/wavelengths.h"
#include "validation/measure/derive/derivative.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  OPTION_BY = 0x400,
  OPTION_LIGHT,
  OPTION_LIKE,
  OPTION_MAP,
  OPTION_LINES,
  OPTION_POINTS,
  OPTION_INTERFACES,
  OPTION_MATERIALS,
  OPTION_JSON
};
enum { MOST_KEYS = 16, MOST_SIDE = 4096 };

/* The map and each derivative of it are summed in double by every thread. */
enum { MOST_TEXELS = 16 << 20 };

typedef struct request {
  const char *program, *path, *materials, *exr;
  bool json, quiet;
  const char *key[MOST_KEYS];
  double value[MOST_KEYS]; /* as the scene has it; of a material: 0 */
  abbe_scene_input_changes changes;
  abbe_map_options map;
  abbe_work_options work;
  size_t width, height, lines, points, interfaces, keys;
} request;

static const struct argp_option options[] = {
    {"by", OPTION_BY, "KEY", 0,
     "a number of the scene, as --set has it, such as objects.prism.apex or "
     "lights.lamp.position.2; "
     "or materials.NAME.n, .B (um2), .V or .absorption (1/m) of what NAME has more; may be "
     "repeated",
     0},
    {"output", 'o', "FILE.exr", ABBE_ARGUMENT_WRITES,
     "the map of one light and its derivative by each key, with standard errors", 0},
    {"json", OPTION_JSON, NULL, 0, "the numbers as JSON", 0},
    {"quiet", 'q', NULL, 0, "no progress, no notes", 0},
    {"map-light", OPTION_LIGHT, "NAME", 0, "whose light, its name or number (the first)", 1},
    {"map-like", OPTION_LIKE, "MAP.exr", ABBE_ARGUMENT_READS, "a map whose texels are taken", 1},
    {"map", OPTION_MAP, "WxH", 0, "texels of the map (128x128)", 1},
    {"lines", OPTION_LINES, "N", 0, "across the light's window, in all (1024)", 1},
    {"points", OPTION_POINTS, "N", 0, "of each line (64)", 1},
    {"interfaces", OPTION_INTERFACES, "N", 0, "that a path may meet, 1 to 32 (12)", 1},
    ABBE_SCENE_INPUT_OPTIONS(1),
    ABBE_SCENE_INPUT_STUDIO_OPTIONS(1),
    {"materials", OPTION_MATERIALS, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1},
    {"range", ABBE_WORK_RANGE, "FROM:TO", 0, "wavelengths, nm (380:780)", 1},
    {"seed", ABBE_WORK_SEED, "N", 0, "of the random numbers (0)", 1},
    {"threads", ABBE_WORK_THREADS, "N", 0, "without it, all; results do not depend on it", 1},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TARGET(request, 'o', exr, ".exr"),
    ABBE_TAKE_FLAG(request, OPTION_JSON, json),
    ABBE_TAKE_FLAG(request, 'q', quiet),
    ABBE_TAKE_TEXT(request, OPTION_LIGHT, map.light),
    ABBE_TAKE_TEXT(request, OPTION_LIKE, map.like),
    ABBE_TAKE_TEXT(request, OPTION_MATERIALS, materials),
    ABBE_TAKE_SIZE(request, OPTION_MAP, width, height, MOST_SIDE),
    ABBE_TAKE_COUNT(request, OPTION_LINES, lines, ABBE_DERIVATIVE_PARTS, 1e9),
    ABBE_TAKE_COUNT(request, OPTION_POINTS, points, 2, 1e6),
    ABBE_TAKE_COUNT(request, OPTION_INTERFACES, interfaces, 1, ABBE_SPECULAR_MOST_INTERFACES),
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  if (abbe_take_option(takes, key, text, state)) return 0;
  switch (key) {
  case OPTION_BY:
    if (q->keys == MOST_KEYS) argp_error(state, "no more than %d keys at a time", MOST_KEYS);
    q->key[q->keys++] = text;
    return 0;
  case ARGP_KEY_ARG:
    abbe_scene_input_take_file(&q->changes, &q->path, text, state);
    return 0;
  case ARGP_KEY_END:
    if (q->path == NULL) argp_error(state, "of which scene? Try scenes/prism.yaml");
    if (q->keys == 0) argp_error(state, "by what? Give --by KEY, such as objects.prism.apex");
    if (q->changes.set_count >= ABBE_SCENE_INPUT_MOST)
      argp_error(state, "no more than %d --set", ABBE_SCENE_INPUT_MOST - 1);
    return 0;
  default:
    return abbe_work_options_take(&q->work, key, text, state->name) == 0
               ? 0
               : abbe_scene_input_take(&q->changes, key, text, state->name);
  }
}

/* ---- keys ---- */

/* A key that is moved both ways: scenes of its own, or the base's with another material. */
typedef struct moved_key {
  abbe_scene scene[2];
} moved_key;

/* materials.NAME.WHAT; false: it is no such key. */
static abbe_result read_material_key(const char *key, const abbe_scene *scene,
                                     char name[ABBE_MATERIAL_MAX_NAME + 1],
                                     abbe_specular_shift *shift, double *step, bool *is,
                                     abbe_error *error) {
  static const char head[] = "materials.";
  static const char *const whats[] = {"n", "B", "V", "absorption"};
  static const double steps[] = {1e-6, 1e-7, 1e-4, 1e-3};
  const char *last = strrchr(key, '.'), *names[ABBE_SCENE_MAX_OBJECTS];
  size_t count = 0;
  *is = strncmp(key, head, strlen(head)) == 0 && last > key + strlen(head);
  if (!*is) return ABBE_OK;
  snprintf(name, ABBE_MATERIAL_MAX_NAME + 1, "%.*s", (int)(last - key - (ptrdiff_t)strlen(head)),
           key + strlen(head));
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].material != NULL) names[count++] = scene->object[i].material->name;
  *shift = (abbe_specular_shift){0};
  for (size_t i = 0; i < count; i++)
    if (strcmp(names[i], name) == 0) shift->material = name;
  const char *near = shift->material ? NULL : abbe_nearest_word(name, names, count);
  if (shift->material == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--by %.120s: no refractor is made of '%s'%s%s%s", key, name,
                          near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
  double *const to[] = {&shift->n, &shift->b_um2, &shift->v, &shift->absorption};
  for (size_t i = 0; i < sizeof whats / sizeof *whats; i++)
    if (strcmp(last + 1, whats[i]) == 0) {
      *to[i] = *step = steps[i];
      return ABBE_OK;
    }
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "--by %.120s: of a material there are n, B (um2), V and absorption (1/m)",
                        key);
}

static abbe_specular_shift less(const abbe_specular_shift *more) {
  return (abbe_specular_shift){.material = more->material,
                               .n = -more->n,
                               .b_um2 = -more->b_um2,
                               .v = -more->v,
                               .absorption = -more->absorption};
}

static abbe_result load_moved(const request *q, const char *path, const char *key, double value,
                              abbe_scene *out, abbe_error *error) {
  char text[320];
  abbe_scene_input_changes changes = q->changes;
  abbe_error why = {0};
  abbe_number_format(text, sizeof text, "%.250s=%.17g", key, value);
  changes.set[changes.set_count++] = text;
  changes.save = NULL;
  const abbe_result result =
      abbe_scene_input_load_with(q->program, path, q->materials, &changes, out, &why);
  if (result == ABBE_OK) return result;
  return abbe_error_set(error, result, "--by %.120s: it cannot be moved by a little: %s", key,
                        why.text);
}

static abbe_result make_key(request *q, size_t k, const abbe_specular *base, moved_key *moved,
                            abbe_derivative_key *out, abbe_error *error) {
  static char names[MOST_KEYS][ABBE_MATERIAL_MAX_NAME + 1];
  abbe_specular_shift shift[2] = {{0}};
  bool material;
  out->name = q->key[k];
  abbe_result result =
      read_material_key(q->key[k], base->scene, names[k], &shift[1], &out->step, &material, error);
  if (result == ABBE_OK && !material) {
    result = abbe_scene_input_number(base->scene, q->materials, &q->changes, q->key[k],
                                     &q->value[k], error);
    out->step = fmax(1e-5 * fabs(q->value[k]), 1e-6);
    if (q->value[k] != 0) out->step = fmin(out->step, 1e-3 * fabs(q->value[k]));
  }
  shift[0] = less(&shift[1]);
  const size_t light = (size_t)(base->light - base->scene->light);
  for (int s = 0; s < 2 && result == ABBE_OK; s++) {
    const double to = q->value[k] + (s == 0 ? -out->step : out->step);
    if (!material)
      result = load_moved(q, base->scene->path, q->key[k], to, &moved->scene[s], error);
    const abbe_scene *scene = material ? base->scene : &moved->scene[s];
    if (result == ABBE_OK && light >= scene->light_count)
      result = abbe_error_set(error, ABBE_UNSUPPORTED,
                              "--by %.120s changes how many lights there are", q->key[k]);
    if (result == ABBE_OK)
      result = abbe_specular_make(scene, light, &shift[s], &out->moved[s], error);
    if (result == ABBE_OK) result = abbe_specular_match(&out->moved[s], base, q->key[k], error);
  }
  return result;
}

/* ---- what came of it ---- */

static void print_numbers(const request *q, const abbe_derivative *d) {
  printf("%-34s %-9s %13s %11s  %s\n", "by", "of", "value", "std error", "unit");
  for (size_t row = 0; row <= q->keys; row++)
    for (int n = 0; n < ABBE_DERIVATIVE_NUMBER_COUNT; n++) {
      const abbe_derivative_number which = (abbe_derivative_number)n;
      const char *by = n > 0 ? "" : row == 0 ? "(as it is)" : q->key[row - 1];
      double error;
      const double value = abbe_derivative_number_of(d, which, row, &error);
      printf("%-34s %-9s %13.5g %11.2g  %s%s\n", by, abbe_derivative_number_name(which), value,
             error, abbe_derivative_number_unit(which), row > 0 ? " by one of it" : "");
    }
}

static abbe_result print_json(const request *q, const abbe_derivative *d, abbe_error *error) {
  cJSON *root = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(root, "rows");
  cJSON_AddStringToObject(root, "scene", q->path);
  cJSON_AddNumberToObject(root, "longer_paths", d->left);
  cJSON_AddNumberToObject(root, "lost_jumps", d->lost);
  for (size_t row = 0; row <= q->keys; row++) {
    cJSON *one = cJSON_CreateObject();
    cJSON_AddItemToArray(list, one);
    if (row > 0) cJSON_AddStringToObject(one, "by", q->key[row - 1]);
    for (int n = 0; n < ABBE_DERIVATIVE_NUMBER_COUNT; n++) {
      double e[2];
      e[0] = abbe_derivative_number_of(d, (abbe_derivative_number)n, row, &e[1]);
      cJSON_AddItemToObject(one, abbe_derivative_number_name((abbe_derivative_number)n),
                            cJSON_CreateDoubleArray(e, 2));
    }
  }
  return abbe_command_print_json(root, true, error);
}

static void note(const request *q, const abbe_derivative *d) {
  if (q->quiet) return;
  for (size_t k = 0; k < q->keys; k++)
    if (!d->felt[k])
      fprintf(stderr, "note: nothing that lands depends on '%s': its derivative is 0\n", q->key[k]);
  fprintf(stderr,
          "left out: %.2g %% of the light, on paths of more than %zu interfaces or less than 1e-4 "
          "of what set out; %.2g %% of the light that jumps at edges, which were lost\n",
          100 * d->left, q->interfaces, 100 * d->lost);
}

static abbe_result write_map(const request *q, const abbe_derivative_desc *desc,
                             const abbe_derivative *d, abbe_error *error) {
  enum { CHANNELS = 6 * (1 + MOST_KEYS), NAME = 256 };
  static char name[CHANNELS][NAME];
  const char *names[CHANNELS];
  const size_t rows = 1 + q->keys;
  for (size_t i = 0; i < 6 * rows; i++) {
    const char *key = i < 6 ? "" : q->key[i / 6 - 1];
    snprintf(name[i], NAME, "%s%.200s%s%c", i % 6 < 3 ? "" : "stderr.", key, i < 6 ? "" : ".",
             "XYZ"[i % 3]);
    names[i] = name[i];
  }
  ABBE_OWNED(abbe_image, image) = {0};
  ABBE_TRY(abbe_image_make(desc->width, desc->height, 6 * rows, names, &image, error));
  for (size_t i = 0; i < d->texels; i++)
    for (size_t c = 0; c < 6 * rows; c++)
      image.data[i * 6 * rows + c] = (c % 6 < 3 ? d->map : d->error)[c / 6 * d->texels + i][c % 3];
  ABBE_TRY(abbe_map_layout_write(&desc->layout, desc->base->light->name, &image, error));
  ABBE_TRY(abbe_image_set_attribute(&image, "abbe:derivative",
                                    "layers of a key: W a texel by one unit of the key", error));
  return abbe_exr_write(q->exr, &image, error);
}

static abbe_result derive(request *q, abbe_derivative_desc *desc, abbe_error *error) {
  abbe_derivative d = {0};
  abbe_progress progress;
  abbe_progress_begin(&progress, "deriving", q->quiet);
  desc->progress = abbe_progress_update;
  desc->user = &progress;
  abbe_result result = abbe_derivative_make(desc, &d, error);
  abbe_progress_end(&progress);
  if (result == ABBE_OK && q->exr != NULL) result = write_map(q, desc, &d, error);
  if (result == ABBE_OK && q->json) result = print_json(q, &d, error);
  if (result == ABBE_OK && !q->json) print_numbers(q, &d);
  if (result == ABBE_OK) note(q, &d);
  abbe_derivative_free(&d);
  return result;
}

static abbe_result lay_out(const request *q, abbe_derivative_desc *desc, abbe_error *error) {
  if (q->exr == NULL) return ABBE_OK;
  desc->width = q->width > 0 ? q->width : q->map.side > 0 ? q->map.side : 128;
  desc->height = q->height > 0 ? q->height : desc->width;
  if ((1 + desc->keys) * desc->width * desc->height > MOST_TEXELS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a map of %zu x %zu texels by %zu keys has more than %d million of them; "
                          "ask for a smaller --map, or for fewer keys at a time",
                          desc->width, desc->height, desc->keys, MOST_TEXELS >> 20);
  desc->layout = q->map.layout;
  return q->map.like != NULL ? ABBE_OK : abbe_derivative_fit(desc, &desc->layout, error);
}

static abbe_result run(request *q, const abbe_scene *scene, abbe_error *error) {
  abbe_specular base = {0};
  abbe_spectral_sampling sampling = {0};
  moved_key *moved = calloc(q->keys, sizeof *moved);
  abbe_derivative_key *key = calloc(q->keys, sizeof *key);
  const abbe_spectral_sampling_desc spectrum = {
      .min_nm = q->work.min_nm > 0 ? q->work.min_nm : ABBE_WAVELENGTH_MIN_NM,
      .max_nm = q->work.max_nm > 0 ? q->work.max_nm : ABBE_WAVELENGTH_MAX_NM,
      .uniform = 0.1};
  abbe_result result = moved == NULL || key == NULL
                           ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the keys")
                           : abbe_map_options_resolve(&q->map, scene, true, error);
  if (result == ABBE_OK && scene->light_count == 0)
    result =
        abbe_error_set(error, ABBE_UNSUPPORTED,
                       "%s has no light besides its surroundings; a map is of one light", q->path);
  if (result == ABBE_OK) result = abbe_specular_make(scene, q->map.light_index, NULL, &base, error);
  if (result == ABBE_OK)
    result = abbe_specular_narrow(&base, spectrum.min_nm, spectrum.max_nm, q->interfaces, error);
  if (result == ABBE_OK) result = abbe_spectral_sampling_make(scene, &spectrum, &sampling, error);
  for (size_t k = 0; k < q->keys && result == ABBE_OK; k++)
    result = make_key(q, k, &base, &moved[k], &key[k], error);
  abbe_derivative_desc desc = {.base = &base,
                               .light = q->map.light_index,
                               .keys = q->keys,
                               .key = key,
                               .sampling = &sampling,
                               .lines = q->lines,
                               .points = q->points,
                               .interfaces = q->interfaces,
                               .seed = q->work.seed,
                               .threads = q->work.threads};
  if (result == ABBE_OK) result = lay_out(q, &desc, error);
  if (result == ABBE_OK) result = derive(q, &desc, error);
  for (size_t k = 0; k < q->keys && moved != NULL && key != NULL; k++)
    for (int s = 0; s < 2; s++) {
      abbe_specular_free(&key[k].moved[s]);
      abbe_scene_free(&moved[k].scene[s]);
    }
  free(moved);
  free(key);
  abbe_specular_free(&base);
  abbe_spectral_sampling_free(&sampling);
  return result;
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "SCENE.yaml",
    .doc =
        "Says how what a light throws through refractors and off mirrors changes with scalars of "
        "the scene: the derivative of the receiver map's texels (XYZ), and of the light's flux, "
        "chromaticity, middle and spread, by one unit of each key (angles in degrees, lengths in "
        "metres). Paths are followed in double precision, edges of facets and shadows are "
        "included, and standard errors are given.\v"
        "Examples:\n"
        "  abbe derive scenes/prism.yaml --by objects.prism.apex --by materials.sf10.n\n"
        "  abbe derive scenes/sphere.yaml --by objects.ball.radius -o ball.exr\n"
        "  abbe derive scenes/gem.yaml --by lights.lamp.position.0 --by lights.lamp.intensity "
        "--json\n",
};

int abbe_command_derive(int argc, char **argv) {
  request q = {.program = argv[0], .lines = 1024, .points = 64, .interfaces = 12};
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &q);
  const char *targets[] = {q.exr};
  abbe_result result = abbe_command_check_targets(targets, 1, &error);
  if (result == ABBE_OK)
    result = abbe_scene_input_load_with(q.program, q.path, q.materials, &q.changes, &scene, &error);
  if (result == ABBE_OK && !q.quiet) abbe_scene_input_note(&scene);
  if (result == ABBE_OK) result = run(&q, &scene, &error);
  abbe_scene_free(&scene);
  return abbe_command_end(q.program, result, &error);
}
