/* What a tracer has so far: the picture, the receiver map, and how far off they are. */
#include "validation/measure/compare.h"
#include "validation/trace/tracer/tracer_state.h"

#include <stdio.h>
#include <stdlib.h>

static double picture_error(const abbe_tracer *t) {
  double matrix[9], squares = 0, sum = 0;
  size_t pixels = t->desc.width * t->desc.height;
  abbe_rgb_space_to_xyz(t->desc.space, matrix);
  for (size_t i = 0; i < pixels; i++)
    for (size_t k = 0; k < 3; k++) {
      double weight = matrix[3 + k],
             at = abbe_accumulator_error(&t->picture, i * t->picture_channels + k);
      squares += pow(weight * at, 2);
      sum += weight * abbe_accumulator_mean(&t->picture, i * t->picture_channels + k);
    }
  return sum > 0 ? sqrt(squares / (double)pixels) / (sum / (double)pixels) : 0;
}

static double map_error(const abbe_tracer *t) {
  size_t texels = t->desc.map_width * t->desc.map_height;
  double *y = malloc(texels * sizeof *y), squares = 0, sum = 0;
  abbe_mask mask = {0};
  for (size_t i = 0; y != NULL && i < texels; i++)
    y[i] = abbe_accumulator_mean(&t->map, i * t->map_channels + 1);
  if (y != NULL &&
      abbe_mask_make_brightest(y, texels, ABBE_MASK_CAUSTIC_SHARE, &mask, NULL) == ABBE_OK)
    for (size_t i = 0; i < texels; i++) {
      if (!mask.in[i]) continue;
      squares += pow(abbe_accumulator_error(&t->map, i * t->map_channels + 1), 2);
      sum += y[i];
    }
  double inside = (double)mask.inside;
  abbe_mask_free(&mask);
  free(y);
  return sum > 0 ? sqrt(squares / inside) / (sum / inside) : 0;
}

double abbe_tracer_error(const abbe_tracer *t) {
  if (abbe_tracer_passes(t) < 2) return INFINITY;
  double picture = t->desc.no_picture ? 0 : picture_error(t);
  return t->desc.no_map ? picture : fmax(picture, map_error(t));
}

enum {
  NAME = 64,
  GUIDES = 2 * ABBE_GUIDE_MEANS + 6,
  MAX_CHANNELS = 9 + GUIDES + 2 * ABBE_BANDS_MAX
};

typedef struct channel_list {
  size_t count;
  char name[MAX_CHANNELS][NAME];
  size_t value[MAX_CHANNELS]; /* values of the sums' channels */
  bool error[MAX_CHANNELS];
} channel_list;

/* With one pass the error is not known: then there is no channel for it. */
static void add_channel(const abbe_tracer *t, channel_list *list, const char *prefix,
                        const char *name, size_t value, bool error) {
  if (error && abbe_tracer_passes(t) < 2) return;
  snprintf(list->name[list->count], NAME, "%s%s", prefix, name);
  list->value[list->count] = value;
  list->error[list->count++] = error;
}

static abbe_result attributes(const abbe_tracer *t, const char *kind, abbe_image *out,
                              abbe_error *error) {
  char passes[32], seed[32], photons[32];
  snprintf(passes, sizeof passes, "%zu", abbe_tracer_passes(t));
  snprintf(seed, sizeof seed, "%u", (unsigned)t->desc.seed);
  snprintf(photons, sizeof photons, "%zu", t->desc.photons);
  const char *pair[][2] = {{"abbe:kind", kind},
                           {"abbe:physics", abbe_tracer_physics(t)},
                           {"abbe:passes", passes},
                           {"abbe:photons", photons},
                           {"abbe:seed", seed},
                           {"abbe:scene", t->scene->path ? t->scene->path : "-"},
                           {"abbe:observer", abbe_observer_text(t->desc.observer)}};
  for (size_t i = 0; i < sizeof pair / sizeof *pair; i++)
    ABBE_TRY(abbe_image_set_attribute(out, pair[i][0], pair[i][1], error));
  ABBE_TRY(abbe_scene_mark_exposure(t->scene, out, error));
  if (t->bands.count > 0) {
    ABBE_TRY(abbe_image_set_attribute(out, "spectralLayoutVersion", "1.0", error));
    ABBE_TRY(abbe_image_set_attribute(out, "emissiveUnits",
                                      kind[0] == 'p' ? "W.m^-2.sr^-1.nm^-1" : "W.nm^-1", error));
  }
  return ABBE_OK;
}

static abbe_result read_sums(const abbe_tracer *t, const abbe_accumulator *sums, size_t width,
                             size_t height, size_t channels, const channel_list *list,
                             size_t summed, const char *kind, abbe_image *out, abbe_error *error) {
  const char *names[MAX_CHANNELS];
  for (size_t i = 0; i < list->count; i++) names[i] = list->name[i];
  abbe_result result = abbe_image_make(width, height, list->count, names, out, error);
  if (result != ABBE_OK) return result;
#pragma omp parallel for num_threads((int)t->desc.threads)
  for (size_t row = 0; row < height; row++)
    for (size_t i = row * width; i < (row + 1) * width && abbe_tracer_is_wanted(t); i++)
      for (size_t k = 0; k < summed; k++) {
        size_t value = i * channels + list->value[k];
        out->data[i * list->count + k] =
            (float)(list->error[k] ? abbe_accumulator_error(sums, value)
                                   : abbe_accumulator_mean(sums, value));
      }
  result = abbe_tracer_check_wanted(t, error);
  if (result == ABBE_OK) result = attributes(t, kind, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

static void add_bands(const abbe_tracer *t, size_t first, channel_list *list) {
  char name[NAME / 2];
  for (size_t i = 0; i < t->bands.count; i++) {
    abbe_bands_name(&t->bands, i, name, sizeof name);
    add_channel(t, list, "", name, first + i, false);
    add_channel(t, list, "stderr.", name, first + i, true);
  }
}

/* ---- the guides, behind all other channels ---- */

/* Their names are put in the list alone; read_guides has the values, in the same order. */
static void add_guides(const abbe_tracer *t, const char *const rgb[3], channel_list *list) {
  static const char *const part[2] = {"photons.", "eye."}, *const axis[3] = {"X", "Y", "Z"};
  const char *const names[ABBE_GUIDE_MEANS - 6] = {rgb[0],  rgb[1],  rgb[2], axis[0],
                                                   axis[1], axis[2], "Z"};
  if (!t->desc.guides || abbe_tracer_passes(t) < 2) return;
  for (size_t k = 0; k < ABBE_GUIDE_MEANS; k++) {
    const char *of = k < 6 ? part[k / 3] : k < 9 ? "albedo." : k < 12 ? "normal." : "depth.";
    const char *name = k < 6 ? rgb[k % 3] : names[k - 6];
    snprintf(list->name[list->count++], NAME, "%s%s", of, name);
    snprintf(list->name[list->count++], NAME, "stderr.%s%s", of, name);
  }
  for (size_t k = 0; k < 6; k++)
    snprintf(list->name[list->count++], NAME, "covariance.%s%s%s", part[k / 3],
             rgb[k % 3 == 2 ? 1 : 0], rgb[k % 3 == 0 ? 1 : 2]);
}

static void read_guides(const abbe_tracer *t, abbe_image *out) {
  if (!t->desc.guides || abbe_tracer_passes(t) < 2) return;
  const abbe_guide_sums *g = &t->guides;
  const size_t passes = abbe_tracer_passes(t);
  for (size_t i = 0; i < g->pixels; i++) {
    float *to = out->data + (i + 1) * out->channels - GUIDES;
    for (size_t k = 0; k < ABBE_GUIDE_MEANS; k++) {
      const double unit = k == ABBE_GUIDE_DEPTH ? t->geometry.unit : 1;
      *to++ = (float)(unit * abbe_guide_sums_mean(g, passes, i, k));
      *to++ = (float)(unit * sqrt(abbe_guide_sums_variance(g, passes, i, k)));
    }
    for (size_t k = 0; k < 6; k++) *to++ = (float)abbe_guide_sums_covariance(g, passes, i, k);
  }
}

abbe_result abbe_tracer_picture(const abbe_tracer *t, abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  if (t->desc.no_picture)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no picture was traced");
  static const char *const rgb[3] = {"R", "G", "B"}, *const xyz[3] = {"X", "Y", "Z"};
  const char *const *name = t->desc.space == ABBE_RGB_SPACE_XYZ ? xyz : rgb;
  ABBE_FREED channel_list *list = calloc(1, sizeof *list);
  if (list == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for channels");
  for (size_t k = 0; k < 3; k++) {
    add_channel(t, list, "", name[k], ABBE_TRACER_RGB + k, false);
    add_channel(t, list, "stderr.", name[k], ABBE_TRACER_RGB + k, true);
    add_channel(t, list, "caustic.", name[k], ABBE_TRACER_CAUSTIC + k, false);
  }
  add_bands(t, ABBE_TRACER_BANDS, list);
  const size_t summed = list->count;
  add_guides(t, name, list);
  ABBE_TRY(read_sums(t, &t->picture, t->desc.width, t->desc.height, t->picture_channels, list,
                     summed, "picture", out, error));
  read_guides(t, out);
  abbe_rgb_space_chromaticities(t->desc.space, out->xy);
  return ABBE_OK;
}

abbe_result abbe_tracer_map(const abbe_tracer *t, abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  if (t->desc.no_map) return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no map was traced");
  static const char *const xyz[3] = {"X", "Y", "Z"};
  channel_list *list = calloc(1, sizeof *list);
  if (list == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for channels");
  for (size_t k = 0; k < 3; k++) {
    add_channel(t, list, "", xyz[k], k, false);
    add_channel(t, list, "stderr.", xyz[k], k, true);
  }
  add_bands(t, 3, list);
  abbe_result result = read_sums(t, &t->map, t->desc.map_width, t->desc.map_height, t->map_channels,
                                 list, list->count, "receiver map", out, error);
  free(list);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&t->layout, t->scene->light[t->desc.map_light].name, out, error);
  if (result == ABBE_OK) abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_XYZ, out->xy);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
