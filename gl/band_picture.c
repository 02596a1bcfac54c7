#include "gl/band_picture.h"

#include "colorimetry/observer.h"
#include "colorimetry/upsampling.h"
#include "colorimetry/weights.h"
#include "gl/plan/examine/examine.h"
#include "spectral/spectrum.h"

#include <math.h>
#include <stdlib.h>

enum { NAME_SIZE = 32 };

#define STEP_NM 0.5 /* step of a band's light, linear between */

/* ---- the scene of a band ---- */

/* X + Y + Z of a watt in the band; 0 where it is dark or unseen. */
static double brightness(const abbe_illuminant *light, const double band_nm[2]) {
  double xyz[3];
  abbe_weights_band_xyz(light, band_nm[0], band_nm[1], band_nm[0], band_nm[1], xyz);
  return xyz[0] + xyz[1] + xyz[2];
}

/* Watts a nm in the band of a watt over the range. */
static double density(const abbe_illuminant *light, const double range_nm[2],
                      const double band_nm[2]) {
  return abbe_weights_band_power(light, range_nm[0], range_nm[1], band_nm[0], band_nm[1]) /
         (band_nm[1] - band_nm[0]);
}

/* All lines stay, as the band has an end; each has its own height. */
static abbe_result flatten_lines(const abbe_illuminant *light, abbe_illuminant *out,
                                 abbe_error *error) {
  const abbe_spectrum *s = light->spectrum;
  const size_t count = abbe_spectrum_count(s);
  const double *nm = abbe_spectrum_lambda_nm(s);
  double power[3 * ABBE_ILLUMINANT_MOST_LINES];
  for (size_t i = 0; i < count; i++) {
    double xyz[3];
    abbe_observer_xyz(nm[i], xyz);
    power[i] = abbe_spectrum_value(s)[i] / (xyz[0] + xyz[1] + xyz[2]);
  }
  *out = *light;
  return abbe_spectrum_make(nm, power, count, ABBE_INTERPOLATION_LINEAR, &out->spectrum, error);
}

/* The light within the band, over what the eye makes of it: what is then seen of each wavelength,
 * as X + Y + Z, is its power. */
static abbe_result flatten(const abbe_illuminant *light, const double band_nm[2],
                           abbe_illuminant *out, abbe_error *error) {
  double line[ABBE_ILLUMINANT_MOST_LINES];
  if (abbe_illuminant_lines(light, line) > 0) return flatten_lines(light, out, error);
  const double width = band_nm[1] - band_nm[0];
  const size_t steps = width > 1 ? (size_t)ceil(width / STEP_NM) : 2;
  double *nm = calloc(2 * (steps + 1), sizeof *nm), *power = nm + steps + 1;
  if (nm == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a light in a band");
  for (size_t i = 0; i <= steps; i++) {
    double xyz[3];
    nm[i] = i < steps ? band_nm[0] + width * (double)i / (double)steps : band_nm[1];
    abbe_observer_xyz(nm[i], xyz);
    const double seen = xyz[0] + xyz[1] + xyz[2];
    power[i] = seen > 0 ? abbe_illuminant_power(light, nm[i]) / seen : 0;
  }
  *out = (abbe_illuminant){.kind = ABBE_ILLUMINANT_TABULATED};
  const abbe_result result =
      abbe_spectrum_make(nm, power, steps + 1, ABBE_INTERPOLATION_LINEAR, &out->spectrum, error);
  free(nm);
  return result;
}

/* A watt of the band is as bright as `first`, whatever the illuminant: one that is dark there keeps
 * its place, without power. */
static abbe_result dim(abbe_light *light, const double range_nm[2], const double band_nm[2],
                       double first, abbe_error *error) {
  static const abbe_illuminant even = {.kind = ABBE_ILLUMINANT_E};
  const abbe_illuminant whole = light->illuminant;
  light->illuminant = even;
  light->power *= density(&whole, range_nm, band_nm);
  const bool dark = !(brightness(&whole, band_nm) > 0);
  if (dark) light->power = 0;
  ABBE_TRY(flatten(dark ? &even : &whole, band_nm, &light->illuminant, error));
  const double own = brightness(&light->illuminant, band_nm);
  if (own > 0) light->power *= first / own;
  return ABBE_OK;
}

/* X + Y + Z of the working space's white, which is what ambient light and background are. */
static double sum_of_white(void) {
  double to_xyz[9], sum = 0;
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, to_xyz);
  for (int k = 0; k < 9; k++) sum += to_xyz[k];
  return sum;
}

static double lift(const double rec709[3], const double basis[3]) {
  double sum = 0;
  for (int k = 0; k < 3; k++) sum += rec709[k] * basis[k];
  return sum;
}

/* Its texture is its own afterwards, or zeroed where this fails. */
static abbe_result lift_object(abbe_object *object, const double basis[3], abbe_error *error) {
  const abbe_image *from = &object->texture;
  const float *texel = from->data;
  const size_t texels = from->width * from->height, channels = from->channels;
  const double own[3] = {object->reflectance[0], object->reflectance[1], object->reflectance[2]};
  const bool textured = texel != NULL;
  for (int k = 0; k < 3; k++) object->reflectance[k] = textured ? 1 : lift(own, basis);
  if (!textured) return ABBE_OK;
  float *data = malloc(texels * channels * sizeof *data);
  object->texture.data = data;
  if (data == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the texture of '%s'", object->name);
  for (size_t i = 0; i < texels * channels; i += channels) {
    double rec709[3];
    for (int k = 0; k < 3; k++) rec709[k] = (double)texel[i + (size_t)k] * own[k];
    for (size_t k = 0; k < channels; k++) data[i + k] = (float)lift(rec709, basis);
  }
  return ABBE_OK;
}

static void band_scene_free(abbe_scene *scene) {
  if (scene == NULL) return;
  for (size_t i = 0; i < scene->object_count && scene->object != NULL; i++)
    free(scene->object[i].texture.data);
  for (size_t i = 0; i < scene->light_count && scene->light != NULL; i++)
    abbe_spectrum_free(scene->light[i].illuminant.spectrum);
  free(scene->light);
  free(scene->object);
  *scene = (abbe_scene){0};
}

/* The scene in the light of from_nm to to_nm alone, of a picture over min_nm to max_nm: such that
 * X + Y + Z of its picture over that band, times *unit, is spectral radiance. It has lights and
 * objects of its own, all else is the scene's; abbe_band_scene_free frees them. ABBE_NO_MEMORY. */
static abbe_result band_scene_make(const abbe_scene *scene, const double range_nm[2],
                                   const double band_nm[2], abbe_scene *out, double *unit,
                                   abbe_error *error) {
  static const abbe_illuminant even = {.kind = ABBE_ILLUMINANT_E};
  if (scene->light_count == 0 || !(band_nm[0] < band_nm[1]))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a scene in the band of %g to %g nm needs a light, and the band a width",
                          band_nm[0], band_nm[1]);
  const abbe_illuminant *light = abbe_scene_illuminant(scene);
  double basis[3], first = brightness(light, band_nm);
  if (!(first > 0)) first = brightness(&even, band_nm);
  *unit = 1 / first;
  *out = *scene;
  out->light_count = out->object_count = 0;
  out->light = calloc(scene->light_count + 1, sizeof *out->light);
  out->object = calloc(scene->object_count + 1, sizeof *out->object);
  abbe_result result = ABBE_OK;
  if (out->light == NULL || out->object == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a scene in a band");
  const double even_light = density(light, range_nm, band_nm) * first / sum_of_white();
  out->ambient *= even_light;
  out->background *= even_light;
  for (size_t i = 0; i < scene->light_count && result == ABBE_OK; i++) {
    out->light[i] = scene->light[i];
    result = dim(&out->light[i], range_nm, band_nm, first, error);
    out->light_count++;
  }
  abbe_upsampling_basis_mean(band_nm[0], band_nm[1], basis);
  for (size_t i = 0; i < scene->object_count && result == ABBE_OK; i++) {
    out->object[i] = scene->object[i];
    result = lift_object(&out->object[i], basis, error);
    out->object_count++;
  }
  if (result != ABBE_OK) band_scene_free(out);
  return result;
}

/* ---- the picture ---- */

typedef struct work {
  abbe_context *context;
  const abbe_scene *scene;
  abbe_render_desc desc; /* its range whole */
  size_t bands, band;
  abbe_render_progress progress;
  void *user;
  abbe_renderer *renderer;
  abbe_scene shown; /* scene of that renderer */
} work;

static bool tell(void *user, double done) {
  const work *w = user;
  return w->progress == NULL || w->progress(w->user, ((double)w->band + done) / (double)w->bands);
}

static abbe_result check(const work *w, abbe_error *error) {
  if (w->bands < 1 || w->bands > ABBE_RENDER_MAX_BANDS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a picture of %zu bands; it may have 1 to %d", w->bands,
                          ABBE_RENDER_MAX_BANDS);
  if (abbe_method_of(w->desc.profile)->own_passes)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the %s profile's passes sum colours; bands go with the default profile",
                          abbe_profile_name(w->desc.profile));
  if (w->desc.volume != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a volume of caustics holds colours; bands go with photons");
  if (w->scene->environment != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "surroundings are not rendered in bands; abbe trace --bands has them");
  return ABBE_OK;
}

static void band_ends(const work *w, size_t band, double out[2]) {
  const double width = (w->desc.max_nm - w->desc.min_nm) / (double)w->bands;
  out[0] = w->desc.min_nm + width * (double)band;
  out[1] = band + 1 < w->bands ? out[0] + width : w->desc.max_nm;
}

/* Neighbouring bands share the wavelength between them. */
static size_t wavelengths_of(const work *w) {
  const size_t all = w->desc.wavelengths;
  if (all == 1) return 1;
  return (all - 1 + w->bands - 1) / w->bands + 1;
}

static abbe_result make_image(const work *w, abbe_image *out, abbe_error *error) {
  char name[ABBE_RENDER_MAX_BANDS][NAME_SIZE];
  const char *names[ABBE_RENDER_MAX_BANDS];
  for (size_t i = 0; i < w->bands; i++) {
    double band[2];
    band_ends(w, i, band);
    abbe_image_band_name(0.5 * (band[0] + band[1]), name[i], sizeof name[i]);
    names[i] = name[i];
  }
  ABBE_TRY(abbe_image_make(w->desc.width, w->desc.height, w->bands, names, out, error));
  ABBE_TRY(abbe_image_set_attribute(out, "spectralLayoutVersion", "1.0", error));
  return abbe_image_set_attribute(out, "emissiveUnits", "W.m^-2.sr^-1.nm^-1", error);
}

/* The renderer shows the band afterwards, and the scene that it had before is freed. */
static abbe_result change(work *w, const abbe_render_desc *desc, const double band[2], double *unit,
                          abbe_error *error) {
  const double range[2] = {w->desc.min_nm, w->desc.max_nm};
  abbe_scene next;
  ABBE_TRY(band_scene_make(w->scene, range, band, &next, unit, error));
  abbe_result result = w->renderer == NULL
                           ? abbe_renderer_make(w->context, &next, desc, &w->renderer, error)
                           : abbe_renderer_change(w->renderer, &next, desc, error);
  band_scene_free(&w->shown);
  w->shown = next;
  return result;
}

static abbe_result draw_band(work *w, abbe_image *out, abbe_error *error) {
  double band[2], unit = 0;
  abbe_image picture = {0};
  abbe_render_desc desc = w->desc;
  band_ends(w, w->band, band);
  desc.min_nm = band[0];
  desc.max_nm = band[1];
  desc.wavelengths = w->desc.wavelengths > 0 ? wavelengths_of(w) : 0;
  desc.space = ABBE_RGB_SPACE_XYZ;
  desc.observer = ABBE_OBSERVER_CIE_1931; /* what it makes of a band is divided out */
  desc.aovs = false;
  desc.progress = NULL;
  desc.compiling = NULL;
  ABBE_TRY(change(w, &desc, band, &unit, error));
  ABBE_TRY(abbe_renderer_frame(w->renderer, tell, w, NULL, error));
  ABBE_TRY(abbe_renderer_read(w->renderer, false, &picture, error));
  for (size_t p = 0; p < out->width * out->height; p++) {
    const float *xyz = picture.data + p * picture.channels;
    out->data[p * out->channels + w->band] =
        (float)(unit * ((double)xyz[0] + (double)xyz[1] + (double)xyz[2]));
  }
  abbe_image_free(&picture);
  return ABBE_OK;
}

abbe_result abbe_band_picture_make(abbe_context *context, const abbe_scene *scene,
                                   const abbe_render_desc *desc, size_t bands,
                                   abbe_render_progress progress, void *user, abbe_image *out,
                                   abbe_error *error) {
  *out = (abbe_image){0};
  work w = {.context = context, .scene = scene, .bands = bands, .progress = progress, .user = user};
  abbe_result result =
      abbe_render_desc_resolve(desc, scene->camera.width, scene->camera.height, &w.desc, error);
  double line[ABBE_PLAN_MOST_LINES]; /* of lines each band has its own as wavelengths */
  const bool lines =
      result == ABBE_OK && abbe_spectral_needs_lines(scene, w.desc.min_nm, w.desc.max_nm, line) > 0;
  if (result == ABBE_OK && w.desc.wavelengths == 0 && !lines)
    w.desc.wavelengths = ABBE_PLAN_WAVELENGTHS;
  if (result == ABBE_OK) result = check(&w, error);
  if (result == ABBE_OK) result = make_image(&w, out, error);
  for (w.band = 0; w.band < bands && result == ABBE_OK; w.band++)
    result = draw_band(&w, out, error);
  abbe_renderer_free(w.renderer);
  band_scene_free(&w.shown);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
