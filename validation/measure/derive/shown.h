/* shown.h: what the camera sees of one wavelength, in double precision, at a place of its film, in
 * a scene and in ones in which keys are moved.
 *
 * Receivers in the light of lamps, of the surroundings and of what refractors and mirrors throw
 * onto them; lamps, the surroundings and the background themselves. What a lamp throws onto
 * receivers that are seen straight comes from the lamp's own paths (film_of_hit); where they are
 * seen through refractors or in mirrors, from the lamp's map, which blurs it by its texels.
 * Internal to validation/measure/derive/.
 */
#ifndef ABBE_VALIDATION_MEASURE_DERIVE_SHOWN_H
#define ABBE_VALIDATION_MEASURE_DERIVE_SHOWN_H

#include "colorimetry/upsampling.h"
#include "validation/measure/derive/derivative.h"
#include "validation/measure/derive/line.h"

/* One scene's camera and surroundings. */
typedef struct abbe_shown {
  abbe_specular specular; /* without a light; owned */
  double eye[3], right[3], up[3], forward[3], half[2];
  abbe_upsampling upsampling; /* of its environment */
} abbe_shown;

typedef struct abbe_film {
  size_t width, height, keys, interfaces;
  const abbe_spectral_sampling *sampling;
  float (*colour)[3];    /* [rows][steps] of the sampling, in the picture's space; owned */
  double (*white)[3][3]; /* [objects + 1][lights] mean over the steps of what each channel of an
                           object reflects; last of all light, in its first channel; owned */
  double from_xyz[9], whiten[9];
  abbe_shown *scene;                 /* [1 + 2 keys] the base's, each key's down and up; owned */
  const abbe_derivative_desc *light; /* [lights], with a map; a base of NULL: it throws nothing */
} abbe_film;

enum { ABBE_FILM_CHANCES = 9 };

/* Of one wavelength. chance: of the place on the lens, on lamps, in the surroundings; map: of each
 * light [1 + keys][texels]. */
typedef struct abbe_film_line {
  abbe_line line;
  const abbe_film *film;
  abbe_specular_wave *wave; /* [1 + 2 keys] */
  uint32_t step;            /* of the sampling */
  double chance[ABBE_FILM_CHANCES];
  double (*const *map)[3];
  double (*picture)[3]; /* [1 + keys][pixels] */
} abbe_film_line;

/* Moved scenes match the base's (abbe_specular_match). ABBE_UNSUPPORTED for a camera with a
 * polariser or in a refractor. */
abbe_result abbe_shown_make(const abbe_scene *scene, const abbe_specular_shift *shift,
                            const abbe_shown *base, const char *key, double aspect, double min_nm,
                            double max_nm, abbe_shown *out, abbe_error *error);
void abbe_shown_free(abbe_shown *s);

/* Sets the line's functions. */
void abbe_film_line_begin(abbe_film_line *l);

/* Where a light's hit is seen straight, with its shadow in the tree. */
void abbe_film_of_hit(const abbe_film *film, size_t scene, double lambda_nm, const double lens[2],
                      const abbe_specular_tree *known, abbe_specular_tree *tree, size_t hit);

#endif
