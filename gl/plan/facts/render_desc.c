#include "gl/plan/facts/render_desc.h"

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
  if (d->lens == 0) d->lens = m->own_passes ? 1 : ABBE_PLAN_LENS;
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

/* Checks a request that is resolved; ABBE_INVALID_ARGUMENT names the first count that is out of its
 * limits, and these. */
static abbe_result render_settings_check(const abbe_render_desc *desc, abbe_error *error) {
  for (size_t i = 0; i < abbe_render_settings_count; i++) {
    const abbe_render_setting *s = &abbe_render_settings[i];
    if (s->kind != ABBE_SETTING_COUNT || s->what == NULL) continue;
    const size_t value = *(const size_t *)((const char *)desc + s->offset);
    if ((value == 0 && !s->stays_open) || (double)value > s->most)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s is %zu; it may be 1 to %.0f", s->what,
                            value, s->most);
  }
  return ABBE_OK;
}

static abbe_result check_counts(const abbe_render_desc *d, abbe_error *error) {
  enum { PUBLISHED_WAVELENGTHS = 64 };
  if (abbe_method_of(d->profile)->own_passes && d->wavelengths > PUBLISHED_WAVELENGTHS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the number of wavelengths is %zu; it may be 1 to %d", d->wavelengths,
                          PUBLISHED_WAVELENGTHS);
  return render_settings_check(d, error);
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
  if (!(hypot(d->lens_place[0], d->lens_place[1]) <= 1))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a place on the lens is %g, %g of its radius; it may be within 1",
                          d->lens_place[0], d->lens_place[1]);
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
  ABBE_TRY(check_published(d, error));
  ABBE_TRY(check_pinholes(d, error));
  return check_volume(d, error);
}

abbe_result abbe_render_desc_resolve(const abbe_render_desc *desc, size_t width, size_t height,
                                     abbe_render_desc *out, abbe_error *error) {
  *out = desc != NULL ? *desc : (abbe_render_desc){0};
  fill_in_defaults(width, height, out);
  ABBE_TRY(check_counts(out, error));
  ABBE_TRY(check_choices(out, error));
  return check_numbers(out, error);
}

/* Choices are written as int. */
_Static_assert(sizeof(abbe_profile) == sizeof(int) && sizeof(abbe_observer) == sizeof(int),
               "an enum is as large as an int");

#define NAME_OF_2(code, name) name,
#define NAME_OF_3(code, name, more) name,
#define NAMES(list, name_of)                                                                       \
  .names = (const char *const[]){list(name_of)},                                                   \
  .name_count = sizeof((const char *const[]){list(name_of)}) / sizeof(const char *)
#define FIELD(field) .key = #field, .offset = offsetof(abbe_render_desc, field)
#define COUNT(field, least_, most_)                                                                \
  FIELD(field), .kind = ABBE_SETTING_COUNT, .least = (double)(least_), .most = (double)(most_)
#define NUMBER(field, least_, most_)                                                               \
  FIELD(field), .kind = ABBE_SETTING_NUMBER, .least = least_, .most = most_
#define FLAG(field) FIELD(field), .kind = ABBE_SETTING_FLAG, .least = 0, .most = 1
#define CHOICE(field, list, name_of) FIELD(field), .kind = ABBE_SETTING_CHOICE, NAMES(list, name_of)

const abbe_render_setting abbe_render_settings[] = {
    {COUNT(width, 1, ABBE_RENDER_MAX_SIDE), .what = "the width"},
    {COUNT(height, 1, ABBE_RENDER_MAX_SIDE), .what = "the height"},
    {NUMBER(min_nm, 1, 1e6)},
    {NUMBER(max_nm, 1, 1e6)},
    {COUNT(wavelengths, 1, ABBE_RENDER_MAX_WAVELENGTHS), .option = "wavelengths",
     .stays_open = true, .what = "the number of wavelengths", .default_ = "7",
     .help = "samples of the spectrum that a photon takes at the most"},
    {COUNT(photons, 1, ABBE_RENDER_MAX_PHOTONS), .option = "photons", .what = "the photon grid",
     .default_ = "256", .help = "side of the photon grid"},
    {COUNT(map_size, 1, ABBE_RENDER_MAX_MAP), .option = "map", .what = "the spectral map",
     .default_ = "1024", .help = "side of the spectral map"},
    {COUNT(supersample, 1, 4), .option = "samples", .what = "the supersampling",
     .default_ = "2; thesis 1", .help = "samples a pixel side"},
    {COUNT(upsample, 1, 4), .option = "upsample", .what = "the upsampling", .default_ = "1",
     .help = "or a sample for N x N pixels, and between samples: a draft"},
    {COUNT(adaptive, 1, ABBE_RENDER_MAX_ADAPTIVE), .option = "adaptive",
     .what = "the adaptive sampling", .default_ = "4; thesis, and with --upsample, 1",
     .help = "N x N rays for a sample of a receiver where its light bends"},
    {COUNT(lens, 1, ABBE_RENDER_MAX_LENS), .option = "lens", .aside = true,
     .what = "the number of places on the lens", .default_ = "16; published profiles 1",
     .help =
         "of a camera with an aperture, places on it that the picture is seen from; 1 is sharp"},
    {COUNT(receiver_samples, 1, 4), .option = "receiver-samples", .aside = true,
     .default_ = "as --samples; 1 of a volume with --adaptive above 1",
     .help = "samples of receivers a pixel side, as --samples or one"},
    {COUNT(light_points, 1, ABBE_RENDER_MAX_LIGHT_POINTS), .option = "light-points", .aside = true,
     .what = "the number of a light's points", .default_ = "8",
     .help = "points in all that stand for a light with a size"},
    {COUNT(environment_lights, 1, ABBE_RENDER_MAX_ENVIRONMENT_LIGHTS),
     .option = "environment-lights", .aside = true,
     .what = "the number of the environment's lights", .default_ = "4",
     .help = "directional lights at the most that stand for what stands out of an environment"},
    {COUNT(exits, 1, ABBE_RENDER_MAX_EXITS), .option = "exits", .aside = true, .stays_open = true,
     .what = "the number of exits", .default_ = "8; to 24 in a gem; 4 by layers",
     .help = "exits followed at the most"},
    {NUMBER(energy_share, 1e-9, 1), .option = "share", .aside = true,
     .default_ = "0.01; 0.005 in a gem", .help = "paths end below this share of their light"},
    {CHOICE(model, ABBE_MODELS, NAME_OF_2), .option = "model", .aside = true,
     .default_ = "auto: by the scene", .help = "how light goes through refractors: "},
    {CHOICE(transport, ABBE_TRANSPORTS, NAME_OF_2), .option = "transport",
     .default_ = "by the scene; of wand2003 pinhole",
     .help = "of caustics: photons; volume, looked up in what abbe volume has made; or pinhole, "
             "photons of what stands out of surroundings and samples of mirrors and refractors for "
             "the rest"},
    {CHOICE(space, ABBE_RGB_SPACES, NAME_OF_3), .option = "space", .default_ = "acescg",
     .help = "of the picture: "},
    {CHOICE(observer, ABBE_OBSERVERS, NAME_OF_3)},
    {FLAG(aovs)},
    {FLAG(everything), .option = "everything", .aside = true,
     .help = "switch on what no fact asks for, to measure what the plan saves"},
    {COUNT(history, 1, ABBE_RENDER_MAX_HISTORY), .option = "history", .aside = true,
     .stays_open = true, .what = "the number of a picture's frames", .default_ = "1",
     .help = "frames that a picture holds, of the default profile and wyman2006's gathers: with "
             "--frames"},
    {CHOICE(profile, ABBE_PROFILES, NAME_OF_2), .option = "profile", .default_ = "default",
     .help = "a published method instead (abbe methods): "},
    {CHOICE(fill, ABBE_FILLS, NAME_OF_2), .option = "fill", .aside = true,
     .default_ = "bridge, of wyman2006 gather-light",
     .help =
         "gaps between wavelengths: bridge, none, smear (thesis); of wyman2006 between photons: "
         "points, quads, triangles, gather-eye, gather-light"},
    {COUNT(pinholes, 1, ABBE_SURFACE_MAX_SAMPLES), .option = "pinholes", .stays_open = true,
     .aside = true, .what = "the number of pinholes", .default_ = "256",
     .help = "of transport pinhole, samples of surfaces at the most"},
    {COUNT(clusters, 1, ABBE_RENDER_MAX_CLUSTERS), .option = "clusters", .stays_open = true,
     .aside = true, .what = "the number of clusters", .default_ = "50",
     .help = "of transport pinhole, samples are taken together where they send at most 1/N of a "
             "hemisphere's light; the most takes each by itself"},
    {CHOICE(footprint, ABBE_FOOTPRINTS, NAME_OF_2), .option = "footprint", .aside = true,
     .default_ = "on",
     .help = "of transport pinhole, whether a sample shows as much of the surroundings as it "
             "reflects by its curvature: "},
    {CHOICE(lookup, ABBE_VOLUME_LOOKUPS, NAME_OF_2), .option = "lookup", .aside = true,
     .default_ = "blend; of a ball, and of wyman2003, turn",
     .help = "of light between the nodes of a caustic volume: "},
    {CHOICE(direction, ABBE_DIRECTIONS, NAME_OF_2), .option = "direction", .aside = true,
     .default_ = "mean", .help = "of wyman2006, by which caustics are shaded: "},
    {CHOICE(estimator, ABBE_ESTIMATORS, NAME_OF_2), .option = "estimator", .aside = true,
     .default_ = "shah; in their twins ratio",
     .help = "of shah2007 and wyman2006, how rays are brought to receivers: "},
    {COUNT(iterations, 1, ABBE_ESTIMATOR_MAX_ITERATIONS), .option = "iterations",
     .stays_open = true, .aside = true, .what = "the number of iterations", .default_ = "1",
     .help = "of the estimator"},
    {COUNT(interfaces, 1, 2), .option = "interfaces", .stays_open = true, .aside = true,
     .what = "the number of interfaces", .default_ = "2",
     .help = "of shah2007 and wyman2006, that refract light; water has one"},
    {COUNT(faces, 1, ABBE_RENDER_CUBE_FACES), .option = "faces", .stays_open = true, .aside = true,
     .what = "the number of the light's views",
     .default_ = "6 where one does not hold what is around a point light",
     .help = "of shah2007 and wyman2006, views of the light; 6 are a cube around it"},
    {COUNT(low_pass, 1, ABBE_RENDER_MAX_LOW_PASS), .option = "low-pass", .stays_open = true,
     .aside = true, .what = "the low pass of the map", .default_ = "none",
     .help = "of shah2007, smooth its map by a Gaussian of N texels"},
};
const size_t abbe_render_settings_count =
    sizeof abbe_render_settings / sizeof *abbe_render_settings;

void *abbe_render_setting_in(const abbe_render_setting *setting, abbe_render_desc *desc) {
  return (char *)desc + setting->offset;
}
