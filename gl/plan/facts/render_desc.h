/* render_desc.h: what a caller requests of the renderer: the request, its limits, defaults and
 * names.
 *
 * It knows no scene: what a request leaves open and only a scene decides is the plan's. */
#ifndef ABBE_GL_PLAN_FACTS_RENDER_DESC_H
#define ABBE_GL_PLAN_FACTS_RENDER_DESC_H

#include "base/error.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "gl/methods/facts/method_facts.h"
#include "scenes/samples/surface_samples.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

/* How light is followed through refractors. AUTO: by the scene; the others require one model for
 * all refractors. */
#define ABBE_MODELS(X)                                                                             \
  X(AUTO, "auto")                                                                                  \
  X(SPHERE, "sphere") X(CONVEX, "convex") X(LAYERS, "layers") X(BVH, "hierarchy")
typedef enum abbe_model {
#define ABBE_MODEL_ENUM(code, name) ABBE_MODEL_##code,
  ABBE_MODELS(ABBE_MODEL_ENUM)
#undef ABBE_MODEL_ENUM
      ABBE_MODEL_COUNT
} abbe_model;

/* For pictures of what moves, and for whose sake they are coarser: nobody's, the camera's, or
 * light's too. Views of refractors, which show what each holds of them and, by layers, what is
 * behind, are drawn of fewer triangles where meshes have many. The camera takes fewer wavelengths
 * of a pixel, and its paths end after ABBE_COARSE_EXITS exits or below ABBE_COARSE_SHARE of their
 * light. Beams of refracted light in haze are left out, but for those in media that have a grid of
 * it. Programs are the same for any `upsample`, so that pictures of more or fewer samples follow
 * each other without a pause. */
typedef enum abbe_coarse { ABBE_COARSE_NONE, ABBE_COARSE_EYE, ABBE_COARSE_ALL } abbe_coarse;
#define ABBE_COARSE_EXITS 8
#define ABBE_COARSE_SHARE 0.05
#define ABBE_COARSE_MESH_SHARE 0.1 /* that where refractors are followed in turn */

#define ABBE_RENDER_MAX_SIDE 8192
#define ABBE_RENDER_MAX_PHOTONS 4096 /* a side */
#define ABBE_RENDER_MAX_MAP 4096     /* a side */
#define ABBE_RENDER_MAX_WAVELENGTHS 1000
#define ABBE_RENDER_MAX_EXITS 32
#define ABBE_RENDER_MAX_ADAPTIVE 8 /* a side */
#define ABBE_RENDER_MAX_ENVIRONMENT_LIGHTS 16
#define ABBE_RENDER_MAX_LIGHT_POINTS 16
#define ABBE_RENDER_MAX_CLUSTERS 1000000
#define ABBE_RENDER_MAX_HISTORY 4 /* frames */
#define ABBE_RENDER_MAX_LENS 4096
#define ABBE_RENDER_MAX_LOW_PASS 32 /* texels */
#define ABBE_RENDER_CUBE_FACES 6

/* Called now and then with the share done, 0 to 1; false stops the work with ABBE_CANCELLED. */
typedef bool (*abbe_render_progress)(void *user, double done);

/* What a request of the default profile leaves open, where a scene disperses. */
#define ABBE_PLAN_WAVELENGTHS 7
#define ABBE_PLAN_PHOTONS 256
#define ABBE_PLAN_MAP 1024
#define ABBE_PLAN_SAMPLES 2
#define ABBE_PLAN_ADAPTIVE 4
#define ABBE_PLAN_LENS 16
#define ABBE_PLAN_ENVIRONMENT_LIGHTS 4
#define ABBE_PLAN_LIGHT_POINTS 8
#define ABBE_PLAN_PINHOLES 256
#define ABBE_PLAN_CLUSTERS 50
/* Exits that are followed at the most, and the share of its light below which a path ends, where
 * the request leaves them open. */
#define ABBE_PLAN_EXITS 8
#define ABBE_PLAN_LAYER_EXITS 4 /* where refractors are known by layers alone */
#define ABBE_PLAN_SHARE 0.01
/* As far as they go where a convex solid keeps light inside (gl/plan/examine/examine.h). */
#define ABBE_PLAN_MOST_EXITS 24
#define ABBE_PLAN_LOW_SHARE 0.005
/* Exits of the camera's rays through exact surfaces, the share of one solid alone; what light is
 * left inside then is too little to show. */
#define ABBE_PLAN_EYE_EXITS 256
#define ABBE_PLAN_EYE_SHARE 0.005
/* The same beside a mirror: below the 4 % that glass reflects, which mirrors show. */
#define ABBE_PLAN_MIRROR_SHARE 0.03

/* A request; zero means the default in every field. */
typedef struct abbe_render_desc {
  abbe_profile profile;
  size_t width, height; /* pixels; 0: the scene's */
  /* samples at the most; 0: 7, or 1 where neither index nor attenuation varies */
  size_t wavelengths;
  double min_nm, max_nm; /* 0: 380, 780 (thesis: its nodes are 380 to 680) */
  size_t
      photons; /* side of the photon grid; 0: 256 (thesis: 512, shah2007: 128, wyman2006: 1024) */
  size_t map_size;    /* side of the spectral map; 0: 1024 (shah2007: 768, wyman2006: 512) */
  size_t supersample; /* 1 to 4 samples a pixel side; 0: 2 (thesis, and with upsample: 1) */
  size_t upsample;    /* or 1 to 4 pixels a sample side, and between samples; 0: 1 */
  abbe_coarse coarse;
  /* rays a side for a sample of a receiver where its light bends, 1 to 8; 1: the sample alone; 0: 4
   * (thesis, and with upsample: 1) */
  size_t adaptive;
  /* samples of receivers a pixel side: as supersample, or 1 at a pixel's middle, refractors before
   * it having all of theirs; 0: 1 in a volume with adaptive rays, whose frames follow one another,
   * else as supersample */
  size_t receiver_samples;
  /* lights that stand for an environment on receivers and through refractors, 1 to 16; 0: 4 */
  size_t environment_lights;
  size_t light_points; /* that stand for a light with a size, 1 to 16; 0: 8 */
  abbe_fill fill;
  abbe_model model;
  /* For shah2007 and wyman2006: how rays are brought to receivers, AUTO: shah, in the profiles in
   * units ratio; iterations, 1 to 64, 0: 1; interfaces that light is refracted at, 1 (as by water)
   * or 2, 0: 2. Elsewhere 0. */
  abbe_estimator estimator;
  size_t iterations, interfaces;
  size_t faces; /* for shah2007 and wyman2006: views of the light, 1, or the 6 of a cube around it;
                   0: 6 where one does not hold a point light's surroundings, 1 for a gather in the
                   light's image */
  size_t low_pass; /* for shah2007: standard deviation of the filter over its map, texels, 0 (none)
                      to 32 */
  /* For the transport by pinholes alone: samples of all surfaces together, at most
   * ABBE_SURFACE_MAX_SAMPLES, 0: 256. */
  size_t pinholes;
  /* and, of the default profile: the least number of clusters of samples that make a hemisphere's
   * light, 1 to ABBE_RENDER_MAX_CLUSTERS, with which there are none; 0: 50. A texel amid others is
   * taken from these where they are off a line by one cluster's light at the most. */
  size_t clusters;
  abbe_footprint footprint;
  abbe_direction direction; /* for wyman2006; in its profile in units direct alone */
  unsigned polygons;        /* for wyman2006's quads and triangles: bits of ABBE_POLYGONS */
  /* Frames that a picture holds, 1 to 4, 0: 1; of the default profile and wyman2006's gathers. A
   * renderer that is changed or redrawn goes on with the frames before, so that a picture is no
   * longer that of a renderer made anew; in units the photons of each frame are shifted. The
   * default profile takes a still scene's next frames until the picture is the mean of so many, and
   * where the scene has changed since no texel of its map leaves what this frame has around it. */
  size_t history;
  /* Not so: light that stays is drawn once, and next frames of it come where it has changed. */
  bool history_of_changes;
  abbe_transport transport;
  /* The volume of the transport 'volume', which outlives it; for the profile wyman2003 a printed
   * one. lookup AUTO: abbe_caustic_volume_resolve; wyman2003: turned. */
  const abbe_caustic_volume *volume;
  abbe_volume_lookup lookup;
  /* paths below this share of their light end; 0: 0.01, or 0.005 where paths that end leave too
   * much light inside a convex solid */
  double energy_share;
  /* exits followed at the most; 0: as many as carry energy, at most 8, or up to 24 where a convex
   * solid keeps light inside (4 where layers are all that is known of refractors) */
  size_t exits;
  abbe_rgb_space space; /* space of the picture */
  /* whose XYZ the picture's colours are; that of 1931 for methods that are printed with their own
   * colours */
  abbe_observer observer;
  /* Layout of one light's map, and which light's; it lives as long as the plan. NULL: each map is
   * fitted to where its light lands. */
  const abbe_map_layout *map_layout;
  size_t map_layout_light;
  /* Shifts of the photon grid in cells and of the camera's samples in their distance, x and y, -0.5
   * to 0.5: other pictures that the same request could have given (gl/accuracy/error_bars.h).
   * Pinholes are other ones for each shift of the grid. */
  double photon_shift[2], sample_shift[2];
  /* Places on the pupil of a camera with an aperture whose pictures abbe_renderer_read_blurred
   * takes the mean of, 1 to ABBE_RENDER_MAX_LENS, 0: 16; and the one that a frame is seen from, in
   * the pupil's radii to the right and up: 0, 0 is its middle. lens_turn: above 0, the frame's
   * number among four or a multiple of four, whose samples share the spectrum and a crystal's waves
   * as a pixel's do. */
  size_t lens;
  double lens_place[2];
  size_t lens_turn;
  bool everything;               /* all on, to measure what the plan saves (gl/plan/plan.h) */
  bool aovs;                     /* keep direct and caustic light of the receivers apart as well */
  abbe_render_progress progress; /* while the renderer is made: photons are traced once to fit */
  void *progress_user;
  /* Called once, with progress_user, when the driver compiles shaders that it does not know: it
   * takes seconds, the first time on a machine. May be NULL. */
  void (*compiling)(void *user);
  /* Then a second thread compiles what the camera's passes need, beside the light's. The scene has
   * to live until the first frame has ended or the renderer is freed. It serves where a processor
   * runs the shaders, and elsewhere does nothing. */
  bool compiles_beside;
  /* What that thread draws: of the light, maps that hold nothing, with tiles or without. */
  bool camera_alone, camera_tiles;
} abbe_render_desc;

/* Wavelengths that the camera takes of a pixel at the most, of a request that is resolved: of a
 * coarse one 7, or 4 where a sample stands for 3 x 3 pixels or more. */
size_t abbe_render_desc_eye_wavelengths(const abbe_render_desc *desc);

/* A resolved request, by the transport of pinholes from now on. */
void abbe_render_desc_take_pinholes(abbe_render_desc *desc);

/* The request with its defaults filled in, for a picture of width x height pixels unless it says
 * otherwise; what the scene decides stays 0: wavelengths and exits. desc may be NULL.
 * ABBE_INVALID_ARGUMENT, with a sentence, for what is outside the limits above. */
abbe_result abbe_render_desc_resolve(const abbe_render_desc *desc, size_t width, size_t height,
                                     abbe_render_desc *out, abbe_error *error);

/* Whether it is wyman2006 whose photons go to the light's image, and not to the camera's. */
bool abbe_render_desc_in_light(const abbe_render_desc *desc);

const char *abbe_model_name(abbe_model model);

/* The table of a request's settings: one row each, with its names, kind, limits,
 * default and help. The program's options, the library's keys and the checks of a request come from
 * it. A setting that is a pair or a list (size, range, polygons) or a file is its reader's own. */

typedef enum abbe_render_setting_kind {
  ABBE_SETTING_COUNT,  /* size_t */
  ABBE_SETTING_NUMBER, /* double */
  ABBE_SETTING_FLAG,   /* bool */
  ABBE_SETTING_CHOICE  /* an enum, the number of one of the names */
} abbe_render_setting_kind;

typedef struct abbe_render_setting {
  const char *key;    /* the library's */
  const char *option; /* the program's, without "--"; NULL: it has none of its own */
  abbe_render_setting_kind kind;
  size_t offset;        /* in abbe_render_desc */
  double least, most;   /* limits of a count or number; a request may have 0: the default */
  bool stays_open;      /* a request that is resolved may still have 0: the scene decides */
  bool aside;           /* seldom wanted, or of methods alone: shown by 'abbe methods --help' */
  const char *what;     /* in sentences; NULL: its reader checks it */
  const char *default_; /* default of the option, as its help shows it; NULL: none */
  const char *help;     /* help of the option */
  const char *const *names;
  size_t name_count;
} abbe_render_setting;

extern const abbe_render_setting abbe_render_settings[];
extern const size_t abbe_render_settings_count;

/* Where a request holds it: a size_t, double, bool or int by its kind. */
void *abbe_render_setting_in(const abbe_render_setting *setting, abbe_render_desc *desc);

#endif
