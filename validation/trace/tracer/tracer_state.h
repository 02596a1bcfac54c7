/* tracer_state.h: the insides of a tracer, for the files of this folder alone.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_TRACER_STATE_H
#define ABBE_VALIDATION_TRACE_TRACER_TRACER_STATE_H

#include "validation/trace/medium/glow.h"
#include "validation/trace/medium/haze_grid.h"
#include "validation/trace/tracer/accumulator.h"
#include "validation/trace/tracer/tracer.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/walks/camera.h"
#include "validation/trace/walks/eye_walk.h"
#include "validation/trace/walks/photon.h"
#include "validation/trace/walks/projection_map.h"

#include <stdbool.h>

/* Photons in participating media: each segment of a path is scattered at one
 * place of it, which the camera may see.
 *
 * A place that the camera sees straight, in the medium that the camera is in, adds to its pixel at
 * once, unbiased; nearer than a distance it does not, where few would add much. All are kept for
 * gathers along paths of the camera. The path goes on with what is left of it, whatever happened
 * here. In a refractor whose haze scatters more than once paths of the camera are turned too, and
 * find all light but that of lights without size at its first turn, where its first interface was
 * not a rough face.
 *
 * What a refractor absorbs to glow near its faces is kept once more behind each of them, as mirrors
 * show it: a gather that a face cuts finds as much as one inside. Glow that is even is so up to
 * flat faces and right-angled edges. */

enum { ABBE_SHAFT_LANES = 16 };

/* On its way to the camera. */
typedef struct abbe_shaft_splat {
  size_t pixel;
  uint32_t step;
  bool glows;  /* it is of the glow of something */
  float value; /* radiance that the pixel's mean gains */
} abbe_shaft_splat;

/* Photons of one light and one thread. What is above `add` is given; the rest starts zeroed. */
typedef struct abbe_shaft_photons {
  const abbe_geometry *geometry;
  const abbe_media *media;
  const abbe_trace_camera *camera;
  int eye_medium; /* refractor that the camera is in, or -1 */
  float near;     /* frame: no nearer to the camera are places splatted */
  float radius;   /* frame: of the pass's gathers */
  uint32_t pass, seed;
  uint32_t colour, glow; /* colour of the light's first step, and of its glow's */
  bool found;            /* paths of the camera meet the light by themselves: it has a size */
  void (*add)(void *user, const abbe_shaft_splat *splat);
  void *user;
  struct RTCRay16 packet; /* to the camera, of splats that wait */
  abbe_shaft_splat splat[ABBE_SHAFT_LANES];
  size_t waiting;
  uint64_t rays;
  size_t count, room;
  abbe_haze_photon *photon; /* [count] owned */
  bool full;                /* there was no memory for another */
} abbe_shaft_photons;

/* A watcher of light walks (abbe_light_walk_watch); user: an abbe_shaft_photons. */
void abbe_shaft_photons_take(void *user, const abbe_light_stretch *stretch);
/* Splats that wait are traced and added. */
void abbe_shaft_photons_flush(abbe_shaft_photons *photons);
void abbe_shaft_photons_free(abbe_shaft_photons *photons);

/* What a filter of the picture reads, summed over passes: the photons' part and the camera's apart,
 * how their noise goes together in colour, and what shows where.
 * */

/* Values of a pixel. The last ones are products, whose sums give covariances. */
enum {
  ABBE_GUIDE_PHOTONS = 0, /* R, G, B of the caustic that the camera sees straight */
  ABBE_GUIDE_EYE = 3,     /* R, G, B of all that paths from the camera bring */
  ABBE_GUIDE_ALBEDO = 6,
  ABBE_GUIDE_NORMAL = 9,
  ABBE_GUIDE_DEPTH = 12,
  ABBE_GUIDE_MEANS = 13,
  ABBE_GUIDE_SQUARES = 13,  /* squares of each mean; of two digits, as the products are */
  ABBE_GUIDE_PRODUCTS = 39, /* RG, RB, GB of the photons, then of the camera */
  ABBE_GUIDE_VALUES = 51
};

/* A zeroed one is of no pixels. */
typedef struct abbe_guide_sums {
  size_t pixels;
  double unit;         /* unit of the colours: the picture's sums' */
  float *adding;       /* [pixels][10] the pass that is in progress, but for the photons */
  abbe_whole_sum *sum; /* [pixels][ABBE_GUIDE_VALUES] over passes, in units (accumulator.h) */
} abbe_guide_sums;

/* picture_unit: abbe_accumulator's of the picture. */
abbe_result abbe_guide_sums_make(size_t pixels, double picture_unit, abbe_guide_sums *out,
                                 abbe_error *error);
void abbe_guide_sums_free(abbe_guide_sums *g);

/* The pass's sample of a pixel, whose colour is rgb; what is not finite counts as nothing. */
void abbe_guide_sums_set(abbe_guide_sums *g, size_t pixel, const float rgb[3],
                         const abbe_eye_sample *sample);
/* Adds the pass, before it ends in the picture's sums, which have `channels` values a pixel and
 * begin with R, G, B: what is not the camera's there is the photons'. */
void abbe_guide_sums_end_pass(abbe_guide_sums *g, const abbe_accumulator *picture, size_t channels);

/* A mean over so many passes. */
double abbe_guide_sums_mean(const abbe_guide_sums *g, size_t passes, size_t pixel, size_t mean);
/* A mean's square of standard error over so many passes, at least two, and the covariance by
 * product 0 to 5. */
double abbe_guide_sums_variance(const abbe_guide_sums *g, size_t passes, size_t pixel, size_t mean);
double abbe_guide_sums_covariance(const abbe_guide_sums *g, size_t passes, size_t pixel,
                                  size_t product);

/* Parts of a ledger. */
enum { ABBE_TRACER_LEDGER = sizeof(abbe_light_ledger) / sizeof(double) };
enum { ABBE_TRACER_RGB = 0, ABBE_TRACER_CAUSTIC = 3, ABBE_TRACER_BANDS = 6 };

struct abbe_tracer {
  abbe_trace_desc desc; /* every field resolved */
  const abbe_scene *scene;
  abbe_scene dimmed; /* the scene with its polarisers' lights dimmed, where that is another */
  float passes;      /* what the camera's polariser passes of unpolarised light; 1: there is none */
  abbe_geometry geometry;
  abbe_spectral_sampling sampling;
  double brightest; /* Y of a watt, at the most */
  abbe_media media;
  abbe_glow glow;
  abbe_mirrors mirrors;
  abbe_bands bands;
  abbe_reflectance reflectance;
  abbe_environment_light environment; /* its number as a light is the scene's light_count */
  abbe_trace_camera camera;
  abbe_map_layout layout;
  abbe_rgb_space mixing;           /* light is added up in the picture's space, in ACEScg for XYZ */
  float to_xyz[9];                 /* from there, for XYZ pictures; row-major */
  float (*colour)[3], (*white)[3]; /* in that space */
  abbe_projection_map *projection; /* [sampling.lights] */
  size_t *photons;                 /* [sampling.lights] a pass */
  double photon_rays;              /* of them all, as far as a trial shows */
  unsigned *splits;                /* [sampling.lights] interfaces at which its paths are split */
  abbe_light_walk **walk;          /* [threads] */
  abbe_accumulator picture, map;
  abbe_guide_sums guides;
  size_t picture_channels, map_channels; /* a pixel, a texel */
  abbe_eye_walk eye;
  uint8_t *samples; /* [pixels] of the camera's, a pass; NULL: no glass to see */
  abbe_photon_grid grid;
  abbe_grid_photon *landed; /* hits of the pass that runs, where the camera needs them */
  size_t landed_room;
  abbe_haze_grid shafts;
  abbe_haze_photon *shaft; /* [shaft_count] of the pass, that haze scatters */
  size_t shaft_count;
  float shaft_radius;       /* radius of the first gather in a medium, frame */
  bool stopped;             /* a pass, midway: its sums are cleared before the next */
  bool eye_gathers;         /* some pixel may show a receiver through or in a refractor */
  float radius;             /* radius of the first gather, frame */
  size_t first, pass, step; /* the first in the sums, the next one, and from one to the next */
  size_t whole;             /* passes of all parts together, as far as they were requested; or 0 */
  double reach;             /* W that photons stand for, at the scale of the ledger's units */
  abbe_whole_sum ledger[ABBE_TRACER_LEDGER]; /* over passes */
  uint64_t other_rays; /* rays of the walks: trials, and from before a checkpoint was taken up */
  abbe_trace_statistics statistics; /* its ledger: of the pass that is in progress */
};

/* Whether nobody has requested an end of what is made of it. */
static inline bool abbe_tracer_is_wanted(const abbe_tracer *t) {
  return t->desc.stop == NULL || *t->desc.stop == 0;
}

static inline abbe_result abbe_tracer_check_wanted(const abbe_tracer *t, abbe_error *error) {
  return abbe_tracer_is_wanted(t) ? ABBE_OK : abbe_error_set(error, ABBE_CANCELLED, "stopped");
}

/* What files say of it. */
static inline const char *abbe_tracer_physics(const abbe_tracer *t) {
  return t->desc.physics.matched ? "matched" : t->desc.physics.polarised ? "polarised" : "full";
}

/* From the space of mixing to the picture's, through the camera's polariser. */
static inline void abbe_tracer_finish(const abbe_tracer *t, const float mixed[3], float out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = t->passes * (t->mixing == t->desc.space
                              ? mixed[k]
                              : t->to_xyz[3 * k] * mixed[0] + t->to_xyz[3 * k + 1] * mixed[1] +
                                    t->to_xyz[3 * k + 2] * mixed[2]);
}
/* The unit of the ledger's sums, W. */
static inline double abbe_tracer_ledger_unit(const abbe_tracer *t) {
  return (t->reach > 0 ? t->reach : 1) * t->brightest * 0x1p-50;
}
/* The light of that number; NULL: the environment. */
static inline const abbe_light *abbe_tracer_light(const abbe_tracer *t, size_t light) {
  return light < t->scene->light_count ? &t->scene->light[light] : NULL;
}
/* Whether a map is made of that light. */
static inline bool abbe_tracer_maps(const abbe_tracer *t, size_t light) {
  return !t->desc.no_map && light == t->desc.map_light;
}
/* Most hits of so many photons of the light. */
static inline size_t abbe_tracer_most_hits(const abbe_tracer *t, size_t light, size_t photons) {
  for (int k = 0; k < ABBE_PHOTON_SPLITS; k++) photons <<= t->splits[light] >> k & 1;
  return photons;
}

/* The layout of a receiver map for which none is given: as large as where a trial's photons land.
 * */

/* Fits a view from the map's light around where its light falls, into t->layout. */
abbe_result abbe_tracer_fit_layout(abbe_tracer *t, abbe_error *error);

/* The photons that a light sends to the refractors in one pass: how many each cell of
 * its projection map gets, and where, whereto and at which wavelength each of them starts. */

/* Cell after cell: cell i has the photons from first[i] on. */
typedef struct abbe_emission {
  const abbe_tracer *t;
  size_t light, count;
  uint32_t *first; /* [cells + 1] */
  uint32_t pass, seed;
} abbe_emission;

/* `count` photons of the light, shared out over the cells; none where it reaches no refractor. */
abbe_result abbe_emission_make(const abbe_tracer *t, size_t light, size_t count, uint32_t pass,
                               uint32_t seed, abbe_emission *e, abbe_error *error);
void abbe_emission_free(abbe_emission *e);

/* Photons [from, to), at most ABBE_LIGHT_WALK_BATCH of them; how many those are. */
size_t abbe_emission_batch(const abbe_emission *e, uint32_t from, uint32_t to, abbe_photon *photon);

/* Finds out whether paths are polarised; then lights and the picture are dimmed by polarisers, each
 * of which passes half. ABBE_INVALID_ARGUMENT with matched physics. */
abbe_result abbe_tracer_polarise(abbe_tracer *t, abbe_error *error);

/* Which passes a tracer holds, and what it has summed over them, as whole numbers
 * alone: so they can be written to a file, and added to those of other passes. */

typedef struct abbe_pass_counts {
  uint64_t first, end, step; /* passes first, first + step, ... below end */
  uint64_t whole;            /* passes that there are to be, of all parts; 0: not stated */
  uint64_t photons, light_rays, eye_rays, cuts;
} abbe_pass_counts;
/* Photons, rays and cuts of a pass, so that those of all passes there can be do not overflow. */
#define ABBE_PASS_COUNTS_MOST ((uint64_t)1 << 43)

/* Ledger; sums and squares of the picture; guides; sums and squares of the map. */
enum { ABBE_PASS_SUMS_PARTS = 6 };
typedef struct abbe_sum_span {
  abbe_whole_sum *sum;
  size_t count; /* may be 0 */
} abbe_sum_span;

void abbe_pass_sums_spans(abbe_tracer *tracer, abbe_sum_span out[ABBE_PASS_SUMS_PARTS]);

void abbe_pass_counts_get(const abbe_tracer *tracer, abbe_pass_counts *out);
void abbe_pass_counts_set(abbe_tracer *tracer, const abbe_pass_counts *counts);

/* Whether there are such passes: from 0 on, ascending, no more than there can be, of no more
 * photons, rays and cuts. */
bool abbe_pass_counts_hold(const abbe_pass_counts *counts);
size_t abbe_pass_counts_passes(const abbe_pass_counts *counts);

/* Whether so many passes can have summed that much; then sums of all passes there can be do not
 * overflow. */
bool abbe_pass_sums_hold(abbe_whole_sum sum, size_t passes);

/* No passes, and sums of 0. */
void abbe_pass_sums_clear(abbe_tracer *tracer);

#endif
