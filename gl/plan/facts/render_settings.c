#include "gl/plan/facts/render_settings.h"

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
     .default_ = "photons; of wand2003 pinhole",
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

abbe_result abbe_render_settings_check(const abbe_render_desc *desc, abbe_error *error) {
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
