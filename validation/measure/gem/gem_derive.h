/* gem_derive.h: what a stone of a scene returns of light, and how that changes with scalars of the
 * scene.
 *
 * It is seen from straight above, as it lies in the scene, alone in air, by white light of D65 and
 * with the measures of gem_slope.h. A key is moved by a little both ways, as derivative.h has it;
 * what the stone's planes, index and loss change by goes through the measure's own derivative by
 * these. A crystal counts with its ordinary index.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_DERIVE_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_DERIVE_H

#include "validation/measure/derive/specular.h"
#include "validation/measure/gem/gem_slope.h"

/* X(code, amount, name, unit): shares of the eye's light, and the degrees by which the lines F and
 * C are apart in light that leaves above the horizon, times its share. */
#define ABBE_GEM_DERIVE_MEASURES(X)                                                                \
  X(RETURN, RETURN, "return", "")                                                                  \
  X(ISO, ISO, "iso", "")                                                                           \
  X(COS, COS, "cos", "")                                                                           \
  X(GEMRAY_ISO, GEMRAY_ISO, "gemray_iso", "")                                                      \
  X(GEMRAY_COS, GEMRAY_COS, "gemray_cos", "")                                                      \
  X(GEMRAY_SC2, GEMRAY_SC2, "gemray_sc2", "")                                                      \
  X(LEAKAGE, DOWN, "leakage", "")                                                                  \
  X(FIRE, AMOUNT_COUNT, "fire", "degrees")
typedef enum abbe_gem_derive_measure {
#define ABBE_GEM_DERIVE_MEASURE_ENUM(code, amount, name, unit) ABBE_GEM_DERIVE_##code,
  ABBE_GEM_DERIVE_MEASURES(ABBE_GEM_DERIVE_MEASURE_ENUM)
#undef ABBE_GEM_DERIVE_MEASURE_ENUM
      ABBE_GEM_DERIVE_MEASURE_COUNT
} abbe_gem_derive_measure;
const char *abbe_gem_derive_measure_name(abbe_gem_derive_measure measure);
const char *abbe_gem_derive_measure_unit(abbe_gem_derive_measure measure);

typedef struct abbe_gem_derive_stone {
  abbe_gem_stone gem;
  double *n, *loss; /* [wavelengths]; loss: a unit of length of the gem's; owned */
  double spread;    /* what the index grows by from C to F */
} abbe_gem_derive_stone;

/* ABBE_UNSUPPORTED for an object that is no convex refractor with flat faces; shift may be NULL;
 * errors of abbe_gem_stone_make. */
abbe_result abbe_gem_derive_stone_make(const abbe_object *object, const abbe_specular_shift *shift,
                                       const abbe_wavelengths *wavelengths,
                                       abbe_gem_derive_stone *out, abbe_error *error);
/* The same of a cut, whose polyhedron it is, so wide; z is up. */
abbe_result abbe_gem_derive_cut_make(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                     const abbe_material *material,
                                     const abbe_specular_shift *shift, double width_m,
                                     const abbe_wavelengths *wavelengths,
                                     abbe_gem_derive_stone *out, abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_derive_stone_free(abbe_gem_derive_stone *stone);

typedef struct abbe_gem_derive_key {
  const char *name;
  double step;
  abbe_gem_derive_stone moved[2]; /* down, up */
} abbe_gem_derive_key;

typedef struct abbe_gem_derive_desc {
  const abbe_gem_derive_stone *base;
  const abbe_weights *weights; /* in XYZ */
  size_t keys;
  const abbe_gem_derive_key *key; /* [keys] */
  double head_rad;
  size_t lines;                              /* in all */
  size_t threads;                            /* 0: all */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
} abbe_gem_derive_desc;

/* A measure's row of out[measures][1 + keys] has its value and its derivatives by the keys;
 * felt[keys] (may be NULL): whether the stone changes with the key at all. ABBE_UNSUPPORTED, with
 * the key's name, where faces come or go; errors of abbe_gem_slope_make. */
abbe_result abbe_gem_derive_make(const abbe_gem_derive_desc *desc,
                                 const abbe_gem_derive_measure *measure, size_t measures,
                                 abbe_gem_number *out, bool *felt, abbe_error *error);

#endif
