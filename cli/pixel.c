#include "cli/base/arguments.h"

#include "cli/base/command.h"
#include "cli/options/picture_options.h"
#include "colorimetry/chromaticity.h"
#include "colorimetry/colour_temperature.h"
#include "colorimetry/gamut.h"
#include "colorimetry/image/image.h"
#include "colorimetry/plot/chart.h"
#include "colorimetry/spectral_picture/pixel_probe.h"
#include "colorimetry/weights.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* All that a colorimeter says of a colour. */

enum { GAMUTS = 3 };

static const struct {
  abbe_gamut gamut;
  const char *key, *text;
} gamuts[GAMUTS] = {{ABBE_GAMUT_REC709, "rec709", "Rec.709"},
                    {ABBE_GAMUT_P3, "p3", "P3"},
                    {ABBE_GAMUT_REC2020, "rec2020", "Rec.2020"}};

/* What there is none of is NaN. */
typedef struct abbe_colour_description {
  double xyz[3];
  double xy[2], uv[2];    /* x, y and u', v' (chromaticity.h) */
  abbe_dominant dominant; /* with respect to the white */
  double kelvin, duv;     /* correlated colour temperature (colour_temperature.h) */
  double rgb[GAMUTS][3];  /* linear, of each gamut, over the greatest of the three */
} abbe_colour_description;

/* Describes XYZ as that observer sees it, with respect to a white of chromaticity white_xy.
 * Correlated colour temperatures and gamuts are defined for the observer of 1931 alone. */
static void colour_description_make(const double xyz[3], const double white_xy[2],
                                    abbe_observer observer, abbe_colour_description *out) {
  *out = (abbe_colour_description){.xyz = {xyz[0], xyz[1], xyz[2]},
                                   .xy = {NAN, NAN},
                                   .uv = {NAN, NAN},
                                   .dominant = {NAN, NAN, NAN},
                                   .kelvin = NAN,
                                   .duv = NAN};
  for (int k = 0; k < 3 * GAMUTS; k++) out->rgb[k / 3][k % 3] = NAN;
  if (!abbe_chromaticity_xy(xyz, out->xy)) return;
  abbe_chromaticity_uv_of_xy(out->xy, out->uv);
  abbe_chromaticity_dominant(out->xy, white_xy, observer, &out->dominant);
  if (observer == ABBE_OBSERVER_CIE_1931)
    abbe_colour_temperature_find(out->xy, &out->kelvin, &out->duv);
  for (int g = 0; g < GAMUTS && observer == ABBE_OBSERVER_CIE_1931; g++) {
    double matrix[9], *rgb = out->rgb[g];
    abbe_gamut_from_xyz(gamuts[g].gamut, matrix);
    abbe_rgb_space_apply(matrix, xyz, rgb);
    const double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
    for (int k = 0; k < 3; k++) rgb[k] /= most;
  }
}

/* (1, 0, 0) of a gamut, in single precision, is on its edge and not outside; and so on the locus
 * are Rec.2020's primaries, whose printed digits have purities of up to 1.0008. */
static const double edge = 1e-5, locus = 0.002;

typedef struct request {
  const char *program, *path, *layer, *plot;
  abbe_spectral_options spectral;
  abbe_image_window window;
  bool placed, json;
} request;

/* The colours that a probe holds: of the channels R, G, B, and of the spectrum. */
typedef struct colours {
  bool has[2];
  abbe_colour_description of[2];
} colours;

static const char *const sources[2] = {"picture", "spectrum"};

static void describe(const request *r, const abbe_pixel_probe *p, colours *out) {
  static const abbe_illuminant table = {.kind = ABBE_ILLUMINANT_D65};
  double d65[2] = {0.3127, 0.3290}, white[3];
  *out = (colours){.has = {p->has_colour, p->has_spectral_xyz}};
  if (p->space.observer != ABBE_OBSERVER_CIE_1931) {
    abbe_weights_white(p->space.observer, &table, ABBE_OBSERVER_MIN_NM, ABBE_OBSERVER_MAX_NM,
                       white);
    abbe_chromaticity_xy(white, d65);
  }
  colour_description_make(p->xyz, d65, p->space.observer, &out->of[0]);
  colour_description_make(p->spectral_xyz, p->white_xy, r->spectral.view.observer, &out->of[1]);
}

static const char *unit_of(const abbe_pixel_probe *p) {
  return p->spectrum.kind == ABBE_SPECTRAL_REFLECTIVE ? "of a perfect white"
         : p->is_relative                             ? "in the picture's unit"
                                                      : "in lm (of a radiance: cd/m2)";
}

static void print_number(const char *before, double value, const char *format, const char *none) {
  printf("%s", before);
  if (isnan(value))
    printf("%s", none);
  else
    printf(format, value);
}

/* The gamuts that the colour is outside of, with what they would need less than nothing of. */
static void print_gamuts(const abbe_colour_description *c) {
  static const char *const primary[3] = {"red", "green", "blue"};
  int outside = 0;
  if (isnan(c->rgb[0][0])) return;
  printf("  outside of              ");
  for (int g = 0; g < GAMUTS; g++) {
    const double *rgb = c->rgb[g];
    if (fmin(rgb[0], fmin(rgb[1], rgb[2])) >= -edge) continue;
    printf("%s%s (", outside++ > 0 ? ", " : "", gamuts[g].text);
    for (int k = 0, before = 0; k < 3; k++)
      if (rgb[k] < -edge) printf("%s%s %.4f", before++ > 0 ? ", " : "", primary[k], rgb[k]);
    printf(")");
  }
  if (c->dominant.purity > 1 + locus) printf("%sthe spectral locus", outside++ > 0 ? ", " : "");
  printf("%s\n", outside > 0 ? "" : "none of Rec.709, P3, Rec.2020");
}

static void print_colour(const abbe_colour_description *c) {
  printf("  XYZ                     %.6g %.6g %.6g\n", c->xyz[0], c->xyz[1], c->xyz[2]);
  if (isnan(c->xy[0])) {
    printf("  it is dark, or no colour that an eye could see\n");
    return;
  }
  printf("  x, y                    %.5f %.5f\n", c->xy[0], c->xy[1]);
  printf("  u', v'                  %.5f %.5f\n", c->uv[0], c->uv[1]);
  print_number("  dominant wavelength     ", c->dominant.lambda_nm, "%.1f nm\n",
               "none: a purple, or the white\n");
  print_number("  complementary           ", c->dominant.complementary_nm, "%.1f nm\n", "none\n");
  print_number("  excitation purity       ", c->dominant.purity, "%.4f\n", "none\n");
  print_number("  colour temperature      ", c->kelvin, "%.0f K", "none");
  print_number(", Duv ", c->duv, "%.5f\n", "none\n");
  print_gamuts(c);
}

static void print_text(const request *r, const abbe_image *image, const abbe_pixel_probe *p,
                       const colours *c) {
  const abbe_image_window w = p->window;
  printf("%s, ", r->path);
  if (p->pixels == 1)
    printf("pixel (%d, %d)\n", (int)w.x0, (int)w.y0);
  else
    printf("mean of %zu pixels, (%d, %d) to (%d, %d)\n", p->pixels, (int)w.x0, (int)w.y0, (int)w.x1,
           (int)w.y1);
  if (c->has[0])
    printf("\ncolour of the channels, %s%s%s%s\n", p->space.text,
           p->space.assumed ? " (assumed: the file does not say)" : "",
           p->space.observer != ABBE_OBSERVER_CIE_1931 ? ", " : "",
           p->space.observer != ABBE_OBSERVER_CIE_1931 ? abbe_observer_text(p->space.observer)
                                                       : "");
  if (c->has[0]) print_colour(&c->of[0]);
  if (c->has[1])
    printf("\ncolour of the spectrum, %s, %s\n", abbe_observer_text(r->spectral.view.observer),
           unit_of(p));
  if (c->has[1]) print_colour(&c->of[1]);
  printf("\n%-24s %14s %14s\n", "channel", "value", "std. error");
  for (size_t i = 0; i < p->channels; i++) {
    if (strncmp(image->channel[i], "stderr.", 7) == 0) continue;
    printf("%-24s %14.6g", image->channel[i], p->mean[i]);
    print_number(" ", p->error[i], "%14.6g\n", "             -\n");
  }
}

static bool add_pair(cJSON *o, const char *name, const double *value, int count) {
  return cJSON_AddItemToObject(o, name, cJSON_CreateDoubleArray(value, count));
}

/* cJSON writes NaN as null. */
static bool add_colour(cJSON *root, const char *name, const abbe_colour_description *c) {
  cJSON *o = cJSON_AddObjectToObject(root, name), *rgb = cJSON_AddObjectToObject(o, "linear_rgb");
  for (int g = 0; g < GAMUTS; g++)
    if (rgb == NULL || !add_pair(rgb, gamuts[g].key, c->rgb[g], 3)) return false;
  return o != NULL && add_pair(o, "xyz", c->xyz, 3) && add_pair(o, "xy", c->xy, 2) &&
         add_pair(o, "uv", c->uv, 2) &&
         cJSON_AddNumberToObject(o, "dominant_nm", c->dominant.lambda_nm) != NULL &&
         cJSON_AddNumberToObject(o, "complementary_nm", c->dominant.complementary_nm) != NULL &&
         cJSON_AddNumberToObject(o, "purity", c->dominant.purity) != NULL &&
         cJSON_AddNumberToObject(o, "cct_k", c->kelvin) != NULL &&
         cJSON_AddNumberToObject(o, "duv", c->duv) != NULL;
}

static bool add_spectrum(cJSON *root, const abbe_pixel_probe *p) {
  cJSON *list = cJSON_AddArrayToObject(root, "bands");
  bool made = list != NULL;
  for (size_t i = 0; made && i < p->spectrum.count; i++) {
    cJSON *o = cJSON_CreateObject();
    const size_t channel = p->spectrum.channel[i];
    made = cJSON_AddItemToArray(list, o) &&
           cJSON_AddNumberToObject(o, "lambda_nm", p->spectrum.lambda_nm[i]) != NULL &&
           add_pair(o, "band_nm", p->spectrum.edge_nm + i, 2) &&
           cJSON_AddNumberToObject(o, "value", p->mean[channel]) != NULL &&
           cJSON_AddNumberToObject(o, "standard_error", p->error[channel]) != NULL;
  }
  return made;
}

static abbe_result print_json(const request *r, const abbe_image *image, const abbe_pixel_probe *p,
                              const colours *c, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  const int window[4] = {p->window.x0, p->window.y0, p->window.x1, p->window.y1};
  bool made = cJSON_AddStringToObject(root, "file", r->path) != NULL &&
              cJSON_AddItemToObject(root, "window", cJSON_CreateIntArray(window, 4)) &&
              cJSON_AddNumberToObject(root, "pixels", (double)p->pixels) != NULL &&
              cJSON_AddStringToObject(root, "observer",
                                      abbe_observer_name(r->spectral.view.observer)) != NULL;
  for (int i = 0; i < 2 && made; i++)
    if (c->has[i]) made = add_colour(root, sources[i], &c->of[i]);
  if (made && c->has[1])
    made = cJSON_AddStringToObject(root, "spectrum_unit", unit_of(p)) != NULL &&
           add_pair(root, "spectrum_xyz_error_at_most", p->spectral_error, 3);
  if (made && p->spectrum.count > 0) made = add_spectrum(root, p);
  cJSON *channels = cJSON_AddObjectToObject(root, "channels");
  for (size_t i = 0; made && i < p->channels; i++)
    made = cJSON_AddNumberToObject(channels, image->channel[i], p->mean[i]) != NULL;
  return abbe_command_print_json(root, made, error);
}

static abbe_result plot(const request *r, const abbe_pixel_probe *p, abbe_error *error) {
  const abbe_spectral_channels *s = &p->spectrum;
  if (s->count == 0)
    return abbe_error_set(
        error, ABBE_NOT_FOUND,
        "%s: it has no bands to plot; abbe render --bands N and abbe trace --bands "
        "N make pictures that have",
        r->path);
  double *value = calloc(3 * s->count, sizeof *value), *low = value, *high = value;
  if (value == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the plot");
  low += s->count;
  high += 2 * s->count;
  bool errors = false;
  for (size_t i = 0; i < s->count; i++) {
    const double error_there = p->error[s->channel[i]];
    value[i] = p->mean[s->channel[i]];
    errors = errors || isfinite(error_there);
    low[i] = value[i] - (isfinite(error_there) ? error_there : 0);
    high[i] = value[i] + (isfinite(error_there) ? error_there : 0);
  }
  const abbe_chart_series series = {.style = ABBE_CHART_JOINED_POINTS,
                                    .count = s->count,
                                    .x = s->lambda_nm,
                                    .y = value,
                                    .low = errors ? low : NULL,
                                    .high = errors ? high : NULL};
  char title[400];
  snprintf(title, sizeof title, "%.300s, (%d, %d)", r->path, (int)p->window.x0, (int)p->window.y0);
  const bool reflective = s->kind == ABBE_SPECTRAL_REFLECTIVE;
  const abbe_chart chart = {.title = title,
                            .x.label = "wavelength, nm",
                            .y.label = reflective ? "reflectance" : "spectral value, a nm",
                            .series_count = 1,
                            .series = &series};
  abbe_result result = abbe_chart_write(r->plot, &chart, 1, 0, 0, error);
  free(value);
  return result;
}

static abbe_result probe(const request *r, const abbe_image *image, const abbe_spectral_view *view,
                         abbe_error *error) {
  abbe_pixel_probe p = {0};
  colours c;
  abbe_result result = abbe_pixel_probe_make(image, r->layer, r->path, r->window, view, &p, error);
  if (result != ABBE_OK) return result;
  if (p.has_colour && p.space.assumed) abbe_command_note_space(r->path);
  describe(r, &p, &c);
  if (r->plot != NULL) result = plot(r, &p, error);
  if (result == ABBE_OK && r->json)
    result = print_json(r, image, &p, &c, error);
  else if (result == ABBE_OK)
    print_text(r, image, &p, &c);
  abbe_pixel_probe_free(&p);
  return result;
}

static abbe_result run(request *r, abbe_error *error) {
  abbe_image image = {0};
  abbe_result result = abbe_spectral_options_load(&r->spectral, error);
  if (result == ABBE_OK) result = abbe_command_read_picture(r->path, &image, error);
  if (result == ABBE_OK) abbe_spectral_options_note_unread(&image, r->layer, r->path);
  if (result == ABBE_OK) result = probe(r, &image, &r->spectral.view, error);
  abbe_image_free(&image);
  abbe_spectral_options_free(&r->spectral);
  return result;
}

/* The command line */

static const abbe_option options[] = {
    {"layer", 0, "NAME", 0, "the channels NAME.R …, NAME.S0.550nm …", 0,
     ABBE_TAKE_TEXT(request, layer)},
    {"plot", 0, "FILE", ABBE_ARGUMENT_WRITES, "the spectrum as a .png or .svg", 0,
     ABBE_TAKE_TEXT(request, plot)},
    {"json", 0, NULL, 0, "as JSON, numbers in full", 0, ABBE_TAKE_FLAG(request, json)},
    ABBE_OPTIONS(request, &abbe_spectral_options_argp, spectral,
                 "How the spectrum is looked at:", 1),
    {0}};

/* "12,34" or "12,34:56,78". */
static void set_place(request *r, const char *text, struct argp_state *state) {
  abbe_image_window w = {0};
  char rest;
  int n = sscanf(text, "%d,%d:%d,%d%c", &w.x0, &w.y0, &w.x1, &w.y1, &rest);
  const bool one = n == 2 && strchr(text, ':') == NULL && sscanf(text, "%*d,%*d%c", &rest) < 1;
  if (one) {
    w.x1 = w.x0;
    w.y1 = w.y0;
  }
  if (!one && n != 4)
    argp_error(state, "'%s' is no pixel such as 120,80, nor a region such as 120,80:130,90", text);
  if (w.x0 > w.x1 || w.y0 > w.y1)
    argp_error(state,
               "the region '%s' ends before it begins; its corners are the upper left and the "
               "lower right one",
               text);
  r->window = w;
  r->placed = true;
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case ARGP_KEY_ARG:
    if (r->placed) argp_error(state, "'%s' is one argument too many", arg);
    if (r->path == NULL)
      r->path = arg;
    else
      set_place(r, arg, state);
    return 0;
  case ARGP_KEY_END:
    if (r->path == NULL) argp_error(state, "which file?");
    if (!r->placed) argp_error(state, "which pixel? Give X,Y or a region X0,Y0:X1,Y1");
    abbe_arguments_add(r->program, ABBE_ARGUMENT_READS, "the picture", r->path);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "FILE.exr X,Y[:X1,Y1]",
    .doc =
        "Says what a picture has at a pixel, or in the mean of a region: its channels with their "
        "standard errors, and its colour: XYZ, x, y, u', v', dominant wavelength, purity, "
        "correlated colour temperature, and which gamuts it is outside of. Where it has bands, "
        "also the colour of its spectrum, for "
        "any observer.\v"
        "Pixels are counted as the file counts them (abbe info says its windows), y downwards.\n\n"
        "Examples:\n"
        "  abbe pixel gem.exr 250,310\n"
        "  abbe pixel bands.exr 250,310:259,319 --observer 1964 --plot spectrum.png\n"
        "  abbe pixel bands.exr 250,310 --lit-by D65 --illuminant A --json\n",
};

int abbe_command_pixel(int argc, char **argv) {
  request r = {.program = argv[0], .spectral.program = argv[0]};
  abbe_arguments_parse(&parser, 0, argc, argv, &r);
  abbe_error error = {0};
  return abbe_command_end(r.program, run(&r, &error), &error);
}
