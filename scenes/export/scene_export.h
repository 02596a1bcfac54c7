/* scene_export.h: a scene in the words of other programs, and what of it they cannot hold.
 *
 * pbrt-v4, Mitsuba 3, LuxCore, glTF 2.0 and a script for Blender: camera, lights, receivers,
 * mirrors and refractors, with n(lambda) as far as each format has one. Lengths stay metres.
 * Pictures of pbrt, Mitsuba, LuxCore and Blender are in Abbe's own unit, a radiance whose Y is 1
 * for 1 W/(m2 sr) of the light's own spectrum; glTF has photometric units. It reads none of these
 * formats and runs none of these programs. POV-Ray is pov_file.h's.
 */
#ifndef ABBE_SCENES_EXPORT_SCENE_EXPORT_H
#define ABBE_SCENES_EXPORT_SCENE_EXPORT_H

#include "base/error.h"
#include "base/report.h"
#include "scenes/export/export_index.h"
#include "scenes/scene.h"

#include <stddef.h>

/* X(code, name, ending, form of the index, the program). */
#define ABBE_SCENE_EXPORTS(X)                                                                      \
  X(PBRT, "pbrt", ".pbrt", TABLE, "pbrt-v4")                                                       \
  X(MITSUBA, "mitsuba", ".xml", ONE, "Mitsuba 3")                                                  \
  X(LUXCORE, "luxcore", ".scn", CAUCHY, "LuxCore")                                                 \
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

/* Zero means the default. */
typedef struct abbe_scene_export_options {
  double lambda_nm; /* of the one index that Mitsuba takes, 380 to 780; 0: 587.5618, the line d */
} abbe_scene_export_options;

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
 * it names as STEM-… or STEM.cfg beside it; the report, which stands in the file too, is filled in.
 * options may be NULL. ABBE_INVALID_ARGUMENT for options out of range, ABBE_UNSUPPORTED for a name
 * that cannot be spelt, errors of abbe_scene_check and abbe_export_index_make, ABBE_IO,
 * ABBE_NO_MEMORY; nothing is then left behind. */
abbe_result abbe_scene_export_write(const char *path, const abbe_scene *scene,
                                    abbe_scene_export_target target,
                                    const abbe_scene_export_options *options,
                                    abbe_scene_export_report *report, abbe_error *error);

#endif
