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
  X(derive, "derivatives by numbers of the scene: single rays, edges that move, a pane's colour")  \
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

#endif
