#include "gl/accuracy/error_bars.h"

#include "base/clock.h"
#include "base/maths.h"
#include "colorimetry/difference.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/plot/false_colours.h"
#include "colorimetry/rgb_space.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a picture would still gain by ever finer settings, as a share of what it gained by halving
 * every step once: 1 where errors fall with the step, a third where they fall with its square. What
 * it was fitted to stands in docs/trade-measured.md. */
static const double rest = 0.4;

/* The mean distance of a normal number from its mean, in standard deviations: sqrt(2 / pi). */
static const double mean_distance = 0.7978845608;

/* Part of the distance between samples by which variants move them. A picture that moves as a whole
 * is no error, and all of it would make one of every steep caustic; but an edge that passes between
 * the samples of all variants has none. Chosen with the number above. Where more rays are taken at
 * an edge it passes between none, and half of that covers what is left. */
static double sample_part(const abbe_render_desc *desc) {
  return desc->adaptive > 1 ? 1.0 / 3 : 2.0 / 3;
}

enum { AXES = 6 };

abbe_result abbe_error_bars_check(abbe_profile profile, const abbe_error_bars_desc *desc,
                                  abbe_error *error) {
  if (abbe_method_of(profile)->own_passes)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the profile '%s' has no error bars: it keeps to its own "
                          "sampling; use the default profile",
                          abbe_profile_name(profile));
  size_t variants = desc != NULL ? desc->variants : 0;
  if (variants != 1 && variants <= ABBE_ERROR_BARS_MAX_VARIANTS) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "error bars of %zu variants: there may be 2 to %d", variants,
                        ABBE_ERROR_BARS_MAX_VARIANTS);
}

/* Variants */

static uint64_t mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/* The place that variant i has, of so many along an axis, evenly spread over -0.5 to 0.5. */
static double place(int axis, size_t i, size_t variants) {
  size_t of[ABBE_ERROR_BARS_MAX_VARIANTS];
  for (size_t k = 0; k < variants; k++) of[k] = k;
  for (size_t k = variants - 1; k > 0; k--) {
    size_t other = mix((uint64_t)axis << 32 | k) % (k + 1), kept = of[k];
    of[k] = of[other];
    of[other] = kept;
  }
  return ((double)of[i] + 0.5) / (double)variants - 0.5;
}

/* Moves the texels along an axis by a part of one. The first and the last of the layout's steps,
 * which are beside the light, take it up, and so no more than they are wide. */
static void move_texels(abbe_map_layout *layout, int axis, double texels, size_t side) {
  double *knot = layout->knot[axis];
  double most = 0.9 * fmin(knot[1], 1 - knot[ABBE_MAP_LAYOUT_STEPS - 1]);
  double by = fmin(fmax(texels / (double)side, -most), most);
  for (int k = 1; k < ABBE_MAP_LAYOUT_STEPS; k++) knot[k] += by;
}

void abbe_error_bars_variant(const abbe_render_desc *desc, const abbe_map_layout *map, size_t i,
                             size_t variants, abbe_map_layout *layout, abbe_render_desc *out) {
  *out = *desc;
  *layout = *map;
  out->map_layout = layout;
  for (int k = 0; k < 2; k++) {
    out->photon_shift[k] = place(k, i, variants);
    out->sample_shift[k] = sample_part(desc) * place(2 + k, i, variants);
    move_texels(layout, k, place(4 + k, i, variants), desc->map_size);
  }
}

static size_t half(size_t count) {
  return (count + 1) / 2;
}

/* Which receives the picture's own map layout: the light's outline does not depend on the grid. */
static void make_coarse(const abbe_render_desc *desc, const abbe_map_layout *map,
                        abbe_render_desc *out) {
  *out = *desc;
  out->map_layout = map;
  out->photons = half(desc->photons);
  out->map_size = half(desc->map_size);
  out->wavelengths = half(desc->wavelengths);
  if (desc->transport == ABBE_TRANSPORT_PINHOLE) out->pinholes = half(desc->pinholes);
}

/* Work */

typedef struct work {
  abbe_context *context;
  const abbe_scene *scene;
  const abbe_error_bars_desc *desc;
  abbe_renderer *renderer;  /* renderer of all variants, one after another; NULL before the first */
  abbe_render_desc request; /* resolved, without what only the picture needs */
  abbe_map_layout map;
  bool has_map;
  size_t done, frames;
  abbe_image picture;           /* with its AOVs, where there are any */
  abbe_image coarse;            /* empty where nothing is coarser */
  double *difference, *squares; /* sums over variants of (variant - picture) and its square */
} work;

static bool show_frame(void *user, double done) {
  const work *w = user;
  if (w->desc->progress == NULL) return true;
  return w->desc->progress(w->desc->user, ((double)w->done + done) / (double)w->frames);
}

/* Fitting maps to a variant is about a tenth of its work. */
static bool show_making(void *user, double done) {
  return show_frame(user, 0.1 * done);
}

static bool show_drawing(void *user, double done) {
  return show_frame(user, 0.1 + 0.9 * done);
}

static abbe_result draw(work *w, abbe_render_desc request, abbe_image *out, abbe_error *error) {
  if (!w->has_map) request.map_layout = NULL;
  request.progress = show_making;
  request.progress_user = w;
  abbe_result result = w->renderer == NULL
                           ? abbe_renderer_make(w->context, w->scene, &request, &w->renderer, error)
                           : abbe_renderer_change(w->renderer, w->scene, &request, error);
  if (result == ABBE_OK) result = abbe_renderer_frame(w->renderer, show_drawing, w, NULL, error);
  if (result == ABBE_OK) result = abbe_renderer_read(w->renderer, false, out, error);
  w->done++;
  if (result == ABBE_OK && !show_frame(w, 0)) {
    abbe_image_free(out);
    result = abbe_error_set(error, ABBE_CANCELLED, "the error bars were cancelled");
  }
  return result;
}

static float at(const abbe_image *image, size_t pixel, size_t channel) {
  return image->data[pixel * image->channels + channel];
}

static abbe_result draw_variants(work *w, size_t variants, abbe_error *error) {
  size_t pixels = w->picture.width * w->picture.height;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < variants && result == ABBE_OK; i++) {
    abbe_map_layout layout;
    abbe_render_desc request;
    abbe_image image = {0};
    abbe_error_bars_variant(&w->request, &w->map, i, variants, &layout, &request);
    ABBE_TRY(draw(w, request, &image, error));
    for (size_t p = 0; p < pixels; p++)
      for (size_t c = 0; c < 3; c++) {
        double d = (double)at(&image, p, c) - (double)at(&w->picture, p, c);
        w->difference[3 * p + c] += d;
        w->squares[3 * p + c] += d * d;
      }
    abbe_image_free(&image);
  }
  return result;
}

static abbe_result make_images(const work *w, abbe_error_bars *out, abbe_error *error) {
  const char *name[3];
  char text[3][32];
  for (int c = 0; c < 3; c++) {
    name[c] = w->picture.channel[c];
    snprintf(text[c], sizeof text[c], "stderr.%s", name[c]);
  }
  const char *const errors[3] = {text[0], text[1], text[2]};
  size_t width = w->picture.width, height = w->picture.height;
  ABBE_TRY(abbe_image_make(width, height, 3, errors, &out->error, error));
  ABBE_TRY(abbe_image_make(width, height, 3, name, &out->mean, error));
  memcpy(out->mean.xy, w->picture.xy, sizeof out->mean.xy);
  for (size_t i = 0; i < w->picture.attribute_count; i++)
    ABBE_TRY(abbe_image_set_attribute(&out->mean, w->picture.attribute[i].name,
                                      w->picture.attribute[i].text, error));
  return ABBE_OK;
}

static void estimate(const work *w, abbe_error_bars *out) {
  /* The picture is one of those that the mean is of: its own chance then counts once. */
  double n = (double)out->variants + 1;
  for (size_t i = 0; i < 3 * w->picture.width * w->picture.height; i++) {
    double picture = (double)at(&w->picture, i / 3, i % 3);
    double off = w->difference[i] / n, mean = picture + off;
    double variance = fmax(0, w->squares[i] - off * w->difference[i]) / (n - 1);
    double last = w->coarse.data != NULL ? mean - (double)at(&w->coarse, i / 3, i % 3) : 0;
    double error2 = variance / n + rest * rest * last * last;
    if (!w->desc->of_mean) error2 += off * off;
    out->mean.data[i] = (float)mean;
    out->error.data[i] = (float)(sqrt(error2));
  }
}

/* Summaries */

/* The brightness of the pixel at which `share` of the light is reached from the brightest on, or of
 * the lit pixels. */
static double threshold(double *light, size_t count, double share, bool of_pixels) {
  double total = 0, held = 0;
  size_t i = 0;
  qsort(light, count, sizeof *light, abbe_order_descending);
  while (i < count && light[i] > 0) total += of_pixels ? 1 : light[i], i++;
  for (size_t k = 0; k < i; k++) {
    held += of_pixels ? 1 : light[k];
    if (held >= share * total) return light[k];
  }
  return INFINITY;
}

typedef struct eye {
  double to_xyz[9], white[3];
} eye;

static void lab_of(const eye *e, const double value[3], double lab[3]) {
  double xyz[3];
  abbe_rgb_space_apply(e->to_xyz, value, xyz);
  abbe_difference_lab(xyz, e->white, lab);
}

/* How the picture would look if it were off as far as it is on average. */
static double colour_error(const work *w, const abbe_error_bars *bars, const eye *e, size_t p) {
  const abbe_image *own = w->desc->of_mean ? &bars->mean : &w->picture;
  const abbe_image *towards = !w->desc->of_mean ? &bars->mean : &w->coarse;
  double value[3], off[3], lab[2][3];
  for (size_t c = 0; c < 3; c++) {
    double way = towards->data != NULL ? (double)at(towards, p, c) - (double)at(own, p, c) : 1;
    value[c] = (double)at(own, p, c);
    off[c] = value[c] + copysign(mean_distance * (double)at(&bars->error, p, c), way);
  }
  lab_of(e, value, lab[0]);
  lab_of(e, off, lab[1]);
  return abbe_difference_ciede2000(lab[0], lab[1]);
}

/* Errors of every pixel; they are many, so cancel is polled now and then. */
static abbe_result find_colour_errors(work *w, const abbe_error_bars *bars, const eye *e,
                                      double *out, abbe_error *error) {
  enum { SOME = 8192 };
  const size_t pixels = w->picture.width * w->picture.height;
  for (size_t p = 0; p < pixels; p++) {
    if (p % SOME == 0 && !show_frame(w, 0))
      return abbe_error_set(error, ABBE_CANCELLED, "the error bars were cancelled");
    out[p] = colour_error(w, bars, e, p);
  }
  return ABBE_OK;
}

/* `light` and `least`: the region; light NULL is all of the picture. */
static void summarise(const work *w, const abbe_error_bars *bars, const double *colour,
                      const double *light, double least, abbe_error_bars_summary *out) {
  double squares = 0, sum = 0, colours = 0;
  *out = (abbe_error_bars_summary){0};
  for (size_t p = 0; p < w->picture.width * w->picture.height; p++) {
    if (light != NULL && !(light[p] >= least)) continue;
    out->pixels++;
    colours += colour[p];
    for (size_t c = 0; c < 3; c++) {
      squares += pow((double)at(&bars->error, p, c), 2);
      sum += (double)at(&w->picture, p, c);
    }
  }
  double n = (double)out->pixels;
  if (out->pixels == 0) return;
  out->relative_rmse = sum > 0 ? sqrt(squares / (3 * n)) / (sum / (3 * n)) : 0;
  out->ciede2000 = colours / n;
}

/* Y of three channels from `first`, of all pixels. */
static void light_of(const work *w, const eye *e, size_t first, double *out) {
  for (size_t p = 0; p < w->picture.width * w->picture.height; p++) {
    double value[3], xyz[3];
    for (size_t c = 0; c < 3; c++) value[c] = (double)at(&w->picture, p, first + c);
    abbe_rgb_space_apply(e->to_xyz, value, xyz);
    out[p] = xyz[1];
  }
}

static abbe_result summarise_all(work *w, abbe_error_bars *bars, abbe_error *error) {
  static const double d65[3] = {0.95047, 1, 1.08883};
  size_t pixels = w->picture.width * w->picture.height;
  ABBE_FREED double *light = malloc(3 * pixels * sizeof *light);
  if (light == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for error bars");
  double *sorted = light + pixels, *colour = sorted + pixels;
  eye e;
  abbe_rgb_space_to_xyz(w->request.space, e.to_xyz);
  light_of(w, &e, 0, sorted);
  double white = threshold(sorted, pixels, 0.01, true);
  for (int c = 0; c < 3; c++) e.white[c] = d65[c] * (isfinite(white) ? white : 1);
  ABBE_TRY(find_colour_errors(w, bars, &e, colour, error));
  summarise(w, bars, colour, NULL, 0, &bars->whole);
  size_t caustic = w->picture.channels == 10 ? 7 : 0;
  if (caustic > 0) {
    light_of(w, &e, caustic, light);
    memcpy(sorted, light, pixels * sizeof *light);
    summarise(w, bars, colour, light, threshold(sorted, pixels, 0.95, false), &bars->caustic);
  }
  return ABBE_OK;
}

/* All of it */

static abbe_result begin(work *w, abbe_renderer *renderer, size_t variants, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  w->request = plan->desc;
  w->request.aovs = w->desc->aovs && plan->desc.aovs;
  w->frames = variants + (plan->refractor_count > 0 ? 1 : 0);
  if (w->request.map_layout == NULL) w->request.map_layout_light = 0;
  /* No layout serves all faces of a cube: each is fitted anew. */
  const bool cube = plan->light_view[w->request.map_layout_light].face >= 0;
  w->has_map = plan->caustics && (w->request.map_layout != NULL || !cube);
  abbe_renderer_map_layout(renderer, w->request.map_layout_light, &w->map);
  ABBE_TRY(abbe_renderer_read(renderer, plan->desc.aovs, &w->picture, error));
  size_t values = 3 * w->picture.width * w->picture.height;
  w->difference = calloc(values, sizeof *w->difference);
  w->squares = calloc(values, sizeof *w->squares);
  if (w->difference != NULL && w->squares != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the error bars of %zu x %zu pixels",
                        w->picture.width, w->picture.height);
}

abbe_result abbe_error_bars_make(abbe_context *context, const abbe_scene *scene,
                                 abbe_renderer *renderer, const abbe_error_bars_desc *desc,
                                 abbe_error_bars *out, abbe_error *error) {
  static const abbe_error_bars_desc defaults = {0};
  *out = (abbe_error_bars){0};
  if (desc == NULL) desc = &defaults;
  double start_ms = 1e3 * abbe_clock_seconds();
  size_t variants = desc->variants > 0 ? desc->variants : ABBE_ERROR_BARS_VARIANTS;
  work w = {.context = context, .scene = scene, .desc = desc};
  abbe_result result =
      abbe_error_bars_check(abbe_renderer_plan(renderer)->desc.profile, desc, error);
  if (result == ABBE_OK && abbe_renderer_plan(renderer)->volume)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "caustics of a volume are the same with other photons, so they have no "
                            "error bars; 'abbe volume' tells how noisy they are");
  if (result == ABBE_OK) result = begin(&w, renderer, variants, error);
  if (result == ABBE_OK) abbe_renderer_rest(renderer); /* the variants have one of their own */
  if (result == ABBE_OK) result = draw_variants(&w, variants, error);
  if (result == ABBE_OK && w.frames > variants) {
    abbe_render_desc request;
    make_coarse(&w.request, &w.map, &request);
    result = draw(&w, request, &w.coarse, error);
  }
  if (result == ABBE_OK) result = make_images(&w, out, error);
  if (result == ABBE_OK) {
    out->variants = variants;
    out->frames = w.frames;
    estimate(&w, out);
    result = summarise_all(&w, out, error);
    out->ms = 1e3 * abbe_clock_seconds() - start_ms;
  }
  abbe_renderer_free(w.renderer);
  free(w.difference);
  free(w.squares);
  abbe_image_free(&w.picture);
  abbe_image_free(&w.coarse);
  if (result != ABBE_OK) abbe_error_bars_free(out);
  return result;
}

void abbe_error_bars_free(abbe_error_bars *bars) {
  if (bars == NULL) return;
  abbe_image_free(&bars->error);
  abbe_image_free(&bars->mean);
  *bars = (abbe_error_bars){0};
}

abbe_result abbe_error_bars_attach(const abbe_error_bars *bars, abbe_image *picture,
                                   abbe_error *error) {
  assert(bars->error.data && picture->data);
  return abbe_image_append(picture, &bars->error, error);
}

static void errors_of_y(const abbe_error_bars *bars, const double to_xyz[9], float *out) {
  for (size_t p = 0; p < bars->error.width * bars->error.height; p++) {
    double sum = 0;
    for (size_t c = 0; c < 3; c++) sum += fabs(to_xyz[3 + c]) * (double)bars->error.data[3 * p + c];
    out[p] = (float)sum;
  }
}

abbe_result abbe_error_picture_write(const char *path, const abbe_error_bars *bars,
                                     abbe_error *error) {
  assert(bars->error.data);
  const abbe_false_colours_desc desc = {.width = bars->error.width,
                                        .height = bars->error.height,
                                        .is_error = true,
                                        .title = "One standard error, estimated",
                                        .label = "error of Y: radiance, W/(m2 sr)"};
  abbe_picture_space space;
  ABBE_TRY(abbe_picture_space_find(&bars->mean, false, "the mean", &space, error));
  ABBE_FREED float *value = malloc(desc.width * desc.height * sizeof *value);
  if (value == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu errors",
                          desc.width * desc.height);
  errors_of_y(bars, space.to_xyz, value);
  return abbe_false_colours_draw(path, &desc, value, error);
}
