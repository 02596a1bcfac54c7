/* derivative.h: how a light's caustic changes with scalars of its scene: the map's texels, and
 * numbers of all that lands.
 *
 * Paths are followed from points of lines across the light's window (line.h), and over the same
 * surfaces in scenes in which a key is moved by a little: by so much what lands differs smoothly.
 * Where from one point of a line to the next the surfaces change, the place where they do is
 * searched for, and how fast it moves: light jumps there by what differs from one side to the
 * other [Li2018]. So edges of facets, silhouettes and shadows are in it. What is not: light on
 * paths of more interfaces than asked for, what stands twice or never between two points of a line,
 * and receivers' light on each other. A texel is weighted by a tent that reaches to its neighbours'
 * middles, for a box's own edge would be one more jump. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_MEASURE_DERIVE_DERIVATIVE_H
#define ABBE_VALIDATION_MEASURE_DERIVE_DERIVATIVE_H

#include "base/error.h"
#include "scenes/view/map_layout.h"
#include "validation/measure/derive/line.h"
#include "validation/trace/transport/spectral_sampling.h"

typedef struct abbe_derivative_key {
  const char *name;
  double step;            /* it is moved so far down and up, in its own unit */
  abbe_specular moved[2]; /* down, up */
} abbe_derivative_key;

/* Of all light that lands; X(code, name, unit). */
#define ABBE_DERIVATIVE_NUMBERS(X)                                                                 \
  X(FLUX, "flux", "W") /* by Y: a watt of the light is one */                                      \
  X(CHROMA_X, "x", "")                                                                             \
  X(CHROMA_Y, "y", "")                                                                             \
  X(PLACE_X, "middle.x", "m")                                                                      \
  X(PLACE_Y, "middle.y", "m")                                                                      \
  X(PLACE_Z, "middle.z", "m")                                                                      \
  X(SPREAD, "spread", "m") /* root mean square distance from the middle */
typedef enum abbe_derivative_number {
#define ABBE_DERIVATIVE_NUMBER_ENUM(code, name, unit) ABBE_DERIVATIVE_##code,
  ABBE_DERIVATIVE_NUMBERS(ABBE_DERIVATIVE_NUMBER_ENUM)
#undef ABBE_DERIVATIVE_NUMBER_ENUM
      ABBE_DERIVATIVE_NUMBER_COUNT
} abbe_derivative_number;

typedef struct abbe_derivative_desc {
  const abbe_specular *base;
  size_t light; /* its index in the scene */
  size_t keys;
  const abbe_derivative_key *key; /* [keys] */
  const abbe_spectral_sampling *sampling;
  const struct abbe_film *film; /* shown.h: of a picture to which what lands is added, or NULL */
  abbe_map_layout layout;
  size_t width, height; /* texels; 0: numbers alone */
  size_t lines, points; /* in all, at least ABBE_DERIVATIVE_PARTS; and of each line */
  size_t interfaces;    /* that a path may meet, 1 to ABBE_SPECULAR_MOST_INTERFACES */
  uint32_t seed;
  size_t threads;                            /* 0: all */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
} abbe_derivative_desc;

enum { ABBE_DERIVATIVE_PARTS = 16, ABBE_DERIVATIVE_SUMS = 7 };

/* One of the parts, whose spread is the standard error. */
typedef struct abbe_derivative_part {
  double (*map)[3];                    /* [1 + keys][texels], owned */
  double (*sum)[ABBE_DERIVATIVE_SUMS]; /* [1 + keys], owned */
  double (*picture)[3];                /* [1 + keys][pixels] of the film, or NULL */
  abbe_line_sums sums;                 /* felt is owned */
} abbe_derivative_part;
/* False: no memory; then, too, it is freed. */
bool abbe_derivative_part_make(const abbe_derivative_desc *desc, abbe_derivative_part *out);
void abbe_derivative_part_free(abbe_derivative_part *part);
/* Adds the part of that index. Errors of abbe_specular_wave_make. */
abbe_result abbe_derivative_part_run(const abbe_derivative_desc *desc, size_t index,
                                     abbe_derivative_part *to, abbe_error *error);

typedef struct abbe_derivative {
  size_t keys, texels;
  float (*map)[3];   /* [1 + keys][texels] XYZ, W a texel: the map, and by each key's unit; owned */
  float (*error)[3]; /* likewise: standard errors; owned */
  double (*sum)[ABBE_DERIVATIVE_PARTS][ABBE_DERIVATIVE_SUMS]; /* [1 + keys], owned */
  bool *felt;       /* [keys] whether a path changed with it at all; owned */
  double middle[3]; /* from which places are summed */
  double left;      /* share of the light at the first interfaces on paths that are too long */
  double lost; /* share of the light that jumps at places that were not found in a moved scene */
} abbe_derivative;

/* ABBE_CANCELLED, ABBE_NO_MEMORY, errors of abbe_specular_wave_make. */
abbe_result abbe_derivative_make(const abbe_derivative_desc *desc, abbe_derivative *out,
                                 abbe_error *error);
void abbe_derivative_free(abbe_derivative *d);

/* A number itself (row 0) or its derivative by key row - 1, and its standard error (jackknife over
 * the parts). NaN where nothing lands. */
double abbe_derivative_number_of(const abbe_derivative *d, abbe_derivative_number which, size_t row,
                                 double *error);
const char *abbe_derivative_number_name(abbe_derivative_number which);
const char *abbe_derivative_number_unit(abbe_derivative_number which);

/* A layout that holds what lands, seen from the light; ABBE_UNSUPPORTED where nothing lands in
 * front of it. */
abbe_result abbe_derivative_fit(const abbe_derivative_desc *desc, abbe_map_layout *out,
                                abbe_error *error);

#endif
