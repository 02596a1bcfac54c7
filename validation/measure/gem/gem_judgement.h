/* gem_judgement.h: all by which a stone is judged, at once: from above, and rocked. */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_JUDGEMENT_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_JUDGEMENT_H

#include "colorimetry/weights.h"
#include "validation/measure/gem/gem_light.h"
#include "validation/measure/gem/gem_view.h"

#include <stdbool.h>

/* A stone rocked before the eye: its brightness by tilt, its fire, its scintillation.
 *
 * Four axes, 45 degrees apart; about each the stone goes from one side to the other in even steps.
 * Brightness is as in gem_light.h, in white light. Fire and scintillation are those under small
 * lights (gem_light.h); docs/gem-measures.md has the definitions and where they come from. Results
 * do not depend on the number of threads. */

enum { ABBE_GEM_AXES = 4, ABBE_GEM_MOST_STEPS = 90 };

/* A pixel shows fire where its colour is further than this from white of its own lightness,
 * CIEDE2000; white is a lamp seen directly. */
#define ABBE_GEM_FIRE_DIFFERENCE 10.0
/* And is lit where its luminance is at least this share of a lamp's. */
#define ABBE_GEM_LIT 0.05

/* `done` from 0 to 1; false stops the work. */
typedef bool (*abbe_gem_progress)(void *user, double done);

typedef struct abbe_gem_tilts_desc {
  double most_rad;            /* to either side, above 0 to pi / 2; 0: 30 degrees */
  size_t steps;               /* to either side, 1 to ABBE_GEM_MOST_STEPS; 0: 15 */
  double head_rad;            /* half angle; 0: no head */
  size_t side;                /* pixels, 1 to ABBE_GEM_MOST_SIDE; 0: 12 */
  size_t repeats;             /* 2 to ABBE_GEM_MOST_REPEATS; 0: 8 */
  size_t threads;             /* 0: as many as OpenMP gives */
  abbe_gem_progress progress; /* or NULL */
  void *user;
} abbe_gem_tilts_desc;

/* What there is at each tilt. */
#define ABBE_GEM_TILT_CURVES(X)                                                                    \
  X(ISO, "iso")                                                                                    \
  X(COS, "cos")                                                                                    \
  X(RETURN, "return")                                                                              \
  X(DOWN, "leakage")                                                                               \
  X(FIRE, "fire")

typedef enum abbe_gem_tilt_curve {
#define ABBE_GEM_TILT_ENUM(code, name) ABBE_GEM_TILT_##code,
  ABBE_GEM_TILT_CURVES(ABBE_GEM_TILT_ENUM)
#undef ABBE_GEM_TILT_ENUM
      ABBE_GEM_TILT_CURVE_COUNT
} abbe_gem_tilt_curve;

const char *abbe_gem_tilt_curve_name(abbe_gem_tilt_curve curve);

typedef struct abbe_gem_tilts {
  size_t tilts;                                      /* 2 steps + 1 */
  double axis_rad[ABBE_GEM_AXES];                    /* azimuths */
  double *tilt_rad;                                  /* [tilts] ascending */
  abbe_gem_number *curve[ABBE_GEM_TILT_CURVE_COUNT]; /* [ABBE_GEM_AXES][tilts] */
  abbe_gem_number mean[ABBE_GEM_TILT_CURVE_COUNT];   /* over all tilts and axes alike */
  abbe_gem_number spread; /* ISO's standard deviation over the tilts of all axes */
  abbe_gem_number blinks; /* scintillation: share of pixels, a step, that become lit or dark */
  double step_rad;
  bool has_fire; /* with one wavelength there is none to measure, and FIRE is 0 everywhere */
} abbe_gem_tilts;

/* ABBE_INVALID_ARGUMENT for what is outside its range, ABBE_GEOMETRY where no ray met the stone at
 * some tilt, ABBE_CANCELLED, ABBE_NO_MEMORY. */
abbe_result abbe_gem_tilts_make(const abbe_gem_stone *stone, const abbe_weights *weights,
                                const abbe_gem_tilts_desc *desc, abbe_gem_tilts *out,
                                abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_tilts_free(abbe_gem_tilts *tilts);

/* A crystal turned in its cut. */
typedef struct abbe_gem_orientation {
  double tilt_rad, azimuth_rad;
  abbe_gem_number value; /* of a measure */
  double lab[3];         /* CIELAB of its mean colour, white being light that is returned whole */
} abbe_gem_orientation;

/* Of two indices: the optic axis, at that angle from the cut's z and that azimuth in the cut. Of
 * three: what of the crystal looks up through the table, at that angle from its z and that azimuth
 * from its x towards its y. */
abbe_gem_axes abbe_gem_orientation_axes(const abbe_gem_stone *stone, double tilt_rad,
                                        double azimuth_rad);
/* Fills in what the stone is at out's angles. Errors as abbe_gem_view_make, and
 * ABBE_INVALID_ARGUMENT for what is no crystal. */
abbe_result abbe_gem_orientation_judge(const abbe_gem_stone *stone, const abbe_weights *weights,
                                       const abbe_gem_view_desc *desc, abbe_gem_amount measure,
                                       abbe_gem_orientation *out, abbe_error *error);

/* Those of a judgement: upright, lying along x and along y; of three indices z, x and y up. */
enum { ABBE_GEM_ORIENTATIONS = 3 };

struct abbe_gem_judgement;
/* "optic axis upright", "crystal's z up", and so on. */
const char *abbe_gem_orientation_text(const struct abbe_gem_judgement *judgement, int i);

typedef struct abbe_gem_judgement_desc {
  abbe_gem_view_desc view;
  bool tilts;                 /* else only from where the view is */
  abbe_gem_tilts_desc rocked; /* its head and threads are the view's; side 0: an eighth of that's */
} abbe_gem_judgement_desc;

typedef struct abbe_gem_judgement {
  abbe_gem_view view;
  abbe_gem_number amount[ABBE_GEM_AMOUNT_COUNT]; /* in white light */
  abbe_gem_areas areas;
  abbe_gem_number contrast;
  abbe_gem_number xyz[3]; /* mean colour of the light return; white has Y = 1 */
  bool has_tilts;
  abbe_gem_tilts tilts;
  bool is_crystal, is_biaxial;
  abbe_gem_orientation orientation[ABBE_GEM_ORIENTATIONS]; /* of a crystal: ISO */
} abbe_gem_judgement;

/* Errors as abbe_gem_view_make and abbe_gem_tilts_make. */
abbe_result abbe_gem_judgement_make(const abbe_gem_stone *stone, const abbe_weights *weights,
                                    const abbe_gem_judgement_desc *desc, abbe_gem_judgement *out,
                                    abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_judgement_free(abbe_gem_judgement *judgement);

/* One of the numbers that a judgement comes to. */
typedef struct abbe_gem_judgement_row {
  const char *name, *text; /* for programs, for people */
  abbe_gem_number number;
  bool share; /* a share of 1, shown in percent */
} abbe_gem_judgement_row;

enum { ABBE_GEM_JUDGEMENT_MOST_ROWS = 32 };

/* Fills row[], and says how many there are: those of tilts only where it has them. */
size_t abbe_gem_judgement_rows(const abbe_gem_judgement *judgement,
                               abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS]);

#endif
