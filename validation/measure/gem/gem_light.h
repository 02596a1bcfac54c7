/* gem_light.h: the hemispheres of light that stones are judged under, and what each says of an
 * exit.
 *
 * Of a ray of the eye, each exit's share is counted where light would have to come from. Two
 * horizons: the girdle plane, which turns with the stone, and the plane across the eye's line,
 * which is that of a scope held before the eye. They are one where the stone lies level. Sources
 * and formulas: docs/gem-measures.md. Internal to validation/measure/gem/.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_LIGHT_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_LIGHT_H

#include "validation/measure/gem/gem_stone.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A measured number and its standard error, from independent rays or repeats. */

typedef struct abbe_gem_number {
  double value, error; /* error: one standard deviation; NaN for fewer than two repeats */
} abbe_gem_number;

/* What rays by chance in a grid's pixels add up to. Errors come from the scatter in each pixel, for
 * few repeats tell the scatter of their totals poorly. Zeroed before the first pixel. */
typedef struct abbe_gem_sums {
  double value, weight;                        /* totals */
  double value_square, product, weight_square; /* their variances and covariance */
} abbe_gem_sums;

/* One pixel's rays, count >= 2. */
void abbe_gem_sums_add(abbe_gem_sums *sums, const double *value, const float *weight, size_t count);
void abbe_gem_sums_join(abbe_gem_sums *to, const abbe_gem_sums *other);
/* Value over weight; 0 where no weight is above 0. */
abbe_gem_number abbe_gem_sums_ratio(const abbe_gem_sums *sums);

/* The ratio of the totals of sum[i] and weight[i], i < count, and its error by the scatter of what
 * is left without each repeat in turn (the jackknife [Efron1982]). 0 where no weight is above 0. */
abbe_gem_number abbe_gem_number_ratio(const double *sum, const double *weight, size_t count);

/* whole: from all repeats; without[i]: the same measure without repeat i. */
abbe_gem_number abbe_gem_number_jackknife(double whole, const double *without, size_t count);

/* An eye far away that looks at a stone: parallel rays through a square of pixels.
 *
 * The stone lies level or is tilted about a horizontal axis of its own; the square is the same at
 * all tilts, the least that holds the ball around the stone's corners. Internal to
 * validation/measure/gem/. */

/* Unit vectors in the stone's axes. */
typedef struct abbe_gem_eye {
  double right[3], up[3]; /* directions of the picture; x and y where the stone lies level */
  double to_eye[3];       /* z there */
} abbe_gem_eye;

/* axis_rad: azimuth of the axis, from x to y; tilt_rad: above 0, the stone turns by it as a right
 * hand's fingers about the axis: what is to the left of the axis' arrow comes towards the eye. */
abbe_gem_eye abbe_gem_eye_make(double axis_rad, double tilt_rad);

/* The ray of pixel (column, row) of side x side, row 0 at the top, at (u, v) in it, each 0 to 1,
 * from the left and top: a place outside the stone, and the direction away from the eye. */
void abbe_gem_eye_ray(const abbe_gem_eye *eye, size_t side, size_t column, size_t row, double u,
                      double v, double o[3], double d[3]);

/* A place in a pixel, by chance: each repeat is a jittered grid by itself, and independent of the
 * others, so that their scatter shows their error. Returns a seed for what else the ray decides. */
uint32_t abbe_gem_eye_place(size_t side, size_t column, size_t row, size_t repeat, double *u,
                            double *v);

/* All that becomes of the light along one ray of the eye in a cut stone.
 *
 * By reciprocity the eye's ray is followed backwards. A stone is convex: what leaves it never
 * comes back, so at each face one part leaves for good and one goes on, and the tree of all paths
 * is a chain. Both are followed by their shares, by Fresnel's law (the mean of both polarisations,
 * abbe_interface_reflectance). In a crystal two waves go on from a face: one of them does, chosen
 * by its share (double_refraction.h). Between faces the material absorbs. */

/* A path ends where it carries less than this share of the ray's light, or at its most faces; what
 * it still carries is kept account of. */
#define ABBE_GEM_LEAST_SHARE 1e-4f
#define ABBE_GEM_LEAST_CRYSTAL 1e-3f /* where chance decides on waves */
enum { ABBE_GEM_MOST_FACES = 4096, ABBE_GEM_MOST_EXITS = 512 };

typedef struct abbe_gem_exit {
  float d[3];  /* unit, away from the stone: where light would come from */
  float share; /* share of the ray's light */
} abbe_gem_exit;

/* The shares of all exits, absorbed and left add up to 1. */
typedef struct abbe_gem_path {
  size_t count;
  abbe_gem_exit exit[ABBE_GEM_MOST_EXITS]; /* the first is the outer face's reflection */
  float absorbed, left;
} abbe_gem_path;

/* Where the line o + t d, unit d, meets the stone from outside: the place and the outward normal of
 * the plane that it enters through; false where it passes by. */
bool abbe_gem_path_enter(const abbe_gem_stone *stone, const double o[3], const double d[3],
                         double p[3], double n[3]);

/* From a place and normal of abbe_gem_path_enter, at wavelength k of the stone. seed: of a
 * crystal's choices of waves; one for all wavelengths of a ray keeps chance out of its colour. */
void abbe_gem_path_follow(const abbe_gem_stone *stone, size_t k, const double p[3],
                          const double n[3], const double d[3], uint32_t seed, abbe_gem_path *out);

/* Default half angle of the head's shadow, degrees: ASET's [Sasian2007]. */
#define ABBE_GEM_HEAD_DEG 15.0

/* GemRay's [GemRay] three have a head of their own and a horizon across the line of sight, from
 * which e counts in them, so that both stay where they are as the stone tilts. */
#define ABBE_GEM_GEMRAY_HEAD_DEG 10.0

/* X(code, name, text). Each is a share of the eye's light, 0 to 1. up, down, absorbed and left add
 * up to 1; so do green, red, blue, below, absorbed and left; and return, head, down, absorbed,
 * left.
 */
#define ABBE_GEM_AMOUNTS(X)                                                                        \
  X(ISO, "iso", "brightness: L = 1 above the girdle plane")                                        \
  X(COS, "cos", "cosine brightness: L = sin e above the girdle plane")                             \
  X(GEMRAY_ISO, "gemray_iso", "GemRay's ISO: L = 1, the head of 10 degrees dark")                  \
  X(GEMRAY_COS, "gemray_cos", "GemRay's COS: L = sin e")                                           \
  X(GEMRAY_SC2, "gemray_sc2", "GemRay's SC2: L = sin 2e")                                          \
  X(RETURN, "return", "light return: L = 1 above the girdle plane, the head dark")                 \
  X(HEAD, "head", "from the head, above the girdle plane")                                         \
  X(DOWN, "leakage", "from below the girdle plane")                                                \
  X(GREEN, "aset_green", "ASET green: 0 to 45 degrees up")                                         \
  X(RED, "aset_red", "ASET red: 45 degrees to the head")                                           \
  X(BLUE, "aset_blue", "ASET blue: the head")                                                      \
  X(BELOW, "aset_leakage", "ASET white or black: from behind")                                     \
  X(ABSORBED, "absorbed", "absorbed by the stone")                                                 \
  X(LEFT, "left", "not followed to its end")

typedef enum abbe_gem_amount {
#define ABBE_GEM_AMOUNT_ENUM(code, name, text) ABBE_GEM_##code,
  ABBE_GEM_AMOUNTS(ABBE_GEM_AMOUNT_ENUM)
#undef ABBE_GEM_AMOUNT_ENUM
      ABBE_GEM_AMOUNT_COUNT
} abbe_gem_amount;

const char *abbe_gem_amount_name(abbe_gem_amount amount);
const char *abbe_gem_amount_text(abbe_gem_amount amount);

typedef struct abbe_gem_light {
  float eye[3];     /* unit, from the stone to the eye, in the stone's axes */
  float cos_head;   /* cosine of the head's half angle about it */
  float cos_gemray; /* that of GemRay's head */
} abbe_gem_light;

/* head_rad 0 (no head) to below pi / 4. */
abbe_gem_light abbe_gem_light_make(const double eye[3], double head_rad);

/* Sets amount[] to those of the path. */
void abbe_gem_light_judge(const abbe_gem_light *light, const abbe_gem_path *path,
                          float amount[ABBE_GEM_AMOUNT_COUNT]);

/* Small lights before a stone, in which its fire and its blinking are seen.
 *
 * Sixty lights, 2 to 10 degrees across and of luminance 1, spread evenly over the hemisphere about
 * the eye's line as a spiral has it; all else is dark, and so is a light behind the head. They stay
 * with the eye while the stone is rocked. Each repeat turns them by another angle, so that the
 * errors hold the lights' places too. */

enum { ABBE_GEM_LAMPS = 60 };
#define ABBE_GEM_LAMP_MIN_DEG 2.0 /* across */
#define ABBE_GEM_LAMP_MAX_DEG 10.0

typedef struct abbe_gem_lamps {
  float x[64], y[64], z[64], cos_radius[64]; /* the stone's axes; those past the last have none */
} abbe_gem_lamps;

/* head_rad: half angle, 0: no head. */
abbe_gem_lamps abbe_gem_lamps_make(const abbe_gem_eye *eye, size_t repeat, double head_rad);

/* The share of the path's light that comes from lamps. */
float abbe_gem_lamps_light(const abbe_gem_lamps *lamps, const abbe_gem_path *path);

#endif
