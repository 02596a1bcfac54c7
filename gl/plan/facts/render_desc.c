#include "gl/plan/facts/render_desc.h"

#include "gl/plan/facts/render_settings.h"
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

bool abbe_profile_is_shah2007(abbe_profile profile) {
  return profile == ABBE_PROFILE_SHAH2007 || profile == ABBE_PROFILE_SHAH2007_CIE;
}

bool abbe_profile_is_wyman2006(abbe_profile profile) {
  return profile == ABBE_PROFILE_WYMAN2006 || profile == ABBE_PROFILE_WYMAN2006_CIE;
}

bool abbe_profile_is_wyman2003(abbe_profile profile) {
  return profile == ABBE_PROFILE_WYMAN2003;
}

bool abbe_profile_is_wand2003(abbe_profile profile) {
  return profile == ABBE_PROFILE_WAND2003;
}

bool abbe_profile_has_lamp(abbe_profile profile) {
  return abbe_profile_is_published(profile) && !abbe_profile_is_wand2003(profile);
}

bool abbe_profile_estimates(abbe_profile profile) {
  return abbe_profile_is_shah2007(profile) || abbe_profile_is_wyman2006(profile);
}

bool abbe_profile_is_published(abbe_profile profile) {
  return profile != ABBE_PROFILE_DEFAULT && profile != ABBE_PROFILE_WYMAN2003;
}

bool abbe_profile_is_printed(abbe_profile profile) {
  return profile == ABBE_PROFILE_THESIS || profile == ABBE_PROFILE_SHAH2007 ||
         profile == ABBE_PROFILE_WYMAN2006;
}

const char *abbe_fill_name(abbe_fill fill) {
  static const char *const names[] = {ABBE_FILLS(ABBE_NAME_OF)};
  return (int)fill >= 0 && fill < ABBE_FILL_COUNT ? names[fill] : "unknown";
}

const char *abbe_transport_name(abbe_transport transport) {
  static const char *const names[] = {ABBE_TRANSPORTS(ABBE_NAME_OF)};
  return (int)transport >= 0 && transport < ABBE_TRANSPORT_COUNT ? names[transport] : "unknown";
}

const char *abbe_model_name(abbe_model model) {
  static const char *const names[] = {ABBE_MODELS(ABBE_NAME_OF)};
  return (int)model >= 0 && model < ABBE_MODEL_COUNT ? names[model] : "unknown";
}
#undef ABBE_NAME_OF

/* The printed methods' own: the thesis's nodes are 380 to 680, three of red, green and blue. */
static const double shah_nm[2] = {450, 650};
enum {
  SHAH_PHOTONS = 128,
  SHAH_MAP = 768,
  WYMAN_PHOTONS = 1024,
  WYMAN_MAP = 512,
  THESIS_PHOTONS = 512
};

bool abbe_render_desc_in_light(const abbe_render_desc *d) {
  return abbe_profile_is_wyman2006(d->profile) &&
         (d->fill == ABBE_FILL_GATHER_LIGHT || (d->polygons & ABBE_POLYGONS_IN_LIGHT) != 0);
}

abbe_direction abbe_direction_of_profile(abbe_profile profile) {
  if (!abbe_profile_is_wyman2006(profile)) return ABBE_DIRECTION_AUTO;
  return abbe_profile_is_printed(profile) ? ABBE_DIRECTION_MEAN : ABBE_DIRECTION_DIRECT;
}

static void fill_in_wyman(abbe_render_desc *d) {
  if (d->photons == 0) d->photons = WYMAN_PHOTONS;
  if (d->map_size == 0) d->map_size = WYMAN_MAP;
  if (d->fill == ABBE_FILL_AUTO) d->fill = ABBE_FILL_GATHER_LIGHT;
  if (d->fill == ABBE_FILL_NONE) d->fill = ABBE_FILL_POINTS;
  if (d->history == 0) d->history = 1;
  if (d->direction == ABBE_DIRECTION_AUTO) d->direction = abbe_direction_of_profile(d->profile);
}

static void fill_in_pinholes(abbe_render_desc *d) {
  if (d->transport == ABBE_TRANSPORT_AUTO && abbe_profile_is_wand2003(d->profile))
    d->transport = ABBE_TRANSPORT_PINHOLE;
  if (d->transport != ABBE_TRANSPORT_PINHOLE) return;
  if (d->pinholes == 0) d->pinholes = ABBE_PLAN_PINHOLES;
  if (d->strategy == ABBE_SAMPLE_STRATEGY_AUTO) d->strategy = ABBE_SAMPLE_STRATEGY_NEIGHBOUR;
  if (d->footprint == ABBE_FOOTPRINT_AUTO) d->footprint = ABBE_FOOTPRINT_ON;
  if (d->clusters == 0 && !abbe_profile_is_wand2003(d->profile)) d->clusters = ABBE_PLAN_CLUSTERS;
}

size_t abbe_render_desc_eye_wavelengths(const abbe_render_desc *desc) {
  const size_t most = desc->upsample > 2 ? 4 : 7;
  return desc->coarse != ABBE_COARSE_NONE && desc->wavelengths > most ? most : desc->wavelengths;
}

void abbe_render_desc_take_pinholes(abbe_render_desc *desc) {
  desc->transport = ABBE_TRANSPORT_PINHOLE;
  fill_in_pinholes(desc);
}

static void fill_in_estimates(abbe_render_desc *d) {
  const bool printed = abbe_profile_is_printed(d->profile);
  if (printed && d->min_nm == 0) d->min_nm = shah_nm[0];
  if (printed && d->max_nm == 0) d->max_nm = shah_nm[1];
  if (d->photons == 0) d->photons = SHAH_PHOTONS;
  if (d->map_size == 0) d->map_size = SHAH_MAP;
  if (d->iterations == 0) d->iterations = 1;
  if (d->interfaces == 0) d->interfaces = 2;
  if (d->estimator == ABBE_ESTIMATOR_AUTO)
    d->estimator = printed ? ABBE_ESTIMATOR_SHAH : ABBE_ESTIMATOR_RATIO;
}

static void fill_in_defaults(size_t width, size_t height, abbe_render_desc *d) {
  const bool published = abbe_profile_is_published(d->profile);
  const bool thesis = abbe_profile_is_thesis(d->profile);
  if (abbe_profile_is_wyman2006(d->profile)) fill_in_wyman(d);
  if (abbe_profile_estimates(d->profile)) fill_in_estimates(d);
  fill_in_pinholes(d);
  if (d->width == 0) d->width = width;
  if (d->height == 0) d->height = height;
  if (d->min_nm == 0) d->min_nm = ABBE_WAVELENGTH_MIN_NM;
  if (d->max_nm == 0)
    d->max_nm = d->profile == ABBE_PROFILE_THESIS ? 680.0 : ABBE_WAVELENGTH_MAX_NM;
  if (d->photons == 0) d->photons = thesis ? THESIS_PHOTONS : ABBE_PLAN_PHOTONS;
  if (d->map_size == 0) d->map_size = ABBE_PLAN_MAP;
  if (d->upsample == 0) d->upsample = 1;
  if (d->supersample == 0) d->supersample = published || d->upsample > 1 ? 1 : ABBE_PLAN_SAMPLES;
  if (d->environment_lights == 0) d->environment_lights = ABBE_PLAN_ENVIRONMENT_LIGHTS;
  if (d->light_points == 0) d->light_points = ABBE_PLAN_LIGHT_POINTS;
  /* Between far samples lies what their neighbours tell: rays over a sample's own area are no help.
   */
  if (d->adaptive == 0) d->adaptive = published || d->upsample > 1 ? 1 : ABBE_PLAN_ADAPTIVE;
  if (d->fill == ABBE_FILL_AUTO)
    d->fill = thesis ? ABBE_FILL_SMEAR : published ? ABBE_FILL_NONE : ABBE_FILL_BRIDGE;
  if (d->energy_share == 0) d->energy_share = ABBE_PLAN_SHARE;
  const bool volume = d->volume != NULL || abbe_profile_is_wyman2003(d->profile);
  if (d->transport == ABBE_TRANSPORT_AUTO)
    d->transport = volume ? ABBE_TRANSPORT_VOLUME : ABBE_TRANSPORT_PHOTONS;
  if (d->receiver_samples == 0)
    d->receiver_samples =
        d->transport == ABBE_TRANSPORT_VOLUME && d->adaptive > 1 ? 1 : d->supersample;
  if (d->lookup == ABBE_VOLUME_LOOKUP_AUTO && abbe_profile_is_wyman2003(d->profile))
    d->lookup = ABBE_VOLUME_LOOKUP_TURN;
}

static abbe_result check_counts(const abbe_render_desc *d, abbe_error *error) {
  enum { PUBLISHED_WAVELENGTHS = 64 };
  if (abbe_profile_is_published(d->profile) && d->wavelengths > PUBLISHED_WAVELENGTHS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the number of wavelengths is %zu; it may be 1 to %d", d->wavelengths,
                          PUBLISHED_WAVELENGTHS);
  return abbe_render_settings_check(d, error);
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

static abbe_result check_polygons(const abbe_render_desc *d, abbe_error *error) {
  const bool polygons = abbe_profile_is_wyman2006(d->profile) &&
                        (d->fill == ABBE_FILL_QUADS || d->fill == ABBE_FILL_TRIANGLES);
  if (d->polygons > ABBE_POLYGONS_ALL || (!polygons && d->polygons != 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "polygons of another kind go with the profiles wyman2006 and "
                          "wyman2006-cie and the fills quads and triangles, not with '%s' and '%s'",
                          abbe_profile_name(d->profile), abbe_fill_name(d->fill));
  if ((d->polygons & ABBE_POLYGONS_EVEN) != 0 && !abbe_profile_is_printed(d->profile))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "in units a beam has the light of its solid angle; wyman2006-cie takes "
                          "no even ones, wyman2006 does");
  return ABBE_OK;
}

/* What the published methods alone know, and what they do not. */
static abbe_result check_wyman(const abbe_render_desc *d, abbe_error *error) {
  const bool wyman = abbe_profile_is_wyman2006(d->profile);
  const bool gathers = d->fill == ABBE_FILL_GATHER_EYE || d->fill == ABBE_FILL_GATHER_LIGHT;
  if ((int)d->direction < 0 || d->direction >= ABBE_DIRECTION_COUNT ||
      (!wyman && d->direction != ABBE_DIRECTION_AUTO))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a direction of shading goes with the profiles wyman2006 and "
                          "wyman2006-cie, not with '%s'",
                          abbe_profile_name(d->profile));
  if (!wyman && d->profile != ABBE_PROFILE_DEFAULT && d->history > 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a history of frames goes with the profiles default, wyman2006 and "
                          "wyman2006-cie, not with '%s'",
                          abbe_profile_name(d->profile));
  if (d->profile == ABBE_PROFILE_WYMAN2006_CIE && d->direction != ABBE_DIRECTION_DIRECT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "in units light is the same whatever direction it is shaded by; "
                          "wyman2006-cie takes none, wyman2006 does");
  if (wyman && d->history > 1 && !gathers)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a history of %zu frames goes with gathers, not with the fill '%s'",
                          d->history, abbe_fill_name(d->fill));
  if (d->profile == ABBE_PROFILE_WYMAN2006 && d->wavelengths > 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the profile 'wyman2006' has one index for all colours; it cannot take "
                          "%zu wavelengths, wyman2006-cie can",
                          d->wavelengths);
  return check_polygons(d, error);
}

static abbe_result check_pinholes(const abbe_render_desc *d, abbe_error *error) {
  const bool pinholes = d->transport == ABBE_TRANSPORT_PINHOLE;
  const char *name = abbe_profile_name(d->profile);
  if ((int)d->transport < 0 || d->transport >= ABBE_TRANSPORT_COUNT ||
      (pinholes ? abbe_profile_has_lamp(d->profile) : abbe_profile_is_wand2003(d->profile)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the transport '%s' does not go with the profile '%s'",
                          abbe_transport_name(d->transport), name);
  const bool asked = d->pinholes > 0 || d->strategy != ABBE_SAMPLE_STRATEGY_AUTO ||
                     d->footprint != ABBE_FOOTPRINT_AUTO || d->clusters > 0;
  if (d->clusters > 0 && abbe_profile_is_wand2003(d->profile))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "clusters of pinholes go with the default profile, not with '%s'", name);
  if ((int)d->strategy < 0 || d->strategy >= ABBE_SAMPLE_STRATEGY_COUNT || (int)d->footprint < 0 ||
      d->footprint >= ABBE_FOOTPRINT_COUNT || (asked && !pinholes))
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "a number of pinholes, a strategy for them, footprints and clusters go with the "
        "transport 'pinhole', not with '%s'",
        abbe_transport_name(d->transport));
  return ABBE_OK;
}

static abbe_result check_published(const abbe_render_desc *d, abbe_error *error) {
  const bool estimates = abbe_profile_estimates(d->profile);
  if ((int)d->estimator < 0 || d->estimator >= ABBE_ESTIMATOR_COUNT ||
      (!estimates &&
       (d->estimator != ABBE_ESTIMATOR_AUTO || d->iterations > 0 || d->interfaces > 0)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an estimator, its iterations and a number of interfaces go with the "
                          "profiles shah2007 and wyman2006 and their twins, not with '%s'",
                          abbe_profile_name(d->profile));
  if (d->faces > 0 && !estimates)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a number of the light's views goes with the profiles shah2007 and "
                          "wyman2006 and their twins, not with '%s'",
                          abbe_profile_name(d->profile));
  if (d->faces > 1 && abbe_render_desc_in_light(d))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "photons go to one image of the light's, not to %zu; take points, quads, "
                          "triangles or gather-eye in the camera's",
                          d->faces);
  if (d->faces > 1 && d->faces != ABBE_RENDER_CUBE_FACES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a light has %zu views; it may have 1, or the 6 of a cube", d->faces);
  if (d->low_pass > 0 && !abbe_profile_is_shah2007(d->profile))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a low pass of the map goes with the profiles shah2007 and shah2007-cie, "
                          "not with '%s'",
                          abbe_profile_name(d->profile));
  if (d->profile == ABBE_PROFILE_SHAH2007 && d->wavelengths != 0 && d->wavelengths != 1 &&
      d->wavelengths != ABBE_PLAN_SHAH_COLOURS)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "the profile 'shah2007' has an index each for red, green and blue, or one "
        "for all; it cannot take %zu wavelengths, shah2007-cie can",
        d->wavelengths);
  return check_wyman(d, error);
}

/* What goes with a volume, and what asks for one. */
static abbe_result check_volume(const abbe_render_desc *d, abbe_error *error) {
  const bool asked = d->transport == ABBE_TRANSPORT_VOLUME;
  const bool printed = abbe_profile_is_wyman2003(d->profile);
  if ((int)d->transport < 0 || d->transport >= ABBE_TRANSPORT_COUNT || (int)d->lookup < 0 ||
      d->lookup >= ABBE_VOLUME_LOOKUP_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no such transport or lookup");
  if (asked && d->volume == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "caustics are to be looked up in a volume, and none is given; 'abbe "
                          "volume' makes one%s",
                          printed ? ", with --printed for wyman2003" : "");
  if (!asked && (d->volume != NULL || printed || d->lookup != ABBE_VOLUME_LOOKUP_AUTO))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a volume and its lookup go with the transport 'volume', not with '%s'",
                          abbe_transport_name(d->transport));
  if (!asked) return ABBE_OK;
  if (abbe_profile_is_published(d->profile) || d->everything)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the transport 'volume' does not go with %s%s",
                          d->everything ? "all that is switched on" : "the profile ",
                          d->everything ? "" : abbe_profile_name(d->profile));
  const bool exits = d->volume->kind == ABBE_VOLUME_EXITS;
  if (exits && d->lookup != ABBE_VOLUME_LOOKUP_AUTO)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a volume of exits has no lookup to choose: its rays are interpolated");
  if (d->observer != ABBE_OBSERVER_CIE_1931 && !exits)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a volume holds the colours of the observer '%s', not of '%s'",
                          abbe_observer_text(ABBE_OBSERVER_CIE_1931),
                          abbe_observer_text(d->observer));
  if (printed == (d->volume->kind == ABBE_VOLUME_PRINTED)) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the profile '%s' looks up %s volumes, and this one is not: make it %s "
                        "--printed",
                        abbe_profile_name(d->profile), printed ? "printed" : "vector",
                        printed ? "with" : "without");
}

/* Whether it knows the fill, which is not AUTO any more. */
static bool knows_fill(const abbe_render_desc *d) {
  const bool published = abbe_profile_is_published(d->profile);
  if (abbe_profile_is_wyman2006(d->profile))
    return d->fill >= ABBE_FILL_POINTS && d->fill <= ABBE_FILL_GATHER_LIGHT;
  return d->fill == ABBE_FILL_NONE ||
         (d->fill == ABBE_FILL_SMEAR && abbe_profile_is_thesis(d->profile)) ||
         (d->fill == ABBE_FILL_BRIDGE && !published);
}

static abbe_result check_choices(const abbe_render_desc *d, abbe_error *error) {
  const bool published = abbe_profile_is_published(d->profile);
  const char *name = abbe_profile_name(d->profile);
  if (d->upsample > 1 && published)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the %s profile has a sample for every pixel; it cannot be upsampled",
                          name);
  if (d->upsample > 1 && d->supersample > 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a sample for %zu x %zu pixels and %zu samples a pixel side: ask for one "
                          "of the two",
                          d->upsample, d->upsample, d->supersample);
  if (d->receiver_samples != 1 && d->receiver_samples != d->supersample)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%zu samples of receivers a pixel side and %zu of refractors; receivers may "
        "have 1, or as many",
        d->receiver_samples, d->supersample);
  if (d->adaptive > 1 && published)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the %s profile knows no adaptive samples; it cannot take %zu a side",
                          name, d->adaptive);
  if ((int)d->model < 0 || d->model >= ABBE_MODEL_COUNT ||
      (published && d->model != ABBE_MODEL_AUTO))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the model '%s' does not go with the profile '%s'",
                          abbe_model_name(d->model), abbe_profile_name(d->profile));
  if ((int)d->observer < 0 || d->observer >= ABBE_OBSERVER_COUNT ||
      (abbe_profile_is_printed(d->profile) && d->observer != ABBE_OBSERVER_CIE_1931))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the observer '%s' does not go with the profile '%s', whose colours are "
                          "printed; %s has those of the CIE",
                          abbe_observer_text(d->observer), name,
                          abbe_profile_is_printed(d->profile) ? "its twin -cie" : "another");
  if (!knows_fill(d))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the fill '%s' does not go with the profile '%s'",
                          abbe_fill_name(d->fill), abbe_profile_name(d->profile));
  abbe_result result = check_published(d, error);
  if (result == ABBE_OK) result = check_pinholes(d, error);
  return result == ABBE_OK ? check_volume(d, error) : result;
}

abbe_result abbe_render_desc_resolve(const abbe_render_desc *desc, size_t width, size_t height,
                                     abbe_render_desc *out, abbe_error *error) {
  *out = desc != NULL ? *desc : (abbe_render_desc){0};
  fill_in_defaults(width, height, out);
  abbe_result result = check_counts(out, error);
  if (result == ABBE_OK) result = check_choices(out, error);
  if (result == ABBE_OK) result = check_numbers(out, error);
  return result;
}
