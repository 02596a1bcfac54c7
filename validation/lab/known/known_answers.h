/* known_answers.h: the tracer compared with optics that is known: a table, a row an answer.
 *
 * A row's exact half comes from closed_form.h or sphere_quadrature.h, its traced half from the
 * tracer's own geometry and interfaces: single rays followed by fixed choices (route.h), or whole
 * runs (tracer.h). It judges the tracer alone; pictures are compared by compare.h.
 *
 * Tolerances. Rays are followed in single precision: a direction or position is rounded to 6e-8 of
 * its size several times on a way through an object, so single rays may be off by some 1e-6, and
 * every row says what that means in its unit. Rows with a standard error may be off by four of it:
 * 1 in 16,000 honest rows is further off. They fail too where the standard error itself is too
 * large to tell right from wrong.
 */
#ifndef ABBE_VALIDATION_LAB_KNOWN_KNOWN_ANSWERS_H
#define ABBE_VALIDATION_LAB_KNOWN_KNOWN_ANSWERS_H

#include "base/error.h"
#include "base/maths.h"
#include "scenes/scene.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/walks/route.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* X(name, what is known): every group is `abbe_result abbe_known_NAME(run, error)`. */
#define ABBE_KNOWN_GROUPS(X)                                                                       \
  X(prism, "least deviation of 60-degree prisms at the lines F, d and C; diamond has none")        \
  X(slit, "the spectrum of a slit on a wall at 1 m, position against wavelength")                  \
  X(ball, "a ball lens: focal length, its chromatic shift, spherical aberration")                  \
  X(nest, "a bubble in a glass ball and a ball of water in glass: the later object is there")      \
  X(slab, "how far a plane-parallel slab moves a ray")                                             \
  X(fresnel, "reflectance of a face at five angles from both sides, and critical angles")          \
  X(film, "thin films on crown, diamond, topaz and in air: what they reflect and pass")            \
  X(crystal, "calcite: the angle between its rays, their indices, shares and doubled image")       \
  X(rainbow, "primary and secondary rainbows of water")                                            \
  X(rough, "rough faces of glass: what their first facet reflects and passes, and smooth ones")    \
  X(fluorescent, "what glows: photons by photon, slabs thin and thick from both sides, a ball")    \
  X(pane, "what slabs, of calcite too, reflect and pass with all inner reflections")               \
  X(polarised, "polarised light: sheets, piles of plates, metals, tourmaline, a furnace")          \
  X(absorption, "Beer-Lambert: what absorbing slabs let pass")                                     \
  X(furnace, "a white furnace: glass in the same light from everywhere cannot be seen")            \
  X(environment,                                                                                   \
    "light from all around: flux into bodies, irradiance of floors, mirrors and glass")            \
  X(mirror, "metals, a mirror ball's light, images between mirrors, a ring's caustics")            \
  X(water, "waves: where rays land, the focus under a crest, light on the bottom")                 \
  X(medium, "light scattered once in mist and water: slabs, a lamp, a shaft, what is left")        \
  X(lamp, "lights with a size: form factors, penumbras, images through a hole and in mirrors")     \
  X(sphere, "light under a sphere, rings and enclosed flux, one wavelength")                       \
  X(white, "light under a sphere in XYZ under D65")                                                \
  X(picture, "light under a sphere as the eye sees it: the caustic, and all light")                \
  X(derive, "derivatives of single rays by numbers of the scene: slabs, a prism, balls, mirrors")  \
  X(convergence, "the error falls as one over the square root of the samples")

#define ABBE_KNOWN_SIGMAS 4.0

typedef struct abbe_known_answer {
  const char *group, *unit, *reason; /* the reason of the tolerance; static texts */
  char quantity[112];
  double exact, traced;
  double standard_error; /* error of traced, in the unit; 0 where nothing is random */
  double error;          /* traced - exact */
  double tolerance;      /* largest |error| that passes, in the unit */
  double useful;         /* a tolerance beyond this is useless: the row fails; 0: any is useful */
  double photons;        /* that the row's error belongs to, for a chart of it; 0: it has none */
  bool passed;
} abbe_known_answer;

typedef struct abbe_known_answers {
  size_t count, room;
  abbe_known_answer *row; /* [count] */
} abbe_known_answers;

/* Zeroed: every group, samples as each group needs, all processors. */
typedef struct abbe_known_options {
  const char *only; /* a group's name, or NULL: all */
  uint64_t samples; /* paths of a row that is traced by many; 0: the group's own number */
  uint64_t seed;
  size_t threads;                            /* 0: one a processor */
  bool (*progress)(void *user, double done); /* false: stop, with ABBE_CANCELLED; may be NULL */
  void *user;
} abbe_known_options;

/* Computes the rows of the chosen groups. A row out of tolerance is no failure of this function:
 * see failed. ABBE_NOT_FOUND for an unknown group, with the nearest name. On failure *out is
 * zeroed. */
abbe_result abbe_known_answers_make(const abbe_known_options *options, abbe_known_answers *out,
                                    abbe_error *error);
void abbe_known_answers_free(abbe_known_answers *answers);

/* Rows that did not pass. */
size_t abbe_known_answers_failed(const abbe_known_answers *answers);

/* Names and descriptions of the groups, in order; NULL beyond the last. */
const char *abbe_known_answers_group(size_t index);
const char *abbe_known_answers_describe(size_t index);

/* The table of known answers as a picture: every row's error as a share of its tolerance, group by
 * group, and above it the error against the photons where it was measured. */

/* Writes a .png or .svg beside and renamed; errors as abbe_chart_write, and ABBE_INVALID_ARGUMENT
 * where there are no answers. */
abbe_result abbe_known_chart_write(const char *path, const abbe_known_answers *answers,
                                   abbe_error *error);

/* What the groups of known answers share: adding rows, small scenes written as text,
 * rays followed in them. */

#define ABBE_KNOWN_DEGREES (180 / ABBE_PI)

typedef struct abbe_known_run {
  const abbe_known_options *options;
  abbe_known_answers *out;
  const char *group;
  double from, to; /* the group's part of the whole work */
} abbe_known_run;

#define ABBE_KNOWN_DECLARE(name, what)                                                             \
  abbe_result abbe_known_##name(abbe_known_run *run, abbe_error *error);
ABBE_KNOWN_GROUPS(ABBE_KNOWN_DECLARE)
#undef ABBE_KNOWN_DECLARE

/* Adds a row: the caller gives quantity, unit, exact, traced, standard error, tolerance, what of it
 * is useful, and reason; error and verdict are computed (a traced value that is not finite fails).
 */
abbe_result abbe_known_add(abbe_known_run *run, abbe_known_answer row, abbe_error *error);

/* Says how much of the group is done, 0 to 1; ABBE_CANCELLED where the caller asked to stop. */
abbe_result abbe_known_progress(const abbe_known_run *run, double done, abbe_error *error);

/* A scene from text, printf-style. Materials are the default table's unless the text says else. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
abbe_result
abbe_known_scene(abbe_scene *out, abbe_error *error, const char *text, ...);

#define ABBE_KNOWN_ROOM 12 /* vertices of a ray */

/* A scene for single rays: its objects, and a camera and a light that play no part. */
typedef struct abbe_known_stage {
  abbe_scene scene;
  abbe_geometry geometry;
  abbe_route_vertex vertex[ABBE_KNOWN_ROOM]; /* [count]: of the ray followed last */
  size_t count;
} abbe_known_stage;

/* objects: entries of a scene file's list, printf-style; a receiver far below is added. Materials
 * are the default table's. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
abbe_result
abbe_known_stage_make(abbe_known_stage *stage, abbe_error *error, const char *objects, ...);
void abbe_known_stage_free(abbe_known_stage *stage);

/* Index of the stage's first object at lambda_nm. */
abbe_result abbe_known_stage_n(const abbe_known_stage *stage, double lambda_nm, double *n,
                               abbe_error *error);

/* Follows a ray; its vertices are in the stage. direction is scaled to length 1. */
abbe_result abbe_known_follow(abbe_known_stage *stage, const double from[3],
                              const double direction[3], double lambda_nm, const char *choices,
                              abbe_error *error);

/* Angle between two directions of any length, radians, exact for small ones. */
double abbe_known_angle(const double a[3], const double b[3]);

/* Where f(x, user) is least in [low, high], f with one minimum there; NaN from f ends the search
 * with NaN. */
typedef double (*abbe_known_function)(double x, void *user);
double abbe_known_least(abbe_known_function f, void *user, double low, double high);

#endif
