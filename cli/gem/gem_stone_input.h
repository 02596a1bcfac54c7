/* gem_stone_input.h: a stone as those verbs of `abbe gem` have it that let light into it: a design
 * (gem_input.h), and its material at some wavelengths. */
#ifndef ABBE_CLI_GEM_GEM_STONE_INPUT_H
#define ABBE_CLI_GEM_GEM_STONE_INPUT_H

#include "cli/gem/gem_input.h"

#include "colorimetry/weights.h"
#include "validation/gem/gem_stone.h"

#define ABBE_GEM_WIDTH_M 0.0065 /* where none is given: a round stone of a carat */

/* Zeroed but for in.program and count. */
typedef struct abbe_gem_stone_input {
  abbe_gem_input in;
  double from_nm, to_nm; /* 0: 380 and 780 */
  size_t count;          /* of wavelengths */
  double width_m;        /* from here on: filled by load */
  abbe_material own;     /* of the design's index, where no material is given */
  abbe_wavelengths wavelengths;
  abbe_weights weights; /* under D65, in XYZ */
  abbe_gem_stone stone;
} abbe_gem_stone_input;

/* abbe_gem_input_load, and the stone. Without a material it has the design's index at all
 * wavelengths; ABBE_NOT_FOUND where that has none. Notes on stderr, unless quiet, of this and where
 * an index is continued beyond its data. */
abbe_result abbe_gem_stone_input_load(abbe_gem_stone_input *input, abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_stone_input_free(abbe_gem_stone_input *input);

#endif
