/* materials.h: the verbs of `abbe materials`, a file each.
 *
 * A verb is one line of ABBE_MATERIALS_VERBS and one function in cli/materials/materials_NAME.c
 * The program finds it by its name, lists it with its summary in
 * `abbe materials --help`, and hands it its arguments with argv[0] "abbe materials NAME". No verb
 * holds logic that a library could use. Internal to cli/materials/.
 */
#ifndef ABBE_CLI_MATERIALS_MATERIALS_H
#define ABBE_CLI_MATERIALS_MATERIALS_H

#include "base/report.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "spectral/dispersion/fit.h"
#include "spectral/editing/table_edit.h"
#include "spectral/materials/material.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

/* X(name, summary): every verb NAME is `int abbe_materials_NAME(int argc, char **argv)`. */
#define ABBE_MATERIALS_VERBS(X)                                                                    \
  X(list, "the materials of a table")                                                              \
  X(show, "one material: model, indices, Abbe number, absorption, source, fits")                   \
  X(plot, "draw the index over wavelength, with fits and measurements, or the glass map")          \
  X(nearest, "the materials nearest to an n_d and V_d, to a curve, or to points")                  \
  X(partners, "glasses that make an achromat with a glass, by secondary spectrum")                 \
  X(check, "what is wrong or doubtful in a table, and how to fix it")                              \
  X(fit, "a Cauchy or Sellmeier form through a material, a formula or points")                     \
  X(from, "a record from n_d and V_d, a gem's dispersion, A and B, or glTF's pair")                \
  X(set, "change values of a record, and nothing else in the file")                                \
  X(add, "add a record to a table, new or from another table")                                     \
  X(remove, "take records out of a table")                                                         \
  X(import, "make a table of catalogues, refractiveindex.info files, MaterialX and points")        \
  X(export, "write materials as YAML, SQLite, AGF, RII, CSV or MaterialX")

#define ABBE_MATERIALS_DECLARE(name, summary) int abbe_materials_##name(int argc, char **argv);
ABBE_MATERIALS_VERBS(ABBE_MATERIALS_DECLARE)
#undef ABBE_MATERIALS_DECLARE

/* The options that several verbs of `abbe materials` have, and wrong use. */

/* Rows of options that several verbs have; a verb's own keys begin at ABBE_MATERIALS_KEY_OWN. */
enum { ABBE_MATERIALS_KEY_OWN = 256 };
#define ABBE_MATERIALS_TABLE_OPTION(request, field)                                                \
  {                                                                                                \
    "table", 0, "FILE", ABBE_ARGUMENT_READS,                                                       \
        "a table file, or default or thesis; without it, default", 0,                              \
        ABBE_TAKE_TEXT(request, field)                                                             \
  }
#define ABBE_MATERIALS_JSON_OPTION(request, field)                                                 \
  { "json", 0, NULL, 0, "as JSON, numbers in full", 0, ABBE_TAKE_FLAG(request, field) }

/* abbe_arguments_parse for verbs whose arguments are no files. */
void abbe_materials_parse(const abbe_parser *parser, int argc, char **argv, void *request);
/* Prints "PROGRAM: sentence" and where help is, and ends the program with ABBE_EXIT_USAGE. */
_Noreturn void abbe_materials_wrong_use(const char *program, const char *sentence);

/* A material's numbers as the verbs of `abbe materials` print them, and as JSON. */

/* The numbers of a material; NaN where its record does not vouch for the wavelengths. */
abbe_dispersion_numbers abbe_materials_numbers(const abbe_material *material);
/* value by format into text[size], or "-" for NaN, or "infinite"; returns what to print. */
const char *abbe_materials_number(char *text, size_t size, const char *format, double value);

/* An object for abbe_materials_print_json; want of memory at any step after this is remembered,
 * and then nothing is printed: half an answer is none. Printing deletes it. */
cJSON *abbe_materials_json(void);
abbe_result abbe_materials_print_json(cJSON *root, abbe_error *error);
/* The part of a record that is about absorption; where it goes by direction, the colours of faces
 * too. JSON has `attenuation_per_m` (of the ordinary wave) and `pleochroism`. */
void abbe_materials_show_absorption(const abbe_material *material);
void abbe_materials_add_absorption(cJSON *to, const abbe_material *material);
/* What it absorbs at one wavelength, 1/m: columns of a table, none of what is clear, and their
 * head; in JSON `attenuation_per_m`, with keys of their own for the other waves or axes. */
const char *abbe_materials_loss_columns(const abbe_material *material);
void abbe_materials_print_losses(const abbe_material *material, double lambda_nm);
void abbe_materials_add_losses(cJSON *to, const abbe_material *material, double lambda_nm);
/* For a biaxial crystal, at d: its three indices and the angle of its optic axes about z. */
void abbe_materials_show_biaxial(const abbe_material *material);
void abbe_materials_add_biaxial(cJSON *to, const abbe_material *material);
/* Adds text, or null where there is none. */
void abbe_materials_add_text(cJSON *to, const char *key, const char *text);
/* n_d, v_d, the indices at the lines, b_g and partial dispersions; null where the record does not
 * vouch for them. */
void abbe_materials_add_numbers(cJSON *to, const abbe_material *material);
/* A few coefficients to twelve digits, for a record that people read: no index moves by 1e-10. */
void abbe_materials_round(abbe_dispersion *dispersion);
/* density_g_cm3, null where the record has none. */
void abbe_materials_add_density(cJSON *to, const abbe_material *material);
/* The temperature of its measurement, that which it is shown at, and dn/dT. */
void abbe_materials_print_conditions(const abbe_material *material);
void abbe_materials_add_conditions(cJSON *to, const abbe_material *material);
void abbe_materials_add_pair(cJSON *to, const char *key, double a, double b);

/* Notes of a conversion, for a person or for a program. */

/* One line a note to stderr; of each kind the first few, then how many more there are, unless all
 * are wanted. */
void abbe_materials_print_report(const char *program, const abbe_report *report, bool all);

/* Adds "notes", a list of kind, line, name and text, and the number of each kind. */
void abbe_materials_add_report(cJSON *to, const abbe_report *report);

/* What the verbs that change a table share: open, say, write. */

typedef struct abbe_change {
  const char *program, *table;
  bool dry_run;
  abbe_table_edit *edit;
} abbe_change;

/* ABBE_UNSUPPORTED, with how to come by a copy, for a table that is compiled in. */
abbe_result abbe_change_check_table(const char *table, abbe_error *error);

/* The picture of a fit: the curve through its points, its residuals below. */

/* Writes the picture to path, whose ending says .png or .svg; of is what was fitted. */
abbe_result abbe_materials_fit_plot(const char *path, const char *of,
                                    const abbe_index_points *points, const abbe_fit *fit,
                                    abbe_error *error);

#endif
