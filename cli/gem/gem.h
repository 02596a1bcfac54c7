/* gem.h: the verbs of `abbe gem`, a file each.
 *
 * A verb is one line of ABBE_GEM_VERBS and one function in cli/gem/gem_NAME.c. The program lists it
 * with its summary in `abbe gem --help`, and hands it its arguments with argv[0] "abbe gem NAME".
 * No verb holds logic that a library could use. Internal to cli/.
 */
#ifndef ABBE_CLI_GEM_GEM_H
#define ABBE_CLI_GEM_GEM_H

#include "base/report.h"
#include "cli/gem/gem_input.h"
#include "colorimetry/image/image.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "spectral/materials/material.h"
#include "validation/measure/gem/gem_judgement.h"
#include "validation/measure/gem/gem_optimum.h"

/* X(name, summary): every verb NAME is `int abbe_gem_NAME(int argc, char **argv)`. */
#define ABBE_GEM_VERBS(X)                                                                          \
  X(info, "what a design holds: facets, proportions, carats, critical angle, tiers")               \
  X(diagram, "a sheet to cut from: crown, pavilion, profiles, indices, as PDF, SVG or PNG")        \
  X(retarget, "the design at the angles of another stone, its meets kept")                         \
  X(report, "judge the cut in a stone: brightness, leakage, fire, by tilt, with errors")           \
  X(optimise, "the crown and pavilion angles that do best in a stone, meets kept")                 \
  X(convert, "a design as .asc, .gem or .gcs, or as a solid: STL, OBJ, glTF")

/* To path, .png or .svg: the measure over both angles. */
abbe_result abbe_gem_optimise_plot(const char *path, const abbe_gem_input *input,
                                   const abbe_gem_optimum *optimum, const char *measure,
                                   abbe_error *error);

/* Looks for the best design by derivatives, of two angles or of every tier, says what came of it,
 * and writes the best to out unless that is NULL. */
abbe_result abbe_gem_optimise_ascend(abbe_gem_stone_input *input, const char *measure,
                                     const abbe_gem_optimum_desc *desc, bool tiers, const char *out,
                                     abbe_error *error);

/* The same of every tier, for the measure and for fire in several mixtures; out, FILE.asc, becomes
 * FILE-1.asc and so on, and plot, .png or .svg, shows both; or NULL. */
abbe_result abbe_gem_optimise_front(abbe_gem_stone_input *input, const char *measure,
                                    const abbe_gem_optimum_desc *desc, const char *out,
                                    const char *plot, abbe_error *error);

/* Tries ways of a crystal in its cut, by desc's measure and view, and says what came of it: tilts
 * from 0 to 90 degrees, azimuths as abbe_gem_orientation_axes has them. measure: for people. */
abbe_result abbe_gem_optimise_axis(const abbe_gem_stone_input *input, const char *measure,
                                   const abbe_gem_optimum_desc *desc, size_t tilts, size_t azimuths,
                                   abbe_error *error);

#define ABBE_GEM_DECLARE(name, summary) int abbe_gem_##name(int argc, char **argv);
ABBE_GEM_VERBS(ABBE_GEM_DECLARE)
#undef ABBE_GEM_DECLARE

/* A design that a verb of `abbe gem` writes, by its name's ending. */

/* .asc and .gem keep the design; .stl, .obj and .glb its solid, scale metres a unit. Written beside
 * and renamed. ABBE_INVALID_ARGUMENT for another ending; what the formats say. */
abbe_result abbe_gem_output_write(const char *path, const abbe_cut *cut,
                                  const abbe_cut_polyhedron *stone, double scale,
                                  const abbe_material *material, abbe_report *report,
                                  abbe_error *error);

/* What `abbe gem report` says of a judgement: as text, CSV, JSON, pages, pictures. */

/* What the page for a customer shows besides: the stone in more pixels, and another beside it. */
typedef struct abbe_gem_report_page {
  abbe_gem_view own, ideal; /* ideal.side 0: there is none */
  char name[160];           /* the ideal's; "": the same facets at angles that return more light */
  double crown_deg, pavilion_deg; /* its main angles */
  bool is_best;                   /* no pair of angles does better than the design's */
  abbe_image photo;               /* zeroed: a map stands in its place */
} abbe_gem_report_page;

/* photo: a PNG, or NULL. ideal: a design, whose angles become those of the stone's index; NULL:
 * the angles of a brilliant for a round one, else those of 49 pairs that return most light. Errors
 * as abbe_cut_file_read_stone, abbe_png_read_over_white and abbe_gem_optimum_find. */
abbe_result abbe_gem_report_page_make(const abbe_gem_stone_input *input,
                                      const abbe_gem_view_desc *view, const char *photo,
                                      const char *ideal, abbe_gem_report_page *out,
                                      abbe_error *error);
void abbe_gem_report_page_free(abbe_gem_report_page *page);

typedef struct abbe_gem_report_facts {
  const abbe_gem_stone_input *input;
  const abbe_gem_judgement *judgement;
  const abbe_gem_report_page *page; /* or NULL */
  double head_deg, seconds;
} abbe_gem_report_facts;

/* "91.73 %" and "0.02", for people. */
void abbe_gem_report_number(const abbe_gem_judgement_row *row, char value[32], char error[32]);

void abbe_gem_report_print(const abbe_gem_report_facts *facts);
/* Rows of measure, axis, tilt, wavelength, value, standard error; what does not apply is empty. */
void abbe_gem_report_print_csv(const abbe_gem_report_facts *facts);
abbe_result abbe_gem_report_print_json(const abbe_gem_report_facts *facts, abbe_error *error);

struct abbe_sheet;
/* The first page. */
abbe_result abbe_gem_report_page_put(struct abbe_sheet *sheet, const abbe_gem_report_facts *facts,
                                     abbe_error *error);
/* To path, .pdf; the facts have a page. */
abbe_result abbe_gem_report_sheet(const char *path, const abbe_gem_report_facts *facts,
                                  abbe_error *error);
/* maps.exr and a PNG for each map, into a folder that is there. */
abbe_result abbe_gem_report_maps(const char *folder, const abbe_gem_judgement *judgement,
                                 abbe_error *error);

#endif
