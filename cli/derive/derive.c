#include "cli/derive/derive.h"
#include "base/number.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "colorimetry/image/exr.h"
#include "spectral/wavelengths.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_BY = 0x400, OPTION_SPACE, OPTION_REGION };
enum { MOST_SIDE = 4096 };

typedef abbe_derive_request request;

/* The map and each derivative of it are summed in double by every thread. */
enum { MOST_TEXELS = 16 << 20 };

#define NAME_OF_3(code, name, other) name,
static const char *const spaces[] = {ABBE_RGB_SPACES(NAME_OF_3)};

/* Whether the file is of the map, and not of the camera's picture. */
static bool is_of_map(const request *q) {
  return q->width > 0 || q->map.like != NULL;
}

static const abbe_option options[] = {
    {"by", OPTION_BY, "KEY", 0,
     "a number of the scene, as --set has it, such as objects.prism.apex or "
     "lights.lamp.position.2; "
     "or materials.NAME.n, .B (um2), .V or .absorption (1/m) of what NAME has more; may be "
     "repeated",
     0, ABBE_TAKE_BY_KEY},
    {"output", 'o', "FILE.exr", ABBE_ARGUMENT_WRITES,
     "the camera's picture and its derivative by each key, with standard errors; with --map or "
     "--map-like the map of one light",
     0, ABBE_TAKE_TARGET(request, exr, ".exr")},
    {"stone", 0, "OBJECT", 0,
     "instead: light return, ISO, COS, leakage and fire of that stone, seen from straight above as "
     "it lies in the scene",
     0, ABBE_TAKE_TEXT(request, stone)},
    {"json", 0, NULL, 0, "the numbers as JSON", 0, ABBE_TAKE_FLAG(request, json)},
    {"quiet", 'q', NULL, 0, "no progress, no notes", 0, ABBE_TAKE_FLAG(request, quiet)},
    {"map-light", 0, "NAME", 0, "whose light, its name or number (the first)", 1,
     ABBE_TAKE_TEXT(request, map.light)},
    {"map-like", 0, "MAP.exr", ABBE_ARGUMENT_READS, "a map whose texels are taken", 1,
     ABBE_TAKE_TEXT(request, map.like)},
    {"map", 0, "WxH", 0, "texels of the map that is written in place of the picture", 1,
     ABBE_TAKE_SIZE(request, width, height, MOST_SIDE)},
    {"size", 0, "WxH", 0, "pixels of the picture; the scene's own without", 1,
     ABBE_TAKE_SIZE(request, columns, rows, MOST_SIDE)},
    {"spp", 0, "N", 0, "samples of each pixel (32)", 1, ABBE_TAKE_COUNT(request, samples, 1, 1e6)},
    {"space", OPTION_SPACE, "NAME", 0, "of the picture: acescg, rec709, xyz (acescg)", 1,
     ABBE_TAKE_BY_KEY},
    {"region", OPTION_REGION, "X,Y,W,H", 0,
     "of the picture: its column, row, width and height, whose means are said (all of it)", 1,
     ABBE_TAKE_BY_KEY},
    {"target", 0, "PICTURE.exr", ABBE_ARGUMENT_READS,
     "of the same size: CIEDE2000 between its region's mean colour and the picture's as well", 1,
     ABBE_TAKE_TEXT(request, target)},
    {"lines", 0, "N", 0, "across the light's window, or across the view of a stone, in all (1024)",
     1, ABBE_TAKE_COUNT(request, lines, ABBE_DERIVATIVE_PARTS, 1e9)},
    {"points", 0, "N", 0, "of each line (64)", 1, ABBE_TAKE_COUNT(request, points, 2, 1e6)},
    {"interfaces", 0, "N", 0, "that a path may meet, 1 to 32 (12)", 1,
     ABBE_TAKE_COUNT(request, interfaces, 1, ABBE_SPECULAR_MOST_INTERFACES)},
    ABBE_OPTIONS(request, &abbe_scene_input_options, changes, NULL, 0),
    ABBE_OPTIONS(request, &abbe_studio_options, changes, NULL, 0),
    {"materials", 0, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1,
     ABBE_TAKE_TEXT(request, materials)},
    {"range", 0, "FROM:TO", 0, "wavelengths, nm (380:780)", 1,
     ABBE_TAKE_RANGE(request, work.min_nm, work.max_nm)},
    {"seed", 0, "N", 0, "of the random numbers (0)", 1,
     ABBE_TAKE_COUNT(request, work.seed, 0, UINT32_MAX)},
    {"threads", 0, "N", 0, "without it, all; results do not depend on it", 1,
     ABBE_TAKE_COUNT(request, work.threads, 1, ABBE_WORK_MOST_THREADS)},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  switch (key) {
  case OPTION_BY:
    if (q->keys == ABBE_DERIVE_MOST_KEYS)
      argp_error(state, "no more than %d keys at a time", ABBE_DERIVE_MOST_KEYS);
    q->key[q->keys++] = text;
    return 0;
  case OPTION_REGION:
    abbe_derive_take_region(q, text, state->name);
    return 0;
  case OPTION_SPACE:
    q->space = (abbe_rgb_space)abbe_command_choice(state->name, "--space", text, spaces,
                                                   ABBE_RGB_SPACE_COUNT);
    return 0;
  case ARGP_KEY_ARG:
    abbe_scene_input_take_file(&q->changes, &q->path, text, state);
    return 0;
  case ARGP_KEY_END:
    if (q->path == NULL) argp_error(state, "of which scene? Try scenes/prism.yaml");
    if (q->keys == 0) argp_error(state, "by what? Give --by KEY, such as objects.prism.apex");
    if ((q->region[2] > 0 || q->target != NULL) && (q->stone != NULL || is_of_map(q)))
      argp_error(state, "--region and --target are of a picture, not of a map or a stone");
    if (q->stone != NULL && (q->exr != NULL || q->width > 0 || q->map.light || q->map.like))
      argp_error(state, "--stone has numbers alone: -o and --map are of pictures and caustics");
    if (q->changes.set_count >= ABBE_SCENE_INPUT_MOST)
      argp_error(state, "no more than %d --set", ABBE_SCENE_INPUT_MOST - 1);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

/* ---- what came of it ---- */

/* A row's number and its standard error; the row 0 is of the scene as it is. */
typedef struct output {
  const request *q;
  size_t count; /* of a row */
  const char *(*name)(size_t number);
  const char *(*unit)(size_t number);
  double (*value)(const void *of, size_t number, size_t row, double *error);
  const void *of;
  const bool *felt;
  double left, lost;
} output;

static const char *map_name(size_t number) {
  return abbe_derivative_number_name((abbe_derivative_number)number);
}

static const char *map_unit(size_t number) {
  return abbe_derivative_number_unit((abbe_derivative_number)number);
}

static double map_value(const void *of, size_t number, size_t row, double *error) {
  return abbe_derivative_number_of(of, (abbe_derivative_number)number, row, error);
}

static const char *picture_name(size_t number) {
  static const char *const names[] = {"mean.R", "mean.G", "mean.B", "ciede2000"};
  return names[number];
}

static const char *picture_unit(size_t number) {
  return number < 3 ? "W/(m2 sr)" : "";
}

static double picture_value(const void *of, size_t number, size_t row, double *error) {
  const abbe_derive_target *t = of;
  double mean[3], deviation[3];
  if (number == 3) return abbe_derive_difference(t, row, error);
  abbe_pixels_mean(t->pixels, row, mean, deviation);
  *error = deviation[number];
  return mean[number];
}

static void print_numbers(const output *o) {
  printf("%-34s %-9s %13s %11s  %s\n", "by", "of", "value", "std error", "unit");
  for (size_t row = 0; row <= o->q->keys; row++)
    for (size_t n = 0; n < o->count; n++) {
      const char *by = n > 0 ? "" : row == 0 ? "(as it is)" : o->q->key[row - 1];
      double error;
      const double value = o->value(o->of, n, row, &error);
      printf("%-34s %-9s %13.5g %11.2g  %s%s\n", by, o->name(n), value, error, o->unit(n),
             row > 0 ? " by one of it" : "");
    }
}

static abbe_result print_json(const output *o, abbe_error *error) {
  cJSON *root = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(root, "rows");
  cJSON_AddStringToObject(root, "scene", o->q->path);
  cJSON_AddNumberToObject(root, "longer_paths", o->left);
  cJSON_AddNumberToObject(root, "lost_jumps", o->lost);
  for (size_t row = 0; row <= o->q->keys; row++) {
    cJSON *one = cJSON_CreateObject();
    cJSON_AddItemToArray(list, one);
    if (row > 0) cJSON_AddStringToObject(one, "by", o->q->key[row - 1]);
    for (size_t n = 0; n < o->count; n++) {
      double e[2];
      e[0] = o->value(o->of, n, row, &e[1]);
      cJSON_AddItemToObject(one, o->name(n), cJSON_CreateDoubleArray(e, 2));
    }
  }
  return abbe_command_print_json(root, true, error);
}

static abbe_result say(const output *o, abbe_error *error) {
  if (o->q->json) ABBE_TRY(print_json(o, error));
  if (!o->q->json) print_numbers(o);
  if (o->q->quiet) return ABBE_OK;
  for (size_t k = 0; k < o->q->keys; k++)
    if (!o->felt[k])
      fprintf(stderr, "note: nothing that %s depends on '%s': its derivative is 0\n",
              o->name == map_name ? "lands" : "is seen", o->q->key[k]);
  fprintf(stderr,
          "left out: %.2g %% of the light, on paths of more than %zu interfaces or less than 1e-4 "
          "of what set out; %.2g %% of the light that jumps at edges, which were lost\n",
          100 * o->left, o->q->interfaces, 100 * o->lost);
  return ABBE_OK;
}

enum { CHANNELS = 6 * (1 + ABBE_DERIVE_MOST_KEYS), NAME = 256 };

/* The values of all rows, and their standard errors, in layers of the keys' names. */
static abbe_result make_image(const request *q, size_t width, size_t height, const char *letters,
                              float (*value)[3], float (*deviation)[3], abbe_image *image,
                              abbe_error *error) {
  static char name[CHANNELS][NAME];
  const char *names[CHANNELS];
  const size_t channels = 6 * (1 + q->keys), texels = width * height;
  for (size_t i = 0; i < channels; i++) {
    const char *key = i < 6 ? "" : q->key[i / 6 - 1];
    snprintf(name[i], NAME, "%s%.200s%s%c", i % 6 < 3 ? "" : "stderr.", key, i < 6 ? "" : ".",
             letters[i % 3]);
    names[i] = name[i];
  }
  ABBE_TRY(abbe_image_make(width, height, channels, names, image, error));
  for (size_t i = 0; i < texels; i++)
    for (size_t c = 0; c < channels; c++)
      image->data[i * channels + c] = (c % 6 < 3 ? value : deviation)[c / 6 * texels + i][c % 3];
  return ABBE_OK;
}

static abbe_result write_map(const request *q, const abbe_derivative_desc *desc,
                             const abbe_derivative *d, abbe_error *error) {
  ABBE_OWNED(abbe_image, image) = {0};
  ABBE_TRY(make_image(q, desc->width, desc->height, "XYZ", d->map, d->error, &image, error));
  ABBE_TRY(abbe_map_layout_write(&desc->layout, desc->base->light->name, &image, error));
  ABBE_TRY(abbe_image_set_attribute(&image, "abbe:derivative",
                                    "layers of a key: W a texel by one unit of the key", error));
  return abbe_exr_write(q->exr, &image, error);
}

static abbe_result write_picture(const request *q, const abbe_pixels_desc *desc,
                                 const abbe_pixels *p, abbe_error *error) {
  ABBE_OWNED(abbe_image, image) = {0};
  ABBE_TRY(make_image(q, desc->width, desc->height, "RGB", p->value, p->error, &image, error));
  abbe_rgb_space_chromaticities(q->space, image.xy);
  ABBE_TRY(abbe_scene_mark_exposure(desc->scene, &image, error));
  ABBE_TRY(abbe_image_set_attribute(&image, "abbe:derivative",
                                    "layers of a key: W/(m2 sr) by one unit of the key", error));
  return abbe_exr_write(q->exr, &image, error);
}

static abbe_result check_size(const request *q, const char *what, size_t width, size_t height,
                              abbe_error *error) {
  if ((1 + q->keys) * width * height <= MOST_TEXELS) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "a %s of %zu x %zu by %zu keys has more than %d million values; ask for a "
                        "smaller one, or for fewer keys at a time",
                        what, width, height, q->keys, MOST_TEXELS >> 20);
}

static abbe_result lay_out(const request *q, abbe_derivative_desc *desc, abbe_error *error) {
  if (q->exr == NULL) return ABBE_OK;
  desc->width = q->width > 0 ? q->width : q->map.side;
  desc->height = q->height > 0 ? q->height : desc->width;
  ABBE_TRY(check_size(q, "map", desc->width, desc->height, error));
  desc->layout = q->map.layout;
  return q->map.like != NULL ? ABBE_OK : abbe_derivative_fit(desc, &desc->layout, error);
}

static abbe_result make_key(const abbe_pixels_key *key, const abbe_specular *base,
                            abbe_derivative_key *out, abbe_error *error) {
  const size_t light = (size_t)(base->light - base->scene->light);
  out->name = key->name;
  out->step = key->step;
  for (int s = 0; s < 2; s++) {
    if (light >= key->moved[s]->light_count)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "--by %.120s changes how many lights there are", key->name);
    ABBE_TRY(abbe_specular_make(key->moved[s], light, &key->shift[s], &out->moved[s], error));
    ABBE_TRY(abbe_specular_match(&out->moved[s], base, key->name, error));
  }
  return ABBE_OK;
}

static abbe_result derive_map(request *q, const abbe_scene *scene, const abbe_pixels_key *key,
                              const abbe_spectral_sampling *sampling, abbe_progress *progress,
                              abbe_error *error) {
  abbe_specular base = {0};
  abbe_derivative d = {0};
  abbe_derivative_key *moved = calloc(q->keys, sizeof *moved);
  abbe_result result = moved == NULL
                           ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the keys")
                           : abbe_specular_make(scene, q->map.light_index, NULL, &base, error);
  if (result == ABBE_OK)
    result = abbe_specular_narrow(&base, sampling->lambda_nm[0],
                                  sampling->lambda_nm[sampling->steps], q->interfaces, error);
  for (size_t k = 0; k < q->keys && result == ABBE_OK; k++)
    result = make_key(&key[k], &base, &moved[k], error);
  abbe_derivative_desc desc = {.base = &base,
                               .light = q->map.light_index,
                               .keys = q->keys,
                               .key = moved,
                               .sampling = sampling,
                               .lines = q->lines,
                               .points = q->points,
                               .interfaces = q->interfaces,
                               .seed = q->work.seed,
                               .threads = q->work.threads,
                               .progress = abbe_progress_update,
                               .user = progress};
  if (result == ABBE_OK) result = lay_out(q, &desc, error);
  if (result == ABBE_OK) result = abbe_derivative_make(&desc, &d, error);
  abbe_progress_end(progress);
  if (result == ABBE_OK && q->exr != NULL) result = write_map(q, &desc, &d, error);
  const output o = {.q = q,
                    .count = ABBE_DERIVATIVE_NUMBER_COUNT,
                    .name = map_name,
                    .unit = map_unit,
                    .value = map_value,
                    .of = &d,
                    .felt = d.felt,
                    .left = d.left,
                    .lost = d.lost};
  if (result == ABBE_OK) result = say(&o, error);
  abbe_derivative_free(&d);
  for (size_t k = 0; k < q->keys && moved != NULL; k++)
    for (int s = 0; s < 2; s++) abbe_specular_free(&moved[k].moved[s]);
  free(moved);
  abbe_specular_free(&base);
  return result;
}

static abbe_result derive_picture(request *q, const abbe_scene *scene, const abbe_pixels_key *key,
                                  const abbe_spectral_sampling *sampling, abbe_progress *progress,
                                  abbe_error *error) {
  abbe_pixels p = {0};
  abbe_derive_target target = {.pixels = &p};
  const size_t *region = q->region;
  const abbe_pixels_desc desc = {.scene = scene,
                                 .keys = q->keys,
                                 .key = key,
                                 .sampling = sampling,
                                 .space = q->space,
                                 .width = q->columns > 0 ? q->columns : scene->camera.width,
                                 .height = q->rows > 0 ? q->rows : scene->camera.height,
                                 .region = {region[0], region[1], region[2], region[3]},
                                 .samples = q->samples,
                                 .lines = q->lines,
                                 .points = q->points,
                                 .map_side = 128,
                                 .interfaces = q->interfaces,
                                 .seed = q->work.seed,
                                 .threads = q->work.threads,
                                 .progress = abbe_progress_update,
                                 .user = progress};
  abbe_result result = check_size(q, "picture", desc.width, desc.height, error);
  if (result == ABBE_OK)
    result = abbe_derive_read_target(q, desc.width, desc.height, &target, error);
  if (result == ABBE_OK) result = abbe_pixels_make(&desc, &p, error);
  abbe_progress_end(progress);
  if (result == ABBE_OK && q->exr != NULL) result = write_picture(q, &desc, &p, error);
  const output o = {.q = q,
                    .count = q->target != NULL ? 4 : 3,
                    .name = picture_name,
                    .unit = picture_unit,
                    .value = picture_value,
                    .of = &target,
                    .felt = p.felt,
                    .left = p.left,
                    .lost = p.lost};
  if (result == ABBE_OK) result = say(&o, error);
  abbe_pixels_free(&p);
  return result;
}

static abbe_result run(request *q, const abbe_scene *scene, abbe_error *error) {
  abbe_spectral_sampling sampling = {0};
  const bool picture = (q->exr != NULL || q->region[2] > 0 || q->target != NULL) && !is_of_map(q);
  abbe_derive_moved *moved = calloc(q->keys, sizeof *moved);
  abbe_pixels_key *key = calloc(q->keys, sizeof *key);
  const abbe_spectral_sampling_desc spectrum = {
      .min_nm = q->work.min_nm > 0 ? q->work.min_nm : ABBE_WAVELENGTH_MIN_NM,
      .max_nm = q->work.max_nm > 0 ? q->work.max_nm : ABBE_WAVELENGTH_MAX_NM,
      .uniform = 0.1};
  abbe_progress progress;
  abbe_result result = moved == NULL || key == NULL
                           ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the keys")
                           : abbe_map_options_resolve(&q->map, scene, true, error);
  if (result == ABBE_OK && scene->light_count == 0 && !picture && q->stone == NULL)
    result =
        abbe_error_set(error, ABBE_UNSUPPORTED,
                       "%s has no light besides its surroundings; a map is of one light", q->path);
  if (result == ABBE_OK) result = abbe_spectral_sampling_make(scene, &spectrum, &sampling, error);
  for (size_t k = 0; k < q->keys && result == ABBE_OK; k++)
    result = abbe_derive_move(q, k, scene, &moved[k], &key[k], error);
  if (result == ABBE_OK && q->stone != NULL) {
    result = abbe_derive_stone(q, scene, key, error);
  } else if (result == ABBE_OK) {
    abbe_progress_begin(&progress, "deriving", q->quiet);
    result = (picture ? derive_picture : derive_map)(q, scene, key, &sampling, &progress, error);
  }
  for (size_t k = 0; k < q->keys && moved != NULL; k++)
    for (int s = 0; s < 2; s++) abbe_scene_free(&moved[k].scene[s]);
  free(moved);
  free(key);
  abbe_spectral_sampling_free(&sampling);
  return result;
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "SCENE.yaml",
    .doc =
        "Says how the camera's picture changes with scalars of the scene, pixel by pixel, or what "
        "a light throws through refractors and off mirrors: the derivative of the receiver map's "
        "texels (XYZ), and of the light's flux, chromaticity, middle and spread. All are by one "
        "unit of each key (angles in degrees, lengths in metres). Paths are followed in double "
        "precision, edges of facets and shadows are "
        "included, and standard errors are given. With --stone it is of what a stone returns of "
        "light.\v"
        "Examples:\n"
        "  abbe derive scenes/prism.yaml --by objects.prism.apex --by materials.sf10.n\n"
        "  abbe derive scenes/sphere.yaml --by objects.ball.radius --size 128x128 -o ball.exr\n"
        "  abbe derive scenes/sphere.yaml --by objects.ball.radius --map 128x128 -o map.exr\n"
        "  abbe derive scenes/sphere.yaml --by objects.ball.radius --size 128x128 --region "
        "60,80,16,16 --target wanted.exr\n"
        "  abbe derive scenes/gem.yaml --by lights.lamp.position.0 --by lights.lamp.intensity "
        "--json\n"
        "  abbe derive scenes/stone.yaml --stone stone --by objects.stone.pavilion --by "
        "materials.quartz.n\n",
};

int abbe_command_derive(int argc, char **argv) {
  request q = {.program = argv[0], .samples = 32, .lines = 1024, .points = 64, .interfaces = 12};
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
