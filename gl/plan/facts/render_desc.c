#include "gl/plan/facts/render_desc.h"

#include "spectral/wavelengths.h"

#include <math.h>

#define ABBE_NAME_OF(code, name) name,
const char *abbe_profile_name(abbe_profile profile) {
  static const char *const names[] = {ABBE_PROFILES(ABBE_NAME_OF)};
  return (int)profile >= 0 && profile < ABBE_PROFILE_COUNT ? names[profile] : "unknown";
}

bool abbe_profile_is_thesis(abbe_profile profile) {
  return profile == ABBE_PROFILE_THESIS || profile == ABBE_PROFILE_THESIS_CIE;
}

const char *abbe_fill_name(abbe_fill fill) {
  static const char *const names[] = {ABBE_FILLS(ABBE_NAME_OF)};
  return (int)fill >= 0 && fill < ABBE_FILL_COUNT ? names[fill] : "unknown";
}

const char *abbe_model_name(abbe_model model) {
  static const char *const names[] = {ABBE_MODELS(ABBE_NAME_OF)};
  return (int)model >= 0 && model < ABBE_MODEL_COUNT ? names[model] : "unknown";
}
#undef ABBE_NAME_OF

static void fill_in_defaults(size_t width, size_t height, abbe_render_desc *d) {
  const bool thesis = abbe_profile_is_thesis(d->profile);
  if (d->width == 0) d->width = width;
  if (d->height == 0) d->height = height;
  if (d->min_nm == 0) d->min_nm = ABBE_WAVELENGTH_MIN_NM;
  if (d->max_nm == 0)
    d->max_nm = d->profile == ABBE_PROFILE_THESIS ? 680.0 : ABBE_WAVELENGTH_MAX_NM;
  if (d->photons == 0) d->photons = thesis ? 512 : ABBE_PLAN_PHOTONS;
  if (d->map_size == 0) d->map_size = ABBE_PLAN_MAP;
  if (d->upsample == 0) d->upsample = 1;
  if (d->supersample == 0) d->supersample = thesis || d->upsample > 1 ? 1 : ABBE_PLAN_SAMPLES;
  if (d->environment_lights == 0) d->environment_lights = ABBE_PLAN_ENVIRONMENT_LIGHTS;
  if (d->light_points == 0) d->light_points = ABBE_PLAN_LIGHT_POINTS;
  if (d->adaptive == 0) d->adaptive = thesis ? 1 : ABBE_PLAN_ADAPTIVE;
  if (d->fill == ABBE_FILL_AUTO) d->fill = thesis ? ABBE_FILL_SMEAR : ABBE_FILL_BRIDGE;
  if (d->energy_share == 0) d->energy_share = ABBE_PLAN_SHARE;
}

static abbe_result check_counts(const abbe_render_desc *d, abbe_error *error) {
  const struct {
    const char *what;
    size_t value, least, most;
  } counts[] = {
      {"the width", d->width, 1, ABBE_RENDER_MAX_SIDE},
      {"the height", d->height, 1, ABBE_RENDER_MAX_SIDE},
      {"the photon grid", d->photons, 1, ABBE_RENDER_MAX_PHOTONS},
      {"the spectral map", d->map_size, 1, ABBE_RENDER_MAX_MAP},
      {"the supersampling", d->supersample, 1, 4},
      {"the upsampling", d->upsample, 1, 4},
      {"the number of the environment's lights", d->environment_lights, 1,
       ABBE_RENDER_MAX_ENVIRONMENT_LIGHTS},
      {"the number of a light's points", d->light_points, 1, ABBE_RENDER_MAX_LIGHT_POINTS},
      {"the adaptive sampling", d->adaptive, 1, ABBE_RENDER_MAX_ADAPTIVE},
      /* 0: the scene tells */
      {"the number of wavelengths", d->wavelengths, 0,
       abbe_profile_is_thesis(d->profile) ? 64 : ABBE_RENDER_MAX_WAVELENGTHS},
      {"the number of exits", d->exits, 0, ABBE_RENDER_MAX_EXITS},
  };
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    if (counts[i].value < counts[i].least || counts[i].value > counts[i].most)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s is %zu; it may be 1 to %zu",
                            counts[i].what, counts[i].value, counts[i].most);
  return ABBE_OK;
}

static abbe_result check_numbers(const abbe_render_desc *d, abbe_error *error) {
  if (!(d->min_nm > 0) || !(d->min_nm < d->max_nm) || !isfinite(d->max_nm))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g to %g nm is empty; 380 to 780 is the usual one", d->min_nm,
                          d->max_nm);
  if (!(d->energy_share > 0) || d->energy_share > 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the share of energy at which paths end is %g; it may be above 0, to 1",
                          d->energy_share);
  const double shift[4] = {d->photon_shift[0], d->photon_shift[1], d->sample_shift[0],
                           d->sample_shift[1]};
  for (int k = 0; k < 4; k++)
    if (!(fabs(shift[k]) <= 0.5))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the %s are shifted by %g of their distance; it may be -0.5 to 0.5",
                            k < 2 ? "photons" : "samples", shift[k]);
  return ABBE_OK;
}

static abbe_result check_choices(const abbe_render_desc *d, abbe_error *error) {
  const bool thesis = abbe_profile_is_thesis(d->profile);
  if (d->upsample > 1 && thesis)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the thesis profile has a sample for every pixel; it cannot be "
                          "upsampled");
  if (d->upsample > 1 && d->supersample > 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a sample for %zu x %zu pixels and %zu samples a pixel side: ask for one "
                          "of the two",
                          d->upsample, d->upsample, d->supersample);
  if (d->adaptive > 1 && thesis)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the thesis profile knows no adaptive samples; it cannot take %zu a side",
                          d->adaptive);
  if ((int)d->model < 0 || d->model >= ABBE_MODEL_COUNT || (thesis && d->model != ABBE_MODEL_AUTO))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the model '%s' does not go with the profile '%s'",
                          abbe_model_name(d->model), abbe_profile_name(d->profile));
  if (thesis != (d->fill == ABBE_FILL_SMEAR) && d->fill != ABBE_FILL_NONE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the fill '%s' does not go with the profile '%s'",
                          abbe_fill_name(d->fill), abbe_profile_name(d->profile));
  return ABBE_OK;
}

abbe_result abbe_render_desc_resolve(const abbe_render_desc *desc, size_t width, size_t height,
                                     abbe_render_desc *out, abbe_error *error) {
  ABBE_REQUIRE(out, error);
  *out = desc != NULL ? *desc : (abbe_render_desc){0};
  fill_in_defaults(width, height, out);
  abbe_result result = check_counts(out, error);
  if (result == ABBE_OK) result = check_choices(out, error);
  if (result == ABBE_OK) result = check_numbers(out, error);
  return result;
}
