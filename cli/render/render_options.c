#include "cli/render/render_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/spectral_options.h"

#include "scenes/volume/volume_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  OPTION_PROFILE = 0x100,
  OPTION_SIZE,
  OPTION_WAVELENGTHS,
  OPTION_RANGE,
  OPTION_PHOTONS,
  OPTION_MAP,
  OPTION_SAMPLES,
  OPTION_UPSAMPLE,
  OPTION_ADAPTIVE,
  OPTION_ENVIRONMENT_LIGHTS,
  OPTION_LIGHT_POINTS,
  OPTION_MODEL,
  OPTION_FILL,
  OPTION_PINHOLES,
  OPTION_CLUSTERS,
  OPTION_STRATEGY,
  OPTION_FOOTPRINT,
  OPTION_DIRECTION,
  OPTION_POLYGONS,
  OPTION_HISTORY,
  OPTION_ESTIMATOR,
  OPTION_ITERATIONS,
  OPTION_INTERFACES,
  OPTION_FACES,
  OPTION_LOW_PASS,
  OPTION_SHARE,
  OPTION_EXITS,
  OPTION_SPACE,
  OPTION_OBSERVER,
  OPTION_TRANSPORT,
  OPTION_RECEIVER_SAMPLES,
  OPTION_VOLUME,
  OPTION_LOOKUP,
  OPTION_EVERYTHING,
  OPTION_MATERIALS
};

static const struct argp_option options[] = {
    {"profile", OPTION_PROFILE, "NAME", 0,
     "default; published methods, and each with CIE weights in W: thesis, thesis-cie, shah2007, "
     "shah2007-cie, wyman2006, wyman2006-cie; wyman2003, of volumes alone; wand2003",
     1},
    {"size", OPTION_SIZE, "WxH", 0, "pixels; the scene's own without", 1},
    {"wavelengths", OPTION_WAVELENGTHS, "N", 0,
     "samples of the spectrum that a photon takes at the most, 1 to 1000 (7)", 1},
    {"range", OPTION_RANGE, "FROM:TO", 0, "wavelengths in nm (380:780)", 1},
    {"photons", OPTION_PHOTONS, "N", 0, "side of the photon grid, 1 to 4096 (256)", 1},
    {"map", OPTION_MAP, "N", 0, "side of the spectral map, 1 to 4096 (1024)", 1},
    {"samples", OPTION_SAMPLES, "N", 0, "samples a pixel side, 1 to 4 (2; thesis 1)", 1},
    {"upsample", OPTION_UPSAMPLE, "N", 0,
     "or a sample for N x N pixels, 1 to 4, and between samples: a draft (1)", 1},
    {"adaptive", OPTION_ADAPTIVE, "N", 0,
     "N x N rays, 1 to 8, for a sample of a receiver where its light bends (4; thesis, and with "
     "--upsample, 1)",
     1},
    {"receiver-samples", OPTION_RECEIVER_SAMPLES, "N", 0,
     "samples of receivers a pixel side: as --samples, or 1 (as --samples; 1 of a volume with "
     "--adaptive above 1)",
     1},
    {"light-points", OPTION_LIGHT_POINTS, "N", 0,
     "points that stand for a light with a size, 1 to 16 in all (8)", 1},
    {"environment-lights", OPTION_ENVIRONMENT_LIGHTS, "N", 0,
     "directional lights that stand for what stands out of an environment, at most so many, 1 to "
     "16 "
     "(4)",
     1},
    {"model", OPTION_MODEL, "NAME", 0,
     "how light goes through refractors: sphere, convex, layers, hierarchy (auto: by the scene)",
     1},
    {"fill", OPTION_FILL, "NAME", 0,
     "gaps between wavelengths: bridge, none, smear (thesis); of wyman2006 between photons: "
     "points, "
     "quads, triangles, gather-eye, gather-light (gather-light)",
     1},
    {"pinholes", OPTION_PINHOLES, "N", 0,
     "of transport pinhole, samples of surfaces at the most, 1 to 4096 (256)", 1},
    {"clusters", OPTION_CLUSTERS, "N", 0,
     "of transport pinhole, samples are taken together where they send at most 1/N of a "
     "hemisphere's "
     "light, 1 to 1000000, which takes each by itself (50)",
     1},
    {"strategy", OPTION_STRATEGY, "NAME", 0,
     "of transport pinhole, how samples are spread: random, grid, quantized, neighbour (neighbour)",
     1},
    {"footprint", OPTION_FOOTPRINT, "NAME", 0,
     "of transport pinhole, whether a sample shows as much of the surroundings as it reflects by "
     "its curvature: on, off (on)",
     1},
    {"direction", OPTION_DIRECTION, "NAME", 0,
     "of wyman2006, by which caustics are shaded: own, mean, direct (mean)", 1},
    {"polygons", OPTION_POLYGONS, "LIST", 0,
     "of wyman2006's quads and triangles: even beams, light by corners, those between surfaces "
     "culled, drawn in-light, such as corners,culled (none)",
     1},
    {"history", OPTION_HISTORY, "N", 0,
     "frames that a picture holds, 1 to 4, of the default profile and wyman2006's gathers: with "
     "--frames (1)",
     1},
    {"estimator", OPTION_ESTIMATOR, "NAME", 0,
     "of shah2007 and wyman2006, how rays are brought to receivers: shah, axis, newton, secant, "
     "false-position, "
     "illinois, bisection, march, impostor, ratio, exact (shah; in their twins ratio)",
     1},
    {"iterations", OPTION_ITERATIONS, "N", 0, "of the estimator, 1 to 64 (1)", 1},
    {"interfaces", OPTION_INTERFACES, "N", 0,
     "of shah2007 and wyman2006, that refract light: 1, as of water, or 2 (2)", 1},
    {"faces", OPTION_FACES, "N", 0,
     "of shah2007 and wyman2006, views of the light: 1, or the 6 of a cube around it (6 where one "
     "does not hold what is around a point light)",
     1},
    {"low-pass", OPTION_LOW_PASS, "N", 0,
     "of shah2007, smooth its map by a Gaussian of N texels, 1 to 32 (none)", 1},
    {"share", OPTION_SHARE, "X", 0,
     "paths end below this share of their light (0.01; 0.005 in a gem)", 1},
    {"exits", OPTION_EXITS, "N", 0,
     "exits followed at the most, 1 to 32 (8; to 24 in a gem; 4 by layers)", 1},
    {"space", OPTION_SPACE, "NAME", 0, "of the picture: acescg, rec709, xyz (acescg)", 1},
    {"observer", OPTION_OBSERVER, "NAME", 0, ABBE_OBSERVER_HELP, 1},
    {"transport", OPTION_TRANSPORT, "NAME", 0,
     "of caustics: photons; volume, looked up in what abbe volume has made; or pinhole, photons of "
     "what stands out of surroundings and samples of mirrors and refractors for the rest (photons; "
     "of wand2003 pinhole)",
     1},
    {"volume", OPTION_VOLUME, "FILE.exr", ABBE_ARGUMENT_READS, "that they are looked up in", 1},
    {"lookup", OPTION_LOOKUP, "NAME", 0,
     "of light between the volume's nodes: nearest, blend, turn (blend; of a ball, and of "
     "wyman2003, turn)",
     1},
    {"everything", OPTION_EVERYTHING, NULL, 0,
     "switch on what no fact asks for, to measure what the plan saves", 1},
    {"materials", OPTION_MATERIALS, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1},
    ABBE_SCENE_INPUT_OPTIONS(1),
    ABBE_SCENE_INPUT_STUDIO_OPTIONS(1),
    ABBE_SCENE_INPUT_ALPHA_OPTION(1),
    {0}};

#define ABBE_NAME_OF_2(code, name) name,
#define ABBE_NAME_OF_3(code, name, ocio) name,
#define ABBE_BIT_OF(code, name, bit) bit,
static const char *const profiles[] = {ABBE_PROFILES(ABBE_NAME_OF_2)};
static const char *const models[] = {ABBE_MODELS(ABBE_NAME_OF_2)};
static const char *const estimators[] = {ABBE_ESTIMATORS(ABBE_NAME_OF_2)};
static const char *const strategies[] = {ABBE_SAMPLE_STRATEGIES(ABBE_NAME_OF_2)};
static const char *const footprints[] = {ABBE_FOOTPRINTS(ABBE_NAME_OF_2)};
static const char *const directions[] = {ABBE_DIRECTIONS(ABBE_NAME_OF_2)};
static const char *const fills[] = {ABBE_FILLS(ABBE_NAME_OF_2)};
static const char *const transports[] = {ABBE_TRANSPORTS(ABBE_NAME_OF_2)};
static const char *const lookups[] = {ABBE_VOLUME_LOOKUPS(ABBE_NAME_OF_2)};
static const char *const spaces[] = {ABBE_RGB_SPACES(ABBE_NAME_OF_3)};

/* A list of words, as bits. */
static unsigned read_polygons(const char *program, const char *text) {
  static const char *const names[] = {ABBE_POLYGONS(ABBE_NAME_OF_3)};
  static const unsigned bits[] = {ABBE_POLYGONS(ABBE_BIT_OF)};
  enum { COUNT = sizeof names / sizeof *names };
  unsigned all = 0;
  for (const char *at = text; at != NULL;) {
    const size_t length = strcspn(at, ",");
    char word[32];
    snprintf(word, sizeof word, "%.*s", (int)length, at);
    all |= bits[abbe_command_choice(program, "--polygons", word, names, COUNT)];
    at = at[length] == ',' ? at + length + 1 : NULL;
  }
  return all;
}

/* Of the transport by pinholes; false: the key is another's. */
static bool take_pinholes(int key, const char *text, const char *p, abbe_render_desc *d) {
  switch (key) {
  case OPTION_PINHOLES:
    d->pinholes = abbe_command_count(p, "--pinholes", text, 1, ABBE_SURFACE_MAX_SAMPLES);
    return true;
  case OPTION_CLUSTERS:
    d->clusters = abbe_command_count(p, "--clusters", text, 1, ABBE_RENDER_MAX_CLUSTERS);
    return true;
  case OPTION_STRATEGY:
    d->strategy = (abbe_sample_strategy)abbe_command_choice(p, "--strategy", text, strategies,
                                                            ABBE_SAMPLE_STRATEGY_COUNT);
    return true;
  case OPTION_FOOTPRINT:
    d->footprint = (abbe_footprint)abbe_command_choice(p, "--footprint", text, footprints,
                                                       ABBE_FOOTPRINT_COUNT);
    return true;
  default:
    return false;
  }
}

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_render_options *o = state->input;
  abbe_render_desc *d = &o->desc;
  const char *p = o->program;
  if (take_pinholes(key, text, p, d)) return 0;
  switch (key) {
  case OPTION_PROFILE:
    d->profile =
        (abbe_profile)abbe_command_choice(p, "--profile", text, profiles, ABBE_PROFILE_COUNT);
    return 0;
  case OPTION_SIZE:
    abbe_command_size(p, "--size", text, ABBE_RENDER_MAX_SIDE, &d->width, &d->height);
    return 0;
  case OPTION_WAVELENGTHS:
    d->wavelengths = abbe_command_count(p, "--wavelengths", text, 1, ABBE_RENDER_MAX_WAVELENGTHS);
    return 0;
  case OPTION_RANGE:
    abbe_command_range(p, "--range", text, &d->min_nm, &d->max_nm);
    return 0;
  case OPTION_PHOTONS:
    d->photons = abbe_command_count(p, "--photons", text, 1, ABBE_RENDER_MAX_PHOTONS);
    return 0;
  case OPTION_MAP:
    d->map_size = abbe_command_count(p, "--map", text, 1, ABBE_RENDER_MAX_MAP);
    return 0;
  case OPTION_SAMPLES:
    d->supersample = abbe_command_count(p, "--samples", text, 1, 4);
    return 0;
  case OPTION_UPSAMPLE:
    d->upsample = abbe_command_count(p, "--upsample", text, 1, 4);
    return 0;
  case OPTION_ADAPTIVE:
    d->adaptive = abbe_command_count(p, "--adaptive", text, 1, ABBE_RENDER_MAX_ADAPTIVE);
    return 0;
  case OPTION_RECEIVER_SAMPLES:
    d->receiver_samples = abbe_command_count(p, "--receiver-samples", text, 1, 4);
    return 0;
  case OPTION_ENVIRONMENT_LIGHTS:
    d->environment_lights =
        abbe_command_count(p, "--environment-lights", text, 1, ABBE_RENDER_MAX_ENVIRONMENT_LIGHTS);
    return 0;
  case OPTION_LIGHT_POINTS:
    d->light_points =
        abbe_command_count(p, "--light-points", text, 1, ABBE_RENDER_MAX_LIGHT_POINTS);
    return 0;
  case OPTION_MODEL:
    d->model = (abbe_model)abbe_command_choice(p, "--model", text, models, ABBE_MODEL_COUNT);
    return 0;
  case OPTION_FILL:
    d->fill = (abbe_fill)abbe_command_choice(p, "--fill", text, fills, ABBE_FILL_COUNT);
    return 0;
  case OPTION_DIRECTION:
    d->direction = (abbe_direction)abbe_command_choice(p, "--direction", text, directions,
                                                       ABBE_DIRECTION_COUNT);
    return 0;
  case OPTION_POLYGONS:
    d->polygons = read_polygons(p, text);
    return 0;
  case OPTION_HISTORY:
    d->history = abbe_command_count(p, "--history", text, 1, ABBE_RENDER_MAX_HISTORY);
    return 0;
  case OPTION_ESTIMATOR:
    d->estimator = (abbe_estimator)abbe_command_choice(p, "--estimator", text, estimators,
                                                       ABBE_ESTIMATOR_COUNT);
    return 0;
  case OPTION_ITERATIONS:
    d->iterations = abbe_command_count(p, "--iterations", text, 1, ABBE_ESTIMATOR_MAX_ITERATIONS);
    return 0;
  case OPTION_INTERFACES:
    d->interfaces = abbe_command_count(p, "--interfaces", text, 1, 2);
    return 0;
  case OPTION_FACES:
    d->faces = abbe_command_count(p, "--faces", text, 1, ABBE_RENDER_CUBE_FACES);
    return 0;
  case OPTION_LOW_PASS:
    d->low_pass = abbe_command_count(p, "--low-pass", text, 1, ABBE_RENDER_MAX_LOW_PASS);
    return 0;
  case OPTION_SHARE:
    d->energy_share = abbe_command_number(p, "--share", text, 1e-9, 1);
    return 0;
  case OPTION_EXITS:
    d->exits = abbe_command_count(p, "--exits", text, 1, ABBE_RENDER_MAX_EXITS);
    return 0;
  case OPTION_SPACE:
    d->space =
        (abbe_rgb_space)abbe_command_choice(p, "--space", text, spaces, ABBE_RGB_SPACE_COUNT);
    return 0;
  case OPTION_OBSERVER:
    d->observer = abbe_spectral_options_observer(p, text);
    return 0;
  case OPTION_TRANSPORT:
    d->transport = (abbe_transport)abbe_command_choice(p, "--transport", text, transports,
                                                       ABBE_TRANSPORT_COUNT);
    return 0;
  case OPTION_VOLUME:
    o->volume_path = text;
    return 0;
  case OPTION_LOOKUP:
    d->lookup = (abbe_volume_lookup)abbe_command_choice(p, "--lookup", text, lookups,
                                                        ABBE_VOLUME_LOOKUP_COUNT);
    return 0;
  case OPTION_EVERYTHING:
    d->everything = true;
    return 0;
  case OPTION_MATERIALS:
    o->materials = text;
    return 0;
  case ARGP_KEY_ARG:
    abbe_scene_input_take_file(&o->changes, &o->scene, text, state);
    return 0;
  case ARGP_KEY_END:
    if (o->scene == NULL)
      argp_error(
          state,
          "which scene? Give a file such as scenes/gem.yaml, or a stone's such as round.asc");
    return 0;
  default:
    return abbe_scene_input_take(&o->changes, key, text, p);
  }
}

const struct argp abbe_render_options_argp = {
    options, parse, "SCENE.yaml\nSTONE.asc...", NULL, NULL, NULL, NULL};

abbe_result abbe_render_options_load_volume(abbe_render_options *request, abbe_error *error) {
  if (request->volume_path == NULL) return ABBE_OK;
  const abbe_result result = abbe_volume_file_read(request->volume_path, &request->volume, error);
  if (result == ABBE_OK) request->desc.volume = &request->volume;
  return result;
}

int abbe_render_options_end(const abbe_render_options *request, bool scene_loaded,
                            abbe_result result, abbe_error *error) {
  int code = abbe_command_end(request->program, result, error);
  return scene_loaded && result == ABBE_INVALID_ARGUMENT ? ABBE_EXIT_USAGE : code;
}
