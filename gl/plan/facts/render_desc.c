#include "gl/plan/facts/render_desc.h"

#include "gl/plan/facts/render_settings.h"
#include "spectral/wavelengths.h"

#include <math.h>

#define ABBE_NAME_OF(code, name) name,
const char *abbe_model_name(abbe_model model) {
  static const char *const names[] = {ABBE_MODELS(ABBE_NAME_OF)};
  return (int)model >= 0 && model < ABBE_MODEL_COUNT ? names[model] : "unknown";
}
#undef ABBE_NAME_OF

bool abbe_render_desc_in_light(const abbe_render_desc *d) {
  return abbe_method_of(d->profile)->draws_photons &&
         (d->fill == ABBE_FILL_GATHER_LIGHT || (d->polygons & ABBE_POLYGONS_IN_LIGHT) != 0);
}

static void fill_in_pinholes(abbe_render_desc *d) {
  const bool surroundings = abbe_method_of(d->profile)->surroundings;
  if (d->transport == ABBE_TRANSPORT_AUTO && surroundings) d->transport = ABBE_TRANSPORT_PINHOLE;
  if (d->transport != ABBE_TRANSPORT_PINHOLE) return;
  if (d->pinholes == 0) d->pinholes = ABBE_PLAN_PINHOLES;
  if (d->footprint == ABBE_FOOTPRINT_AUTO) d->footprint = ABBE_FOOTPRINT_ON;
  if (d->clusters == 0 && !surroundings) d->clusters = ABBE_PLAN_CLUSTERS;
}

size_t abbe_render_desc_eye_wavelengths(const abbe_render_desc *desc) {
  const size_t most = desc->upsample > 2 ? 4 : 7;
  return desc->coarse != ABBE_COARSE_NONE && desc->wavelengths > most ? most : desc->wavelengths;
}

void abbe_render_desc_take_pinholes(abbe_render_desc *desc) {
  desc->transport = ABBE_TRANSPORT_PINHOLE;
  fill_in_pinholes(desc);
}

/* What the method has of its own. */
static void fill_in_method(const abbe_method_facts *m, abbe_render_desc *d) {
  if (d->min_nm == 0) d->min_nm = m->min_nm;
  if (d->max_nm == 0) d->max_nm = m->max_nm;
  if (d->photons == 0) d->photons = m->photons;
  if (d->map_size == 0) d->map_size = m->map_size;
  if (d->fill == ABBE_FILL_AUTO) d->fill = m->fill;
  if (m->draws_photons && d->fill == ABBE_FILL_NONE) d->fill = ABBE_FILL_POINTS;
  if (m->draws_photons && d->history == 0) d->history = 1;
  if (d->direction == ABBE_DIRECTION_AUTO) d->direction = m->direction;
  if (m->estimates && d->iterations == 0) d->iterations = 1;
  if (m->estimates && d->interfaces == 0) d->interfaces = 2;
  if (d->estimator == ABBE_ESTIMATOR_AUTO) d->estimator = m->estimator;
  if (d->lookup == ABBE_VOLUME_LOOKUP_AUTO && m->printed_volume)
    d->lookup = ABBE_VOLUME_LOOKUP_TURN;
}

static void fill_in_defaults(size_t width, size_t height, abbe_render_desc *d) {
  const abbe_method_facts *m = abbe_method_of(d->profile);
  fill_in_method(m, d);
  fill_in_pinholes(d);
  if (d->width == 0) d->width = width;
  if (d->height == 0) d->height = height;
  if (d->min_nm == 0) d->min_nm = ABBE_WAVELENGTH_MIN_NM;
  if (d->max_nm == 0) d->max_nm = ABBE_WAVELENGTH_MAX_NM;
  if (d->photons == 0) d->photons = ABBE_PLAN_PHOTONS;
  if (d->map_size == 0) d->map_size = ABBE_PLAN_MAP;
  if (d->upsample == 0) d->upsample = 1;
  /* Between far samples their neighbours show what lies there: rays over a sample's own area are no
   * help. */
  const bool one = m->own_passes || d->upsample > 1;
  if (d->supersample == 0) d->supersample = one ? 1 : ABBE_PLAN_SAMPLES;
  if (d->adaptive == 0) d->adaptive = one ? 1 : ABBE_PLAN_ADAPTIVE;
  if (d->environment_lights == 0) d->environment_lights = ABBE_PLAN_ENVIRONMENT_LIGHTS;
  if (d->light_points == 0) d->light_points = ABBE_PLAN_LIGHT_POINTS;
  if (d->energy_share == 0) d->energy_share = ABBE_PLAN_SHARE;
  if (d->transport == ABBE_TRANSPORT_AUTO)
    d->transport =
        d->volume != NULL || m->printed_volume ? ABBE_TRANSPORT_VOLUME : ABBE_TRANSPORT_PHOTONS;
  if (d->receiver_samples == 0)
    d->receiver_samples =
        d->transport == ABBE_TRANSPORT_VOLUME && d->adaptive > 1 ? 1 : d->supersample;
}

static abbe_result check_counts(const abbe_render_desc *d, abbe_error *error) {
  enum { PUBLISHED_WAVELENGTHS = 64 };
  if (abbe_method_of(d->profile)->own_passes && d->wavelengths > PUBLISHED_WAVELENGTHS)
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
  const abbe_method_facts *m = abbe_method_of(d->profile);
  const bool polygons =
      m->draws_photons && (d->fill == ABBE_FILL_QUADS || d->fill == ABBE_FILL_TRIANGLES);
  if (d->polygons > ABBE_POLYGONS_ALL || (!polygons && d->polygons != 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "polygons of another kind go with the profiles wyman2006 and "
                          "wyman2006-cie and the fills quads and triangles, not with '%s' and '%s'",
                          abbe_profile_name(d->profile), abbe_fill_name(d->fill));
  if ((d->polygons & ABBE_POLYGONS_EVEN) != 0 && !m->printed)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "in units a beam has the light of its solid angle; wyman2006-cie takes "
                          "no even ones, wyman2006 does");
  return ABBE_OK;
}

/* What the published methods alone know, and what they do not. */
static abbe_result check_drawn_photons(const abbe_render_desc *d, abbe_error *error) {
  const abbe_method_facts *m = abbe_method_of(d->profile);
  const bool gathers = d->fill == ABBE_FILL_GATHER_EYE || d->fill == ABBE_FILL_GATHER_LIGHT;
  if ((int)d->direction < 0 || d->direction >= ABBE_DIRECTION_COUNT ||
      (!m->draws_photons && d->direction != ABBE_DIRECTION_AUTO))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a direction of shading goes with the profiles wyman2006 and "
                          "wyman2006-cie, not with '%s'",
                          abbe_profile_name(d->profile));
  if (!m->history && d->history > 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a history of frames goes with the profiles default, wyman2006 and "
                          "wyman2006-cie, not with '%s'",
                          abbe_profile_name(d->profile));
  if (m->draws_photons && !m->printed && d->direction != ABBE_DIRECTION_DIRECT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "in units light is the same whatever direction it is shaded by; "
                          "wyman2006-cie takes none, wyman2006 does");
  if (m->draws_photons && d->history > 1 && !gathers)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a history of %zu frames goes with gathers, not with the fill '%s'",
                          d->history, abbe_fill_name(d->fill));
  return check_polygons(d, error);
}

static abbe_result check_pinholes(const abbe_render_desc *d, abbe_error *error) {
  const abbe_method_facts *m = abbe_method_of(d->profile);
  const bool pinholes = d->transport == ABBE_TRANSPORT_PINHOLE;
  const char *name = abbe_profile_name(d->profile);
  if ((int)d->transport < 0 || d->transport >= ABBE_TRANSPORT_COUNT ||
      (pinholes ? m->lamp : m->surroundings))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the transport '%s' does not go with the profile '%s'",
                          abbe_transport_name(d->transport), name);
  const bool asked = d->pinholes > 0 || d->footprint != ABBE_FOOTPRINT_AUTO || d->clusters > 0;
  if (d->clusters > 0 && m->surroundings)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "clusters of pinholes go with the default profile, not with '%s'", name);
  if ((int)d->footprint < 0 || d->footprint >= ABBE_FOOTPRINT_COUNT || (asked && !pinholes))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a number of pinholes, footprints and clusters go with the "
                          "transport 'pinhole', not with '%s'",
                          abbe_transport_name(d->transport));
  return ABBE_OK;
}

static abbe_result check_published(const abbe_render_desc *d, abbe_error *error) {
  const abbe_method_facts *m = abbe_method_of(d->profile);
  if ((int)d->estimator < 0 || d->estimator >= ABBE_ESTIMATOR_COUNT ||
      (!m->estimates &&
       (d->estimator != ABBE_ESTIMATOR_AUTO || d->iterations > 0 || d->interfaces > 0)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an estimator, its iterations and a number of interfaces go with the "
                          "profiles shah2007 and wyman2006 and their twins, not with '%s'",
                          abbe_profile_name(d->profile));
  if (d->faces > 0 && !m->estimates)
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
  if (d->low_pass > 0 && !m->low_pass)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a low pass of the map goes with the profiles shah2007 and shah2007-cie, "
                          "not with '%s'",
                          abbe_profile_name(d->profile));
  if (m->wavelengths > 0 && d->wavelengths > 1 && d->wavelengths != m->wavelengths)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the profile '%s' has %s; it cannot take %zu wavelengths, %s-cie can",
                          abbe_profile_name(d->profile),
                          m->wavelengths == 1
                              ? "one index for all colours"
                              : "an index each for red, green and blue, or one for all",
                          d->wavelengths, abbe_profile_name(d->profile));
  return check_drawn_photons(d, error);
}

/* What goes with a volume, and what needs one. */
static abbe_result check_volume(const abbe_render_desc *d, abbe_error *error) {
  const bool asked = d->transport == ABBE_TRANSPORT_VOLUME;
  const bool printed = abbe_method_of(d->profile)->printed_volume;
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
  if (abbe_method_of(d->profile)->own_passes || d->everything)
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

static abbe_result check_choices(const abbe_render_desc *d, abbe_error *error) {
  const abbe_method_facts *m = abbe_method_of(d->profile);
  const bool published = m->own_passes;
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
      (m->printed && d->observer != ABBE_OBSERVER_CIE_1931))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the observer '%s' does not go with the profile '%s', whose colours are "
                          "printed; %s has those of the CIE",
                          abbe_observer_text(d->observer), name,
                          m->printed ? "its twin -cie" : "another");
  if ((int)d->fill < 0 || d->fill >= ABBE_FILL_COUNT || (m->fills >> d->fill & 1) == 0)
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
