/* scene_export.h: a scene in the words of other programs, and what of it they cannot hold.
 *
 * pbrt-v4, glTF 2.0 and a script for Blender: camera, lights, receivers, mirrors and refractors,
 * with n(lambda) as far as each format has one. Lengths stay metres. Pictures of pbrt and Blender
 * are in Abbe's own unit, a radiance whose Y is 1 for 1 W/(m2 sr) of the light's own spectrum; glTF
 * has photometric units. It reads none of these formats and runs none of these programs. POV-Ray is
 * pov_file.h's.
 */
#ifndef ABBE_SCENES_EXPORT_SCENE_EXPORT_H
#define ABBE_SCENES_EXPORT_SCENE_EXPORT_H

#include "base/error.h"
#include "base/report.h"
#include "scenes/scene.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

/* N(lambda) as other programs hold it, and how far off that is.
 *
 * Formats have a table, n_d with an Abbe number, or an index for red, green and blue each. Here are
 * the numbers that serve a material best in such a form, the form's value at any wavelength, and
 * its worst and RMS error over 380 to 780 nm. It writes nothing. */

/* X(code, name, what value[] holds). */
#define ABBE_EXPORT_FORMS(X)                                                                       \
  X(TABLE, "table", "none: n every 5 nm from 360 to 830 nm, straight between")                     \
  X(ABBE, "abbe", "n_d and 20 / V_d [glTFDispersion]")                                             \
  X(THREE, "three", "n at 611.4, 549.1 and 464.2 nm, for red, green and blue")

typedef enum abbe_export_form {
#define ABBE_EXPORT_FORM_ENUM(code, name, text) ABBE_EXPORT_FORM_##code,
  ABBE_EXPORT_FORMS(ABBE_EXPORT_FORM_ENUM)
#undef ABBE_EXPORT_FORM_ENUM
      ABBE_EXPORT_FORM_COUNT
} abbe_export_form;

const char *abbe_export_form_name(abbe_export_form form);

/* The table's wavelengths: those that pbrt draws from. */
#define ABBE_EXPORT_TABLE_FIRST_NM 360.0
#define ABBE_EXPORT_TABLE_STEP_NM 5.0
#define ABBE_EXPORT_TABLE_COUNT 95

typedef struct abbe_export_index {
  abbe_export_form form;
  double value[3];
  double table[ABBE_EXPORT_TABLE_COUNT]; /* TABLE */
  double worst, worst_nm; /* largest |n - the material's| over 380 to 780 nm, and where */
  double rms;             /* over the same, each nanometre alike */
  bool held; /* the record does not vouch for all of 360 to 830 nm: at its ends n is held; errors
                are of the part that it vouches for */
} abbe_export_index;

/* ABBE_OUT_OF_RANGE where the material has no index in 380 to 780 nm, ABBE_UNSUPPORTED for a
 * conductor. */
abbe_result abbe_export_index_make(const abbe_material *material, abbe_export_form form,
                                   abbe_export_index *out, abbe_error *error);

/* The form's index. */
double abbe_export_index_at(const abbe_export_index *index, double lambda_nm);

/* X(code, name, ending, form of the index, the program). */
#define ABBE_SCENE_EXPORTS(X)                                                                      \
  X(PBRT, "pbrt", ".pbrt", TABLE, "pbrt-v4")                                                       \
  X(GLTF, "gltf", ".glb", ABBE, "glTF 2.0")                                                        \
  X(BLENDER, "blender", ".py", THREE, "Blender's Cycles")

typedef enum abbe_scene_export_target {
#define ABBE_SCENE_EXPORT_ENUM(code, name, ending, form, program) ABBE_SCENE_EXPORT_##code,
  ABBE_SCENE_EXPORTS(ABBE_SCENE_EXPORT_ENUM)
#undef ABBE_SCENE_EXPORT_ENUM
      ABBE_SCENE_EXPORT_COUNT
} abbe_scene_export_target;

const char *abbe_scene_export_name(abbe_scene_export_target target);
const char *abbe_scene_export_ending(abbe_scene_export_target target);
/* The target of that name, or ABBE_SCENE_EXPORT_COUNT. */
abbe_scene_export_target abbe_scene_export_of_name(const char *name);

/* What became of one material that refracts. */
typedef struct abbe_scene_export_glass {
  const abbe_material *material; /* owned by the scene */
  abbe_export_index index;
} abbe_scene_export_glass;

typedef struct abbe_scene_export_report {
  size_t glass_count; /* in the order in which objects have them */
  abbe_scene_export_glass *glass;
  abbe_report notes; /* what was changed, lost or supplied; the name is an object's or material's */
} abbe_scene_export_report;

void abbe_scene_export_report_free(abbe_scene_export_report *report);

/* Writes the scene to path (beside and renamed), which ends as the target's files do, and whatever
 * it names as STEM-… beside it; the report, which stands in the file too, is filled in.
 * ABBE_INVALID_ARGUMENT for another ending, ABBE_UNSUPPORTED for a name that cannot be spelt,
 * errors of abbe_scene_check and abbe_export_index_make, ABBE_IO, ABBE_NO_MEMORY; nothing is then
 * left behind. */
abbe_result abbe_scene_export_write(const char *path, const abbe_scene *scene,
                                    abbe_scene_export_target target,
                                    abbe_scene_export_report *report, abbe_error *error);

#endif
