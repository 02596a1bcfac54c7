/* view_settings.h: what a stage of the viewer asks of the renderer.
 *
 * Its settings are a preset's, coarser or finer as the job says. It draws nothing and knows no
 * worker; a picture's size is its caller's.
 */
#ifndef ABBE_CLI_VIEW_WORK_VIEW_SETTINGS_H
#define ABBE_CLI_VIEW_WORK_VIEW_SETTINGS_H

#include "cli/view/state/view_document.h"
#include "cli/view/state/view_refine.h"
#include "gl/accuracy/preset.h"

/* The preset that a stage takes; NULL where the front has none. */
const abbe_preset_point *abbe_view_settings_point(const abbe_preset_front *front,
                                                  abbe_view_stage stage);

/* The request of a job. Without a preset, the plan's own settings and what is coarser and finer
 * than these. document: its wavelengths, photons and texels hold but where light moves. volume (may
 * be NULL): caustics are looked up in it, which lives as long as the request. */
abbe_render_desc abbe_view_settings_of(const abbe_preset_front *front, const abbe_scene *scene,
                                       const abbe_view_job *job, const abbe_view_document *document,
                                       const abbe_caustic_volume *volume);

#endif
