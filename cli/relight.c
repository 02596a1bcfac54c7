#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/picture_options.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/spectral_picture/relight.h"

#include <stdio.h>

typedef struct request {
  const char *program, *in, *exr, *png;
  abbe_spectral_options spectral;
  abbe_relight_desc desc;
  abbe_exr_reader *file;
  abbe_screen_options screen;
} request;

static abbe_result relight(const request *r, const abbe_image *image, abbe_error *error) {
  ABBE_OWNED(abbe_image, out) = {0};
  abbe_relight_desc desc = r->desc;
  abbe_image_odd odd = {0};
  desc.view = r->spectral.view;
  desc.odd = &odd;
  desc.file = r->file;
  abbe_spectral_options_note_unread(image, desc.layer, r->in);
  ABBE_TRY(abbe_relight_make(image, r->in, &desc, &out, error));
  if (r->png != NULL) odd.nan = 0; /* its note says it */
  abbe_command_note_odd(r->in, &odd, "counted as the brightest finite band, or as 65504");
  if (r->spectral.illuminant != NULL)
    ABBE_TRY(abbe_image_set_attribute(&out, "abbe:illuminant", r->spectral.illuminant, error));
  if (r->exr != NULL) ABBE_TRY(abbe_exr_write(r->exr, &out, error));
  if (r->png != NULL)
    ABBE_TRY(abbe_screen_options_write(&r->screen, r->png, &out, NULL, r->in, error));
  fprintf(stderr, "%s; 1 is %s\n", abbe_image_attribute_text(&out, "abbe:observer"),
          abbe_image_attribute_text(&out, "abbe:unit"));
  return ABBE_OK;
}

enum { KEY_SPACE = 256 };

static const abbe_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES,
     "the scene-linear picture, .exr; or that for a display, by its ending as --png", 0,
     ABBE_TAKE_OUTPUT(request, exr, png)},
    {"png", 0, "OUT.png", ABBE_ARGUMENT_WRITES,
     "the picture for a display, through OpenColorIO: .png, .webp, .jpg, .gif or .avif", 0,
     ABBE_TAKE_OUTPUT(request, png, png)},
    {"space", KEY_SPACE, "NAME", 0, "acescg, rec709 or xyz; without it, acescg", 0,
     ABBE_TAKE_BY_KEY},
    {"layer", 0, "NAME", 0, "the channels NAME.S0.550nm …", 0, ABBE_TAKE_TEXT(request, desc.layer)},
    {"bands", 0, NULL, 0, "keep the bands too, under the new illuminant", 0,
     ABBE_TAKE_FLAG(request, desc.bands)},
    {"relative", 0, NULL, 0,
     "without --lit-by: an even 1 W/(m2 sr nm) is Y = 1, not lm (of a radiance: cd/m2)", 0,
     ABBE_TAKE_FLAG(request, desc.relative)},
    ABBE_OPTIONS(request, &abbe_spectral_options_argp, spectral,
                 "How the spectrum is looked at:", 1),
    ABBE_OPTIONS(request, &abbe_screen_options_argp, screen,
                 "How the picture for a display shows it:", 2),
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  const char *spaces[ABBE_RGB_SPACE_COUNT];
  request *r = state->input;
  switch (key) {
  case KEY_SPACE:
    for (int i = 0; i < ABBE_RGB_SPACE_COUNT; i++)
      spaces[i] = abbe_rgb_space_name((abbe_rgb_space)i);
    r->desc.space = (abbe_rgb_space)abbe_command_choice(r->program, "--space", text, spaces,
                                                        ABBE_RGB_SPACE_COUNT);
    return 0;
  case ARGP_KEY_END:
    abbe_arguments_one_file(key, text, &r->in, state);
    if (r->exr == NULL && r->png == NULL)
      argp_error(state, "where to? Give -o FILE.exr, --png FILE.png or both");
    abbe_screen_options_end(&r->screen, r->png, state);
    return 0;
  default:
    return abbe_arguments_one_file(key, text, &r->in, state);
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "IN.exr",
    .doc =
        "Shows a spectral picture to another observer, or under another illuminant, by its bands: "
        "nothing is rendered anew.\v"
        "Examples:\n"
        "  abbe relight bands.exr --lit-by D65 --illuminant A -o evening.exr --png evening.png\n"
        "  abbe relight bands.exr --lit-by D65 --observer 1964 --space xyz -o wide.exr\n"
        "  abbe relight bands.exr --lit-by D65 --illuminant led.csv --bands -o led.exr\n"
        "  abbe relight chart.exr --illuminant D50 --png chart.png --gamut white\n",
};

int abbe_command_relight(int argc, char **argv) {
  request r = {.program = argv[0], .spectral.program = argv[0], .screen.program = argv[0]};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  abbe_error error = {0};
  abbe_image image = {0};
  const char *const targets[] = {r.exr, r.png};
  abbe_result result = abbe_command_check_targets(targets, 2, &error);
  if (result == ABBE_OK && r.png != NULL)
    result = abbe_screen_options_check(&r.screen, r.png, r.desc.space, &error);
  if (result == ABBE_OK) result = abbe_spectral_options_load(&r.spectral, &error);
  if (result == ABBE_OK) result = abbe_command_open_picture(r.in, &r.file, &image, &error);
  if (result == ABBE_OK) result = relight(&r, &image, &error);
  abbe_image_free(&image);
  abbe_exr_close(r.file);
  abbe_spectral_options_free(&r.spectral);
  return abbe_command_end(r.program, result, &error);
}
