/* gem_light.h: the hemispheres of light that stones are judged under, and what each says of an
 * exit.
 *
 * Of a ray of the eye, each exit's share is counted where light would have to come from. Two
 * horizons: the girdle plane, which turns with the stone, and the plane across the eye's line,
 * which is that of a scope held before the eye. They are one where the stone lies level. Sources
 * and formulas: docs/gem-measures.md.
 */
#ifndef ABBE_VALIDATION_GEM_GEM_LIGHT_H
#define ABBE_VALIDATION_GEM_GEM_LIGHT_H

#include "validation/gem/gem_path.h"

/* Default half angle of the head's shadow, degrees: ASET's [Sasian2007]. */
#define ABBE_GEM_HEAD_DEG 15.0

/* X(code, name, text). Each is a share of the eye's light, 0 to 1. up, down, absorbed and left add
 * up to 1; so do green, red, blue, below, absorbed and left; and return, head, down, absorbed,
 * left.
 */
#define ABBE_GEM_AMOUNTS(X)                                                                        \
  X(ISO, "iso", "ISO brightness: L = 1 above the girdle plane")                                    \
  X(COS, "cos", "COS brightness: L = sin e above the girdle plane")                                \
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
  float eye[3];   /* unit, from the stone to the eye, in the stone's axes */
  float cos_head; /* of the head's half angle about it */
} abbe_gem_light;

/* head_rad 0 (no head) to below pi / 4. */
abbe_gem_light abbe_gem_light_make(const double eye[3], double head_rad);

/* Sets amount[] to those of the path. */
void abbe_gem_light_judge(const abbe_gem_light *light, const abbe_gem_path *path,
                          float amount[ABBE_GEM_AMOUNT_COUNT]);

#endif
