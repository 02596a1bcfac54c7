/* gem_input.h: the design and the stone that a verb of `abbe gem` works on: options, reading, and
 * what was met on the way. Internal to cli/gem/. */
#ifndef ABBE_CLI_GEM_GEM_INPUT_H
#define ABBE_CLI_GEM_GEM_INPUT_H

#include "base/report.h"
#include "cli/base/arguments.h"
#include "colorimetry/weights.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "scenes/cuts/cut_stretch.h"
#include "spectral/materials/material_table.h"
#include "validation/measure/gem/gem_stone.h"

#include <stdbool.h>

/* Keys of abbe_gem_input_argp's options; a verb's own begin at ABBE_GEM_KEY_OWN. */
enum { ABBE_GEM_KEY_OWN = 0x300 };

/* Zeroed but for program. */
typedef struct abbe_gem_input {
  const char *program, *path;
  const char *table_path, *material_name;
  double weld, width_m, density_g_cm3; /* 0: not given */
  double rough_m[3];                   /* of gem info; 0: not given */
  bool json, quiet;
  abbe_report report;
  abbe_cut cut;
  abbe_cut_polyhedron stone;
  abbe_cut_measures measures;
  abbe_material_table table;
  const abbe_material *material; /* or NULL */
  double n;                      /* index of the material at the d line, else the design's; 0 */
} abbe_gem_input;

/* FILE, --material, --table, --width, --density, --weld, --json, --quiet. Its input is the
 * abbe_gem_input. */
extern const abbe_parser abbe_gem_input_argp;

/* Reads the file and finds its stone; a path that leads nowhere is looked for beside the program,
 * as scenes are. Notes go to stderr unless quiet. */
abbe_result abbe_gem_input_load(abbe_gem_input *input, abbe_error *error);
void abbe_gem_input_free(abbe_gem_input *input);

/* The density that was given, else the material's; 0: not known. */
double abbe_gem_input_density(const abbe_gem_input *input);
/* The width that was given, else one metre a unit of the design. */
double abbe_gem_input_scale(const abbe_gem_input *input);
/* What the design is called: its first heading, or its file's name. */
const char *abbe_gem_input_title(const abbe_gem_input *input);

struct cJSON;
/* The proportions, the counts and the title. */
void abbe_gem_input_describe(const abbe_gem_input *input, struct cJSON *root);

/* A stone as those verbs of `abbe gem` have it that let light into it: a design (gem_input.h), and
 * its material at some wavelengths. */

#define ABBE_GEM_WIDTH_M 0.0065 /* where none is given: a round stone of a carat */

/* Zeroed but for in.program and count. */
typedef struct abbe_gem_stone_input {
  abbe_gem_input in;
  double from_nm, to_nm; /* 0: 380 and 780 */
  size_t count;          /* number of wavelengths */
  const char *axis;      /* how a crystal lies, as abbe_gem_axes_read has it, or NULL */
  double width_m;        /* from here on: filled by load */
  abbe_material own;     /* the design's index, where no material is given */
  abbe_wavelengths wavelengths;
  abbe_weights weights; /* under D65, in XYZ */
  abbe_gem_axes axes;
  abbe_gem_stone stone;
} abbe_gem_stone_input;

/* abbe_gem_input_load, and the stone. Without a material it has the design's index at all
 * wavelengths; ABBE_NOT_FOUND where that has none. Notes on stderr, unless quiet, of this and where
 * an index is continued beyond its data. */
abbe_result abbe_gem_stone_input_load(abbe_gem_stone_input *input, abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_stone_input_free(abbe_gem_stone_input *input);

#endif
