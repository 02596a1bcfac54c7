#include "cli/options/picture_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "colorimetry/colour_temperature.h"
#include "colorimetry/screen/screen_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_OBSERVER = 0x900, OPTION_LIT_BY, OPTION_ILLUMINANT };

static const abbe_option options[] = {
    {"observer", OPTION_OBSERVER, "NAME", 0,
     "of the spectrum's colour: 1931, 1964, 2015-2 or 2015-10; without it, 1931", 0,
     ABBE_TAKE_BY_KEY},
    {"lit-by", OPTION_LIT_BY, "NAME|FILE", ABBE_ARGUMENT_READS,
     "the illuminant that all lights of the scene have", 0, ABBE_TAKE_BY_KEY},
    {"illuminant", OPTION_ILLUMINANT, "NAME|FILE", ABBE_ARGUMENT_READS,
     "another to see the spectrum under (a reflectance: D65 without it)", 0, ABBE_TAKE_BY_KEY},
    {0}};

abbe_observer abbe_spectral_options_observer(const char *program, const char *text) {
  const char *names[ABBE_OBSERVER_COUNT];
  for (int i = 0; i < ABBE_OBSERVER_COUNT; i++) names[i] = abbe_observer_name((abbe_observer)i);
  const abbe_observer known = abbe_observer_find(text);
  if (known != ABBE_OBSERVER_COUNT) return known;
  return (abbe_observer)abbe_command_choice(program, "--observer", text, names,
                                            ABBE_OBSERVER_COUNT);
}

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_spectral_options *o = state->input;
  switch (key) {
  case OPTION_OBSERVER:
    o->view.observer = abbe_spectral_options_observer(o->program, text);
    break;
  case OPTION_LIT_BY:
    o->lit_by = text;
    break;
  case OPTION_ILLUMINANT:
    o->illuminant = text;
    break;
  default:
    return ARGP_ERR_UNKNOWN;
  }
  o->given = true;
  return 0;
}

const abbe_parser abbe_spectral_options_argp = {.options = options, .parse = parse};

static abbe_result make_light(const char *name, abbe_illuminant *light,
                              const abbe_illuminant **used, abbe_error *error) {
  if (name == NULL) return ABBE_OK;
  *used = light;
  return abbe_illuminant_make(name, light, error);
}

abbe_result abbe_spectral_options_load(abbe_spectral_options *o, abbe_error *error) {
  ABBE_TRY(make_light(o->lit_by, &o->from, &o->view.from, error));
  return make_light(o->illuminant, &o->to, &o->view.to, error);
}

void abbe_spectral_options_free(abbe_spectral_options *o) {
  abbe_illuminant_free(&o->from);
  abbe_illuminant_free(&o->to);
}

void abbe_spectral_options_note_unread(const abbe_image *image, const char *layer,
                                       const char *name) {
  static const char *const what[ABBE_SPECTRAL_UNREAD_COUNT] = {
      "of polarised light",
      "of re-radiation between wavelengths that are no bands of a reflectance",
      "named as bands are not: S0.550nm is right", "whose wavelength is no number above 0"};
  abbe_spectral_unread unread;
  abbe_spectral_channels_find_unread(image, layer, &unread);
  for (int k = 0; k < ABBE_SPECTRAL_UNREAD_COUNT; k++)
    if (unread.count[k] > 0)
      fprintf(stderr, "note: %s: left out are %zu channels %s, such as %s\n", name, unread.count[k],
              what[k], unread.first[k]);
}

enum {
  OPTION_OCIO = 0xa00,
  OPTION_DISPLAY,
  OPTION_VIEW,
  OPTION_EXPOSURE,
  OPTION_GAMUT,
  OPTION_WHITE,
  OPTION_GLARE,
  OPTION_BITS
};

/* Share of a picture; a white table in the light is no fault. */
#define MOST_WHITE 0.2

static const abbe_option screen_options_options[] = {
    {"ocio", OPTION_OCIO, "FILE", ABBE_ARGUMENT_READS,
     "the configuration; without it, $OCIO, else the shipped one", 0, ABBE_TAKE_BY_KEY},
    {"display", OPTION_DISPLAY, "NAME", 0,
     "the screen, or its ICC profile (.icc or .icm); without it, the configuration's first", 0,
     ABBE_TAKE_BY_KEY},
    {"view", OPTION_VIEW, "NAME", 0, "how to show it; without it, the display's first", 0,
     ABBE_TAKE_BY_KEY},
    {"exposure", OPTION_EXPOSURE, "STOPS|auto", 0,
     "brighten (or darken) before the view; auto: so that a tenth of the picture is brighter than "
     "0.8; without it, as the scene's camera says, else 0",
     0, ABBE_TAKE_BY_KEY},
    {"gamut", OPTION_GAMUT, "HOW", 0,
     "bring colours that the screen lacks inside, before the view: clip, white (towards it at "
     "constant Oklab hue) or compress (as ACES 1.3); without it, as the view does",
     0, ABBE_TAKE_BY_KEY},
    {"white", OPTION_WHITE, "X,Y|KELVIN", 0,
     "what shall look white, by Bradford: a chromaticity or a temperature (daylight's from 4000 K "
     "on)",
     0, ABBE_TAKE_BY_KEY},
    {"glare", OPTION_GLARE, "DEGREES", 0,
     "what the eye scatters of bright light, of a picture that is seen so many degrees high, such "
     "as 20",
     0, ABBE_TAKE_BY_KEY},
    {"bits", OPTION_BITS, "N", 0,
     "of a PNG 8 or 16 (8, for PQ and HLG 16), of an AVIF 10 or 12 (10), of others 8", 0,
     ABBE_TAKE_BY_KEY},
    {0}};

static void take_gamut(abbe_screen_options *o, const char *text) {
  const char *names[ABBE_GAMUT_MAP_COUNT];
  for (int i = 0; i < ABBE_GAMUT_MAP_COUNT; i++)
    names[i] = abbe_gamut_map_name((abbe_gamut_map_kind)i);
  o->display.gamut = (abbe_gamut_map_kind)abbe_command_choice(o->program, "--gamut", text, names,
                                                              ABBE_GAMUT_MAP_COUNT);
}

static void take_white(abbe_screen_options *o, const char *text) {
  if (abbe_colour_temperature_read_white(text, o->display.white)) return;
  fprintf(stderr,
          "%s: --white '%s' is no chromaticity such as 0.4476,0.4074, nor a temperature of %g to "
          "%g K such as 2856\n",
          o->program, text, ABBE_COLOUR_TEMPERATURE_MIN, ABBE_COLOUR_TEMPERATURE_MAX_DAYLIGHT);
  exit(ABBE_EXIT_USAGE);
}

static error_t screen_options_parse(int key, char *text, struct argp_state *state) {
  static const char *const bits[] = {"8", "10", "12", "16"};
  static const int count[] = {8, 10, 12, 16};
  abbe_screen_options *o = state->input;
  switch (key) {
  case OPTION_OCIO:
    o->given = "--ocio";
    o->display.config = text;
    return 0;
  case OPTION_DISPLAY:
    o->given = "--display";
    o->display.display = text;
    return 0;
  case OPTION_VIEW:
    o->given = "--view";
    o->display.view = text;
    return 0;
  case OPTION_EXPOSURE:
    o->given = "--exposure";
    o->exposed = strcmp(text, "auto") == 0;
    o->stated = !o->exposed;
    o->display.exposure =
        o->exposed ? 0
                   : abbe_command_number(o->program, "--exposure", text, -ABBE_DISPLAY_MAX_EXPOSURE,
                                         ABBE_DISPLAY_MAX_EXPOSURE);
    return 0;
  case OPTION_GAMUT:
    o->given = "--gamut";
    take_gamut(o, text);
    return 0;
  case OPTION_WHITE:
    o->given = "--white";
    take_white(o, text);
    return 0;
  case OPTION_GLARE:
    o->given = "--glare";
    o->glare_deg =
        abbe_command_number(o->program, "--glare", text, ABBE_GLARE_MIN_DEG, ABBE_GLARE_MAX_DEG);
    return 0;
  case OPTION_BITS:
    o->given = "--bits";
    o->bits = count[abbe_command_choice(o->program, "--bits", text, bits, 4)];
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const abbe_parser abbe_screen_options_argp = {.options = screen_options_options,
                                              .parse = screen_options_parse};

void abbe_screen_options_end(const abbe_screen_options *o, const char *png,
                             struct argp_state *state) {
  if (o->given != NULL && png == NULL)
    argp_error(state, "%s is for the picture for a display: give --png FILE.png too", o->given);
  const abbe_screen_file_needs needs[] = {{.bits = o->bits}, {.alpha = o->alpha}};
  abbe_error error = {0};
  for (int i = 0; png != NULL && i < 2; i++)
    if (abbe_screen_file_check(png, &needs[i], &error) != ABBE_OK)
      argp_error(state, "%s %s", i == 0 ? "--bits:" : "--alpha:", error.text);
}

abbe_result abbe_screen_options_check(const abbe_screen_options *o, const char *png,
                                      abbe_rgb_space space, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  ABBE_HELD(abbe_display, display) = NULL;
  ABBE_OWNED(abbe_image, probe) = {0};
  abbe_display_desc desc = o->display;
  desc.source_space = abbe_rgb_space_ocio_name(space);
  ABBE_TRY(abbe_display_make(&desc, &display, error));
  ABBE_TRY(abbe_image_make(1, 1, 3, names, &probe, error));
  ABBE_TRY(abbe_display_apply(display, &probe, error));
  const abbe_screen_file_needs needs = {.bits = o->bits, .transfer = probe.transfer};
  return abbe_screen_file_check(png, &needs, error);
}

/* No exposure shows what is infinite, and none is proposed that would be refused. */
static void warn_white(const abbe_screen_png_notes *notes, double exposure) {
  const double less = fmin(notes->stops, exposure - 0.5);
  fprintf(stderr, "warning: %.0f %% of the picture is over-exposed: white without detail",
          100 * notes->white);
  if (notes->stops != 0 && less >= -ABBE_DISPLAY_MAX_EXPOSURE)
    fprintf(stderr, "; --exposure %.1f shows it", less);
  fputc('\n', stderr);
}

abbe_result abbe_screen_options_write(const abbe_screen_options *o, const char *path,
                                      const abbe_image *image, const char *layer, const char *name,
                                      abbe_error *error) {
  abbe_screen_png_notes notes = {0};
  const abbe_screen_png_desc desc = {.display = o->display,
                                     .exposed = o->exposed,
                                     .stated = o->stated,
                                     .glare_deg = o->glare_deg,
                                     .layer = layer,
                                     .name = name,
                                     .bits = o->bits,
                                     .alpha = o->alpha,
                                     .notes = &notes};
  const abbe_result result = abbe_screen_png_write(path, image, &desc, error);
  if (name == NULL) name = "the picture";
  if (notes.chosen && result == ABBE_OK)
    fprintf(stderr, "note: exposure auto takes %.2f stops for %s\n", notes.exposure, name);
  if (notes.space_assumed) abbe_command_note_space(name);
  if (notes.white > MOST_WHITE) warn_white(&notes, notes.exposure);
  abbe_command_note_odd(name, &notes.odd, "shown as the brightest light there is");
  return result;
}

static const abbe_option map_options_options[] = {
    {"save-map", 0, "FILE.exr", ABBE_ARGUMENT_WRITES,
     "where one light's flux lands, texel by texel", 3,
     ABBE_TAKE_TARGET(abbe_map_options, save, ".exr")},
    {"map-light", 0, "NAME|NUMBER", 0, "whose map that is (the first light's)", 3,
     ABBE_TAKE_TEXT(abbe_map_options, light)},
    {"map-like", 0, "FILE.exr", ABBE_ARGUMENT_READS,
     "texels that lie exactly as in that map, and as many", 3,
     ABBE_TAKE_TEXT(abbe_map_options, like)},
    {0}};

const abbe_parser abbe_map_options_argp = {.options = map_options_options, .parse = NULL};

/* The one light of that name: unlike what people type, what a file names is never a number. */
static abbe_result find_named(const abbe_map_options *o, const abbe_scene *scene, const char *name,
                              size_t *index, abbe_error *error) {
  size_t found = 0;
  for (size_t i = 0; i < scene->light_count; i++)
    if (strcmp(scene->light[i].name, name) == 0 && ++found == 1) *index = i;
  if (found == 1) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s is the map of the light '%.60s'; %s has %s of that name; say with "
                        "--map-light which one is meant",
                        o->like, name, scene->path, found == 0 ? "none" : "several");
}

static abbe_result read_like(abbe_map_options *o, const abbe_scene *scene, bool sized,
                             abbe_error *error) {
  abbe_image map = {0};
  abbe_result result = abbe_command_read_picture(o->like, &map, error);
  if (result == ABBE_OK) result = abbe_map_layout_read(&map, o->like, &o->layout, error);
  if (result == ABBE_OK && sized && map.width != map.height)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s has %zu x %zu texels; maps are square here, so give a side with "
                            "--map",
                            o->like, map.width, map.height);
  const char *name = abbe_image_attribute_text(&map, "abbe:map_light");
  if (result == ABBE_OK && o->light == NULL && name != NULL)
    result = find_named(o, scene, name, &o->light_index, error);
  o->side = map.width;
  abbe_image_free(&map);
  return result;
}

abbe_result abbe_map_options_resolve(abbe_map_options *o, const abbe_scene *scene, bool sized,
                                     abbe_error *error) {
  o->light_index = 0;
  if (o->light != NULL) ABBE_TRY(abbe_scene_find_light(scene, o->light, &o->light_index, error));
  if (o->like != NULL) ABBE_TRY(read_like(o, scene, sized, error));
  return ABBE_OK;
}
