#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include "colorimetry/image/display_ocio.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/rgb_space.h"

#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct request {
  const char *program, *in, *out, *layer;
  abbe_display_desc desc;
  int bits;
  bool list;
} request;

static abbe_result list_views(const request *r, abbe_error *error) {
  char *text = NULL;
  abbe_result result = abbe_display_list(r->desc.config, &text, error);
  if (result == ABBE_OK) fputs(text, stdout);
  free(text);
  return result;
}

/* The names that pictures go by, in order of preference; a lone Y is a grey. */
static const char *const triples[][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}, {"Y", "Y", "Y"}};
enum { TRIPLE_RGB, TRIPLE_XYZ, TRIPLE_GREY, TRIPLE_COUNT };

static bool find_triple(const abbe_image *image, const char *layer, int triple, size_t at[3]) {
  for (int k = 0; k < 3; k++) {
    char name[300];
    snprintf(name, sizeof name, "%s%s%s", layer ? layer : "", layer ? "." : "", triples[triple][k]);
    at[k] = abbe_image_find_channel(image, name);
    if (at[k] == (size_t)-1) return false;
  }
  return true;
}

static abbe_result no_triple(const request *r, const abbe_image *image, abbe_error *error) {
  char known[700] = "";
  for (size_t i = 0; i < image->channels; i++) {
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", image->channel[i]);
  }
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "%s: it has no channels R, G, B (nor X, Y, Z, nor Y)%s%s%s; it has: %s",
                        r->in, r->layer ? " in the layer '" : "", r->layer ? r->layer : "",
                        r->layer ? "'" : "", known);
}

/* The three channels to show, as an image of their own. */
static abbe_result pick_channels(const request *r, const abbe_image *image, abbe_image *picked,
                                 int *triple, abbe_error *error) {
  size_t at[3];
  for (*triple = 0; *triple < TRIPLE_COUNT; ++*triple)
    if (find_triple(image, r->layer, *triple, at)) break;
  if (*triple == TRIPLE_COUNT) return no_triple(r, image, error);
  abbe_result result =
      abbe_image_make(image->width, image->height, 3, triples[TRIPLE_RGB], picked, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < image->width * image->height; i++)
    for (int k = 0; k < 3; k++)
      picked->data[3 * i + (size_t)k] = image->data[i * image->channels + at[k]];
  return ABBE_OK;
}

static const struct {
  double xy[8];
  const char *ocio_name;
} other_spaces[] = {
    {{0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, 0.32168, 0.33767}, "ACES2065-1"},
};

static bool same_xy(const double a[8], const double b[8]) {
  for (int i = 0; i < 8; i++)
    if (!(fabs(a[i] - b[i]) < 1e-3)) return false;
  return true;
}

static bool is_stated(const double xy[8]) {
  for (int i = 0; i < 8; i++)
    if (xy[i] != 0) return true;
  return false;
}

static const char *space_of_chromaticities(const double xy[8]) {
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    double known[8];
    abbe_rgb_space_chromaticities((abbe_rgb_space)s, known);
    if (same_xy(xy, known)) return abbe_rgb_space_ocio_name((abbe_rgb_space)s);
  }
  return same_xy(xy, other_spaces[0].xy) ? other_spaces[0].ocio_name : NULL;
}

/* What the command line says, else the file's own word, else its channels' names, else its
 * chromaticities; NULL (the configuration's scene_linear) where it is silent. */
static abbe_result find_source(const request *r, const abbe_image *image, int triple,
                               const char **space, abbe_error *error) {
  *space = r->desc.source_space;
  if (*space != NULL) return ABBE_OK;
  const char *word = abbe_image_attribute_text(image, "abbe:space");
  for (int s = 0; word != NULL && s < ABBE_RGB_SPACE_COUNT; s++)
    if (strcasecmp(word, abbe_rgb_space_name((abbe_rgb_space)s)) == 0) {
      *space = abbe_rgb_space_ocio_name((abbe_rgb_space)s);
      return ABBE_OK;
    }
  if (word != NULL)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: its attribute abbe:space is '%.60s', not acescg, rec709 or xyz; "
                          "--source names the space",
                          r->in, word);
  if (triple == TRIPLE_XYZ) *space = abbe_rgb_space_ocio_name(ABBE_RGB_SPACE_XYZ);
  if (*space != NULL || !is_stated(image->xy)) return ABBE_OK;
  *space = space_of_chromaticities(image->xy);
  if (*space != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_COLOUR,
                        "%s: its chromaticities, red (%g, %g) to white (%g, %g), are of no known "
                        "space; --source names the space",
                        r->in, image->xy[0], image->xy[1], image->xy[6], image->xy[7]);
}

static abbe_result display(const request *r, const abbe_image *image, abbe_error *error) {
  abbe_image picked = {0};
  abbe_display *transform = NULL;
  abbe_display_desc desc = r->desc;
  int triple = 0;
  abbe_result result = pick_channels(r, image, &picked, &triple, error);
  if (result == ABBE_OK) result = find_source(r, image, triple, &desc.source_space, error);
  if (result == ABBE_OK) result = abbe_display_make(&desc, &transform, error);
  if (result == ABBE_OK) result = abbe_display_apply(transform, &picked, error);
  if (result == ABBE_OK) result = abbe_png_write(r->out, &picked, r->bits, error);
  abbe_display_free(transform);
  abbe_image_free(&picked);
  return result;
}

enum {
  KEY_OCIO = 256,
  KEY_DISPLAY,
  KEY_VIEW,
  KEY_EXPOSURE,
  KEY_BITS,
  KEY_LIST,
  KEY_SOURCE,
  KEY_LAYER
};

static const struct argp_option options[] = {
    {"output", 'o', "OUT.png", ABBE_ARGUMENT_WRITES, "the PNG to write", 0},
    {"ocio", KEY_OCIO, "FILE", ABBE_ARGUMENT_READS,
     "the configuration; without it, $OCIO, else the shipped one", 0},
    {"display", KEY_DISPLAY, "NAME", 0, "the screen; without it, the configuration's first", 0},
    {"view", KEY_VIEW, "NAME", 0, "how to show it; without it, the display's first", 0},
    {"exposure", KEY_EXPOSURE, "STOPS", 0, "brighten (or darken) before the view", 0},
    {"bits", KEY_BITS, "8|16", 0, "of the PNG; without it, 8", 0},
    {"layer", KEY_LAYER, "NAME", 0, "show the layer NAME.R, NAME.G, NAME.B", 0},
    {"source", KEY_SOURCE, "SPACE", 0,
     "the picture's colour space; without it, what the file says, else scene_linear", 0},
    {"list", KEY_LIST, NULL, 0, "list the displays and their views", 0},
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  static const char *const bits[] = {"8", "16"};
  request *r = state->input;
  switch (key) {
  case 'o':
    r->out = abbe_command_target(state->name, "-o", arg, ".png");
    return 0;
  case KEY_OCIO:
    r->desc.config = arg;
    return 0;
  case KEY_DISPLAY:
    r->desc.display = arg;
    return 0;
  case KEY_VIEW:
    r->desc.view = arg;
    return 0;
  case KEY_SOURCE:
    r->desc.source_space = arg;
    return 0;
  case KEY_LAYER:
    r->layer = arg;
    return 0;
  case KEY_LIST:
    r->list = true;
    return 0;
  case KEY_EXPOSURE:
    r->desc.exposure = abbe_command_number(r->program, "--exposure", arg,
                                           -ABBE_DISPLAY_MAX_EXPOSURE, ABBE_DISPLAY_MAX_EXPOSURE);
    return 0;
  case KEY_BITS:
    r->bits = abbe_command_choice(r->program, "--bits", arg, bits, 2) == 0 ? 8 : 16;
    return 0;
  case ARGP_KEY_ARG:
    if (r->in != NULL) argp_error(state, "'%s' is one argument too many", arg);
    r->in = arg;
    return 0;
  case ARGP_KEY_END:
    if (!r->list && r->in == NULL) argp_error(state, "which file?");
    if (!r->list && r->out == NULL) argp_error(state, "-o names the PNG to write");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "IN.exr -o OUT.png\n--list",
    .doc = "Turns a linear OpenEXR picture into a PNG for a screen, through OpenColorIO.\v"
           "Examples:\n"
           "  abbe display gem.exr -o gem.png\n"
           "  abbe display gem.exr -o gem.png --view Plain --exposure 1.5 --bits 16\n"
           "  abbe display gem.exr -o caustic.png --layer caustic\n"
           "  abbe display --list --ocio studio.ocio\n",
};

int abbe_command_display(int argc, char **argv) {
  request r = {.program = argv[0], .bits = 8};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  abbe_error error = {0};
  if (r.list) return abbe_command_end(r.program, list_views(&r, &error), &error);
  abbe_image image = {0};
  abbe_result result = abbe_exr_read(r.in, &image, &error);
  if (result == ABBE_OK) result = display(&r, &image, &error);
  abbe_image_free(&image);
  return abbe_command_end(r.program, result, &error);
}
