/* tracer.h: the reference: what light does in a scene, with error bars.
 *
 * Every path has its own wavelength. Photons go from the lights through refractors to receivers;
 * they make the receiver map, and the caustics that the camera sees straight (both unbiased). Paths
 * from the camera see direct light, mirror images and what shows through glass (unbiased), and
 * there caustics from the photons around (consistent: the bias shrinks as passes are added). A
 * receiver is lit by lights straight and through refractors, and by the scene's ambient light,
 * which stands for light between receivers. Work is done in passes that are independent of each
 * other, so that their spread gives standard errors; same seed and settings, same result, on any
 * number of threads. It uses nothing of the renderer.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_TRACER_H
#define ABBE_VALIDATION_TRACE_TRACER_TRACER_H

#include "base/error.h"
#include "colorimetry/image/image.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"
#include "validation/trace/transport/physics.h"
#include "validation/trace/walks/light_walk.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_TRACER_MAX_SIDE 8192
#define ABBE_TRACER_FAINTEST 0x1p-44
#define ABBE_TRACER_MAX_PHOTONS 67108864u /* a pass */
#define ABBE_TRACER_MAX_THREADS 256

/* Whether paths carry the light's polarisation, by which the scene's polarisers count. */
typedef enum abbe_trace_polarisation {
  ABBE_TRACE_POLARISATION_AUTO, /* with a polariser or crystals in line, in full physics */
  ABBE_TRACE_POLARISATION_ON,
  ABBE_TRACE_POLARISATION_OFF /* polarisers are left out, and so is their dimming */
} abbe_trace_polarisation;

/* A request; zero means the default in every field. */
typedef struct abbe_trace_desc {
  abbe_physics physics; /* `polarised` is found by the next */
  abbe_trace_polarisation polarisation;
  bool no_picture, no_map;       /* leave one of the two out */
  bool guides;                   /* layers of the picture that a filter needs, too */
  size_t width, height;          /* pixels; 0: the scene's */
  size_t map_width, map_height;  /* texels of the receiver map; 0: 512 */
  size_t map_light;              /* whose light it holds */
  const abbe_map_layout *layout; /* NULL: fitted to where the light falls */
  double min_nm, max_nm;         /* 0: 380, 780 */
  size_t bands;                  /* number of bands of the spectral output; 0: none */
  abbe_rgb_space space;          /* space of the picture */
  abbe_observer observer;        /* whose XYZ its colours and the map's are */
  size_t photons;                /* a pass; 0: 2^20, or four a pixel where that is more */
  /* Where all is one pixel of a larger picture: how many pixels that one has, and how many a side
   * this one. Photons are followed and gathered as for that one. 0: it is a picture of its own. */
  size_t whole_pixels, pixel_sides;
  uint32_t seed;
  size_t threads; /* 0: all cores */
  /* Other than 0: the tracer's making, or the reading of what it has traced, ends soon with
   * ABBE_CANCELLED. It lives as long as the tracer. May be NULL. */
  const volatile int *stop;
} abbe_trace_desc;

typedef struct abbe_tracer abbe_tracer;

typedef struct abbe_trace_statistics {
  size_t passes;
  uint64_t photons; /* emitted */
  uint64_t light_rays, eye_rays;
  double light_seconds, eye_seconds; /* wall time of the two parts; this run only */
  abbe_light_ledger ledger;          /* W, mean over passes */
  uint64_t cuts;                     /* contributions too large to be kept whole */
  double radius;                     /* m, of the last gather; 0: none */
  double faintest; /* for a picture: the brightness of the dimmest of the scene's lights that is not
                      dark, relative to the brightest's; below ABBE_TRACER_FAINTEST its light may be
                      lost in the sums */
} abbe_trace_statistics;

/* ABBE_INVALID_ARGUMENT for a request outside the limits, ABBE_OUT_OF_RANGE for an index that is
 * not known over the range, ABBE_UNSUPPORTED, ABBE_NO_MEMORY. The scene outlives the tracer. */
abbe_result abbe_tracer_make(const abbe_scene *scene, const abbe_trace_desc *desc,
                             abbe_tracer **out, abbe_error *error);
void abbe_tracer_free(abbe_tracer *tracer);
ABBE_HOLDS(abbe_tracer)

/* Traces one pass: one sample a pixel, more where glass shows, and the photons of a pass. *stop
 * (may be NULL) ends it early with ABBE_CANCELLED, the pass forgotten. */
abbe_result abbe_tracer_pass(abbe_tracer *tracer, const volatile int *stop, abbe_error *error);

/* The first pass is to be of that number, and each is `step` behind the one before: what is done of
 * the others elsewhere can be put together with it (abbe_checkpoint_merge). Of a
 * tracer without a pass; ABBE_INVALID_ARGUMENT else, for a step of 0, and from 2^20 on. */
abbe_result abbe_tracer_begin_at(abbe_tracer *tracer, size_t pass, size_t step, abbe_error *error);

/* How many are in the sums, the number of the first of them, and from one to the next. */
size_t abbe_tracer_passes(const abbe_tracer *tracer);
size_t abbe_tracer_first_pass(const abbe_tracer *tracer);
size_t abbe_tracer_step(const abbe_tracer *tracer);
/* Relative standard error of picture and map together: root mean square of the standard errors
 * over the mean, of Y or luminance, the larger of the two; infinite before two passes. Of the map:
 * over the brightest texels that hold 95 % of its light. */
double abbe_tracer_error(const abbe_tracer *tracer);

/* Means so far and, after two passes and more, their standard errors. Picture: R, G, B (X, Y, Z in
 * that space), stderr.R …, caustic.R … (the part that came to its receiver through a refractor),
 * then the bands S0.…nm and stderr.S0.…nm. With guides, after two passes and more: photons.R … (the
 * caustic that the camera sees straight), eye.R … (all else), albedo.R …, normal.X …, depth.Z in m
 * (abbe_eye_sample), stderr. of each, and covariance.photons.RG …, covariance.eye.RG … of the
 * means. Map: X, Y, Z, flux a texel in W, stderr.X …, bands in W/nm. Both carry what the run was as
 * attributes. ABBE_INVALID_ARGUMENT where the request left it out. */
abbe_result abbe_tracer_picture(const abbe_tracer *tracer, abbe_image *out, abbe_error *error);
abbe_result abbe_tracer_map(const abbe_tracer *tracer, abbe_image *out, abbe_error *error);

void abbe_tracer_statistics(const abbe_tracer *tracer, abbe_trace_statistics *out);

/* Rays a second of one thread's photon walk, and of Embree alone on the very same packets of rays,
 * those that test what is hidden from a light among them; traces a part of a pass that is not
 * counted. */
abbe_result abbe_tracer_rates(abbe_tracer *tracer, double *walk, double *embree, abbe_error *error);

#endif
