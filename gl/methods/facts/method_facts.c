#include "gl/methods/facts/method_facts.h"

enum {
  BRIDGES = 1 << ABBE_FILL_NONE | 1 << ABBE_FILL_BRIDGE,
  SMEARS = 1 << ABBE_FILL_NONE | 1 << ABBE_FILL_SMEAR,
  DRAWS = 1 << ABBE_FILL_POINTS | 1 << ABBE_FILL_QUADS | 1 << ABBE_FILL_TRIANGLES |
          1 << ABBE_FILL_GATHER_EYE | 1 << ABBE_FILL_GATHER_LIGHT
};

/* What a method as printed and its profile in units have in common. */
#define THESIS                                                                                     \
  .called = "the thesis", .own_passes = true, .lamp = true, .fills = SMEARS,                       \
  .fill = ABBE_FILL_SMEAR, .photons = 512
#define SHAH2007                                                                                   \
  .called = "the published method", .own_passes = true, .lamp = true, .directional = true,         \
  .mirrors = true, .materials = true, .estimates = true, .low_pass = true, .pixel = "vertex",      \
  .fills = 1 << ABBE_FILL_NONE, .fill = ABBE_FILL_NONE, .photons = 128, .map_size = 768
#define WYMAN2006                                                                                  \
  .called = "the published method", .own_passes = true, .lamp = true, .mirrors = true,             \
  .materials = true, .estimates = true, .draws_photons = true, .history = true, .pixel = "photon", \
  .fills = DRAWS, .fill = ABBE_FILL_GATHER_LIGHT, .photons = 1024, .map_size = 512
#define WHOLE_LIGHT .mirrors = true, .materials = true, .fills = BRIDGES, .fill = ABBE_FILL_BRIDGE

static const char in_units[] = "the same in units";

static const abbe_method_facts facts[ABBE_PROFILE_COUNT] = {
    [ABBE_PROFILE_DEFAULT] = {.says =
                                  "Abbe's own: adaptive photons, splats by footprint, exact areas",
                              WHOLE_LIGHT,
                              .reflects_spectra = true,
                              .presets = true,
                              .history = true},
    [ABBE_PROFILE_THESIS] = {.says = "adaptive spectral maps with a 20-step fill, as printed",
                             THESIS,
                             .printed = true,
                             .max_nm = 680},
    [ABBE_PROFILE_THESIS_CIE] = {.says = in_units, THESIS},
    [ABBE_PROFILE_SHAH2007] = {.says = "caustics mapping: vertices splatted into the light's map",
                               SHAH2007,
                               .printed = true,
                               .wavelengths = 3, /* blue, green and red */
                               .min_nm = 450,
                               .max_nm = 650,
                               .estimator = ABBE_ESTIMATOR_SHAH},
    [ABBE_PROFILE_SHAH2007_CIE] = {.says = in_units, SHAH2007, .estimator = ABBE_ESTIMATOR_RATIO},
    [ABBE_PROFILE_WYMAN2006] = {.says = "photons in image space: points, polygons or gathers",
                                WYMAN2006,
                                .printed = true,
                                .wavelengths = 1,
                                .min_nm = 450,
                                .max_nm = 650,
                                .direction = ABBE_DIRECTION_MEAN,
                                .estimator = ABBE_ESTIMATOR_SHAH},
    [ABBE_PROFILE_WYMAN2006_CIE] = {.says = in_units,
                                    WYMAN2006,
                                    .direction = ABBE_DIRECTION_DIRECT,
                                    .estimator = ABBE_ESTIMATOR_RATIO},
    [ABBE_PROFILE_WYMAN2003] =
        {.says = "caustics looked up in a printed volume (--volume, abbe volume)",
         WHOLE_LIGHT,
         .printed_volume = true},
    [ABBE_PROFILE_WAND2003] = {.says = "surroundings through samples of mirrors as pinholes",
                               .called = "the published method",
                               .own_passes = true,
                               .surroundings = true,
                               .mirrors = true,
                               .materials = true,
                               .fills = 1 << ABBE_FILL_NONE,
                               .fill = ABBE_FILL_NONE}};

const abbe_method_facts *abbe_method_of(abbe_profile profile) {
  return &facts[(unsigned)profile < ABBE_PROFILE_COUNT ? profile : ABBE_PROFILE_DEFAULT];
}

#define NAME_OF(code, name) name,
const char *abbe_profile_name(abbe_profile profile) {
  static const char *const names[] = {ABBE_PROFILES(NAME_OF)};
  return (int)profile >= 0 && profile < ABBE_PROFILE_COUNT ? names[profile] : "unknown";
}

const char *abbe_fill_name(abbe_fill fill) {
  static const char *const names[] = {ABBE_FILLS(NAME_OF)};
  return (int)fill >= 0 && fill < ABBE_FILL_COUNT ? names[fill] : "unknown";
}

const char *abbe_transport_name(abbe_transport transport) {
  static const char *const names[] = {ABBE_TRANSPORTS(NAME_OF)};
  return (int)transport >= 0 && transport < ABBE_TRANSPORT_COUNT ? names[transport] : "unknown";
}
#undef NAME_OF
