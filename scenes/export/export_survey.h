/* export_survey.h: what a format cannot hold of a scene, before anything is written.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_EXPORT_EXPORT_SURVEY_H
#define ABBE_SCENES_EXPORT_EXPORT_SURVEY_H

#include "scenes/export/scene_export.h"

#define ABBE_EXPORT_LINE_D_NM 587.5618

/* Fills the zeroed report: each material's index in the target's form, and notes. */
abbe_result abbe_export_survey(const abbe_scene *scene, abbe_scene_export_target target,
                               double lambda_nm, abbe_scene_export_report *report,
                               abbe_error *error);

#endif
