#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/picture_options.h"

#include "base/number.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/plot/false_colours.h"
#include "colorimetry/screen/lut.h"
#include "colorimetry/spectral_picture/relight.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
  const char *program, *in, *out, *layer;
  const char *source; /* --source's space */
  abbe_spectral_options spectral;
  abbe_screen_options screen;
  size_t nodes; /* of a table, and its stops; 0: the default */
  double low, high;
  abbe_exr_reader *file; /* of an OpenEXR, whose pixels are read as they are needed */
  bool list;
} request;

static abbe_result list_views(const request *r, abbe_error *error) {
  ABBE_FREED char *text = NULL;
  ABBE_TRY(abbe_display_list(r->screen.display.config, &text, error));
  fputs(text, stdout);
  return ABBE_OK;
}

static abbe_result show_spectrum(const request *r, const abbe_image *image, abbe_error *error) {
  abbe_image_odd odd = {0};
  const abbe_relight_desc desc = {.layer = r->layer,
                                  .view = r->spectral.view,
                                  .space = ABBE_RGB_SPACE_XYZ,
                                  .relative = true,
                                  .file = r->file,
                                  .odd = &odd};
  ABBE_OWNED(abbe_image, xyz) = {0};
  if (r->source != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: --source names the space of R, G, B; here the colours are of the "
                          "spectrum, in XYZ",
                          r->in);
  abbe_spectral_options_note_unread(image, r->layer, r->in);
  ABBE_TRY(abbe_relight_make(image, r->in, &desc, &xyz, error));
  odd.nan = 0; /* the picture's own note says it */
  abbe_command_note_odd(r->in, &odd, "counted as the brightest finite band, or as 65504");
  fprintf(stderr, "note: the colour of the spectrum, %s; 1 is white %s\n",
          abbe_observer_text(desc.view.observer), abbe_image_attribute_text(&xyz, "abbe:unit"));
  return abbe_screen_options_write(&r->screen, r->out, &xyz, NULL, r->in, error);
}

static abbe_result show_numbers(const request *r, const abbe_image *image, abbe_error *error) {
  const char *given = r->source != NULL ? "--source" : r->screen.given;
  if (given != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: '%s' is no colour and is shown in false colours, without %s", r->in,
                          r->layer, given);
  const size_t channel = abbe_image_find_channel(image, r->layer);
  abbe_image_odd odd = {0};
  if (channel != (size_t)-1) abbe_image_count_odd(image, &channel, 1, &odd);
  abbe_command_note_odd(r->in, &odd, "drawn as the scale's end");
  return abbe_false_colours_write(r->out, image, r->layer, r->in, error);
}

static void note_observer(const request *r, const abbe_image *image) {
  const char *text = abbe_image_attribute_text(image, "abbe:observer");
  if (text == NULL || abbe_observer_find(text) == ABBE_OBSERVER_CIE_1931) return;
  fprintf(stderr,
          "note: %s is for the observer %s; screens are made for that of 1931, so its white is not "
          "theirs\n",
          r->in, text);
}

static abbe_result display(const request *r, abbe_image *image, abbe_error *error) {
  const bool numbers = !r->spectral.given && abbe_false_colours_mean(image, r->layer);
  if (r->spectral.given || (!numbers && abbe_relight_is_needed(image, r->layer)))
    return show_spectrum(r, image, error);
  if (r->file != NULL) {
    abbe_image_free(image);
    ABBE_TRY(abbe_exr_read_first(r->file, SIZE_MAX, image, error));
  }
  if (numbers) return show_numbers(r, image, error);
  note_observer(r, image);
  return abbe_screen_options_write(&r->screen, r->out, image, r->layer, r->in, error);
}

/* "sRGB / Looking": what the options choose of the list, whose first lines are the defaults. */
static abbe_result name_view(const request *r, char *out, size_t size, abbe_error *error) {
  const abbe_display_desc *d = &r->screen.display;
  char *text = NULL, *rest = NULL;
  const size_t length = d->display ? strlen(d->display) : 0;
  ABBE_TRY(abbe_display_list(d->config, &text, error));
  snprintf(out, size, "%s", d->display ? d->display : "its default");
  for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
    if (d->display && (strncmp(line, d->display, length) != 0 || line[length] != ' ')) continue;
    const char *view = strrchr(line, '/');
    if (d->view && view)
      snprintf(out, size, "%.*s/ %s", (int)(view - line), line, d->view);
    else
      snprintf(out, size, "%s", line);
    break;
  }
  free(text);
  return ABBE_OK;
}

static abbe_result write_table(const request *r, abbe_error *error) {
  abbe_display_desc desc = r->screen.display;
  if (desc.source_space == NULL) desc.source_space = "ACEScg";
  char view[200];
  ABBE_HELD(abbe_display, display) = NULL;
  abbe_lut_error off;
  ABBE_TRY(abbe_display_make(&desc, &display, error));
  ABBE_TRY(name_view(r, view, sizeof view, error));
  const abbe_lut_desc lut = {.display = display,
                             .input = desc.source_space,
                             .output = view,
                             .nodes = r->nodes,
                             .low = r->low,
                             .high = r->high};
  ABBE_TRY(abbe_lut_write(&lut, r->out, &off, error));
  fprintf(stderr,
          "note: %s is from %s to %s; between its nodes it is off by %.2g on average "
          "and %.2g at most, greys by %.2g at most, of the display's white\n",
          r->out, lut.input, view, off.mean, off.most, off.most_grey);
  return ABBE_OK;
}

enum { KEY_SOURCE = 256, KEY_STOPS };

static const abbe_option options[] = {
    {"output", 'o', "OUT.png|OUT.cube", ABBE_ARGUMENT_WRITES,
     "the picture to write, .png, .webp, .jpg, .gif or .avif; .cube or .clf: the view as a table "
     "for other programs, "
     "of no picture",
     0, ABBE_TAKE_BY_KEY},
    {"nodes", 0, "N", 0, "of each side of a table (33)", 0,
     ABBE_TAKE_COUNT(request, nodes, ABBE_LUT_MIN_NODES, ABBE_LUT_MAX_NODES)},
    {"stops", KEY_STOPS, "LOW:HIGH", 0, "what a table covers, from 0.18 (-10:6.5)", 0,
     ABBE_TAKE_BY_KEY},
    {"layer", 0, "NAME", 0,
     "show the layer NAME.R, NAME.G, NAME.B; a channel, a band (550nm) or a standard error "
     "(stderr) "
     "in false colours",
     0, ABBE_TAKE_TEXT(request, layer)},
    {"source", KEY_SOURCE, "SPACE", 0,
     "the picture's colour space; without it, what the file says, else linear Rec.709", 0,
     ABBE_TAKE_BY_KEY},
    {"list", 0, NULL, 0, "list the displays and their views", 0, ABBE_TAKE_FLAG(request, list)},
    ABBE_OPTIONS(request, &abbe_spectral_options_argp, spectral,
                 "A spectral picture by its bands, not by its R, G, B:", 1),
    ABBE_OPTIONS(request, &abbe_screen_options_argp, screen, "How it is shown:", 2),
    {0}};

static void take_stops(const char *text, request *r, struct argp_state *state) {
  const char *at = text;
  if (!abbe_number_read(at, &at, &r->low) || *at++ != ':' || !abbe_number_read(at, &at, &r->high) ||
      *at != '\0' || !(r->low < r->high))
    argp_error(state, "--stops '%s' is no range such as -10:6.5", text);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case 'o':
    if (abbe_lut_is_meant(arg))
      r->out = arg;
    else
      abbe_command_output(state->name, "-o", arg, NULL, &r->out);
    return 0;
  case KEY_SOURCE:
    r->source = arg;
    r->screen.display.source_space = arg;
    return 0;
  case KEY_STOPS:
    take_stops(arg, r, state);
    return 0;
  case ARGP_KEY_END:
    if (r->list) return 0;
    if (r->out != NULL && abbe_lut_is_meant(r->out)) {
      const char *picture = r->in != NULL             ? r->in
                            : r->layer != NULL        ? "--layer"
                            : r->screen.exposed       ? "--exposure auto"
                            : r->screen.bits != 0     ? "--bits"
                            : r->screen.glare_deg > 0 ? "--glare"
                            : r->spectral.given       ? "the options of spectral pictures"
                                                      : NULL;
      if (picture != NULL)
        argp_error(state, "a table is of a view, not of a picture: leave out %s", picture);
      return 0;
    }
    if (r->nodes != 0 || r->low != r->high)
      argp_error(state, "%s is for a table: give -o FILE.cube or FILE.clf",
                 r->nodes != 0 ? "--nodes" : "--stops");
    abbe_arguments_one_file(key, arg, &r->in, state);
    if (r->out == NULL) argp_error(state, "-o names the picture to write, such as OUT.png");
    abbe_screen_options_end(&r->screen, r->out, state);
    return 0;
  default:
    return abbe_arguments_one_file(key, arg, &r->in, state);
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "IN.exr -o OUT.png\n-o OUT.cube|OUT.clf\n--list",
    .doc =
        "Turns a linear OpenEXR picture into a PNG, WebP, JPEG, GIF or AVIF for a screen, through "
        "OpenColorIO.\v"
        "Examples:\n"
        "  abbe display gem.exr -o gem.png\n"
        "  abbe display gem.exr -o gem.png --view Plain --exposure 1.5 --bits 16\n"
        "  abbe display gem.exr -o caustic.png --layer caustic\n"
        "  abbe display bands.exr -o band.png --layer 550nm\n"
        "  abbe display parts.exr#rgba -o rgba.png\n"
        "  abbe display gem.exr -o error.png --layer stderr\n"
        "  abbe display bands.exr -o evening.png --lit-by D65 --illuminant A\n"
        "  abbe display lamp.exr -o lamp.png --white 2856 --gamut white\n"
        "  abbe display gem.exr -o gem.png --display 'Rec.2100 PQ'\n"
        "  abbe display gem.exr -o gem.jpg --exposure auto\n"
        "  abbe display gem.exr -o gem.avif --display 'Rec.2100 PQ' --bits 12\n"
        "  abbe display -o look.cube --view Looking --source ACEScg\n"
        "  abbe display --list --ocio studio.ocio\n",
};

int abbe_command_display(int argc, char **argv) {
  request r = {.program = argv[0], .spectral.program = argv[0], .screen.program = argv[0]};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  abbe_error error = {0};
  if (r.list) return abbe_command_end(r.program, list_views(&r, &error), &error);
  if (abbe_lut_is_meant(r.out)) return abbe_command_end(r.program, write_table(&r, &error), &error);
  abbe_image image = {0};
  abbe_result result = abbe_spectral_options_load(&r.spectral, &error);
  if (result == ABBE_OK) result = abbe_command_open_picture(r.in, &r.file, &image, &error);
  if (result == ABBE_OK) result = display(&r, &image, &error);
  abbe_image_free(&image);
  abbe_exr_close(r.file);
  abbe_spectral_options_free(&r.spectral);
  return abbe_command_end(r.program, result, &error);
}
