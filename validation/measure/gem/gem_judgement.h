/* gem_judgement.h: all by which a stone is judged, at once: from above, and rocked. */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_JUDGEMENT_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_JUDGEMENT_H

#include "validation/measure/gem/gem_tilts.h"
#include "validation/measure/gem/gem_view.h"

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
