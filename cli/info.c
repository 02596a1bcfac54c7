#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include "base/text.h"
#include "colorimetry/image/image.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct request {
  const char *program, *path;
  bool json;
} request;

/* Statistics of one channel; min, max and mean over its finite samples, NaN where there is none. */
typedef struct statistics {
  double min, max, mean;
  size_t nan, inf;
} statistics;

static statistics measure(const abbe_image *image, size_t channel) {
  statistics s = {.min = NAN, .max = NAN, .mean = 0};
  size_t pixels = image->width * image->height, finite = 0;
  for (size_t i = 0; i < pixels; i++) {
    double v = (double)image->data[i * image->channels + channel];
    if (isnan(v)) s.nan++;
    if (isinf(v)) s.inf++;
    if (!isfinite(v)) continue;
    s.min = fmin(s.min, v);
    s.max = fmax(s.max, v);
    s.mean += v;
    finite++;
  }
  s.mean = finite > 0 ? s.mean / (double)finite : NAN;
  return s;
}

static bool has_chromaticities(const abbe_image *image) {
  for (int i = 0; i < 8; i++)
    if (image->xy[i] != 0) return true;
  return false;
}

static bool same_window(abbe_image_window a, abbe_image_window b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

/* Only what is not as in most pictures: data for all that is shown, from (0, 0). */
static void print_windows(const abbe_image *image) {
  const abbe_image_window shown = image->display_window, data = image->data_window;
  if (shown.x0 != 0 || shown.y0 != 0 || !same_window(shown, data))
    printf("display window  (%d, %d) to (%d, %d): what is shown and measured\n", (int)shown.x0,
           (int)shown.y0, (int)shown.x1, (int)shown.y1);
  if (same_window(shown, data)) return;
  const bool apart =
      data.x0 > shown.x1 || data.x1 < shown.x0 || data.y0 > shown.y1 || data.y1 < shown.y0;
  const bool over =
      data.x0 < shown.x0 || data.y0 < shown.y0 || data.x1 > shown.x1 || data.y1 > shown.y1;
  const bool under =
      data.x0 > shown.x0 || data.y0 > shown.y0 || data.x1 < shown.x1 || data.y1 < shown.y1;
  printf("data window     (%d, %d) to (%d, %d): %s%s%s\n", (int)data.x0, (int)data.y0, (int)data.x1,
         (int)data.y1, under ? "elsewhere the picture is 0" : "", under && over ? "; " : "",
         apart  ? "nothing of it is shown"
         : over ? "what lies outside the display window is left out"
                : "");
}

/* Lines after the first are set in: what a file says must not look like what the program says. Some
 * programs write whole tables on a line. */
static void print_attribute(const abbe_image_attribute *attribute) {
  enum { MOST = 400 };
  char name[256];
  size_t column = 0;
  abbe_utf8_printable(attribute->name, strlen(attribute->name), false, name, sizeof name);
  printf("%s: ", name);
  for (const char *c = attribute->text; *c != '\0'; c++) {
    column = *c == '\n' ? 0 : column + ((*c & 0xc0) != 0x80);
    if (column <= MOST) putchar(*c);
    if (*c == '\n') printf("    ");
    if (column == MOST + 1 && (*c & 0xc0) != 0x80) printf("… (--json has all)");
  }
  putchar('\n');
}

static void print_text(const request *r, const abbe_image *image) {
  printf("%s: %zu x %zu pixels, %zu channels\n", r->path, image->width, image->height,
         image->channels);
  if (image->part[0] != '\0') printf("part            %s\n", image->part);
  print_windows(image);
  const double *xy = image->xy;
  if (has_chromaticities(image))
    printf("chromaticities  R (%.5g, %.5g)  G (%.5g, %.5g)  B (%.5g, %.5g)  white (%.5g, %.5g)\n",
           xy[0], xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7]);
  for (size_t i = 0; i < image->attribute_count; i++) print_attribute(&image->attribute[i]);
  printf("\n%-20s %12s %12s %12s %8s %8s\n", "channel", "min", "max", "mean", "NaN", "inf");
  for (size_t c = 0; c < image->channels; c++) {
    statistics s = measure(image, c);
    char name[256];
    abbe_utf8_printable(image->channel[c], strlen(image->channel[c]), false, name, sizeof name);
    printf("%-20s %12.6g %12.6g %12.6g %8zu %8zu\n", name, s.min, s.max, s.mean, s.nan, s.inf);
  }
}

static bool add_channel(cJSON *list, const abbe_image *image, size_t c) {
  cJSON *item = cJSON_CreateObject();
  if (!cJSON_AddItemToArray(list, item)) return false;
  statistics s = measure(image, c);
  /* cJSON writes NaN as null */
  return cJSON_AddStringToObject(item, "name", image->channel[c]) != NULL &&
         cJSON_AddNumberToObject(item, "min", s.min) != NULL &&
         cJSON_AddNumberToObject(item, "max", s.max) != NULL &&
         cJSON_AddNumberToObject(item, "mean", s.mean) != NULL &&
         cJSON_AddNumberToObject(item, "nan", (double)s.nan) != NULL &&
         cJSON_AddNumberToObject(item, "inf", (double)s.inf) != NULL;
}

/* Both ends are included. */
static bool add_window(cJSON *root, const char *name, abbe_image_window w) {
  const int corner[] = {w.x0, w.y0, w.x1, w.y1};
  return cJSON_AddItemToObject(root, name, cJSON_CreateIntArray(corner, 4));
}

static bool add_header(cJSON *root, const request *r, const abbe_image *image) {
  cJSON *xy =
      has_chromaticities(image) ? cJSON_CreateDoubleArray(image->xy, 8) : cJSON_CreateNull();
  bool made =
      cJSON_AddStringToObject(root, "file", r->path) != NULL &&
      cJSON_AddNumberToObject(root, "width", (double)image->width) != NULL &&
      cJSON_AddNumberToObject(root, "height", (double)image->height) != NULL &&
      (image->part[0] == '\0' || cJSON_AddStringToObject(root, "part", image->part) != NULL) &&
      add_window(root, "display_window", image->display_window) &&
      add_window(root, "data_window", image->data_window) &&
      cJSON_AddItemToObject(root, "chromaticities", xy);
  cJSON *attributes = cJSON_AddObjectToObject(root, "attributes");
  for (size_t i = 0; made && i < image->attribute_count; i++)
    made = cJSON_AddStringToObject(attributes, image->attribute[i].name,
                                   image->attribute[i].text) != NULL;
  return made;
}

static abbe_result print_json(const request *r, const abbe_image *image, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  bool made = add_header(root, r, image);
  cJSON *list = cJSON_AddArrayToObject(root, "channels");
  for (size_t c = 0; made && c < image->channels; c++) made = add_channel(list, image, c);
  return abbe_command_print_json(root, made, error);
}

static const abbe_option options[] = {
    {"json", 0, NULL, 0, "as JSON, numbers in full", 0, ABBE_TAKE_FLAG(request, json)}, {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  return abbe_arguments_one_file(key, arg, &r->path, state);
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "FILE.exr",
    .doc =
        "Says what an OpenEXR picture holds: size, windows, chromaticities, text attributes, and "
        "for "
        "every channel the least, greatest and mean of its finite samples and how many are none.\v"
        "Examples:\n"
        "  abbe info gem.exr\n"
        "  abbe info gem.exr --json\n",
};

int abbe_command_info(int argc, char **argv) {
  request r = {.program = argv[0]};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  abbe_image image = {0};
  abbe_error error = {0};
  abbe_result result = abbe_command_read_picture(r.path, &image, &error);
  if (result == ABBE_OK && r.json)
    result = print_json(&r, &image, &error);
  else if (result == ABBE_OK)
    print_text(&r, &image);
  abbe_image_free(&image);
  return abbe_command_end(r.program, result, &error);
}
