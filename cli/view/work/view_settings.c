#include "cli/view/work/view_settings.h"

#include <math.h>

const abbe_preset_point *abbe_view_settings_point(const abbe_preset_front *front,
                                                  abbe_view_stage stage) {
  const abbe_preset_name name = stage <= ABBE_VIEW_MOVING     ? ABBE_PRESET_DRAFT
                                : stage == ABBE_VIEW_BALANCED ? ABBE_PRESET_BALANCED
                                                              : ABBE_PRESET_ACCURATE;
  const size_t at = front->count > 0 ? front->named[name] : 0;
  return at < front->count ? &front->point[at] : NULL;
}

/* A stage's settings; where no sweep has measured such scenes, the plan's own and what is coarser
 * and finer than these. */
static abbe_render_desc of_stage(const abbe_preset_front *front, const abbe_scene *scene,
                                 abbe_view_stage stage) {
  const abbe_preset_point *point = abbe_view_settings_point(front, stage);
  abbe_render_desc desc = {0};
  if (point != NULL) {
    abbe_preset_apply(point, scene, &desc);
  } else if (stage <= ABBE_VIEW_MOVING) {
    desc = (abbe_render_desc){.wavelengths = 5, .photons = 64, .map_size = 256, .supersample = 1};
  } else if (stage >= ABBE_VIEW_ACCURATE) {
    desc = (abbe_render_desc){.wavelengths = 21, .photons = 512, .supersample = 2};
  }
  return desc;
}

abbe_render_desc abbe_view_settings_of(const abbe_preset_front *front, const abbe_scene *scene,
                                       const abbe_view_job *job, const abbe_view_document *document,
                                       const abbe_caustic_volume *volume) {
  static const double fewer[ABBE_VIEW_LIGHT_STEPS] = {1, 0.7, 0.5, 0.35};
  const bool moving = job->stage == ABBE_VIEW_MOVING;
  const bool light_moves = moving && job->light == ABBE_VIEW_MOVING;
  abbe_render_desc desc = of_stage(front, scene, job->light);
  desc.supersample = moving ? 1 : of_stage(front, scene, job->stage).supersample;
  desc.upsample = moving ? job->eye_step + 1 : 0;
  if (moving) desc.coarse = light_moves ? ABBE_COARSE_ALL : ABBE_COARSE_EYE;
  desc.adaptive = moving ? 1 : 0;
  /* light that moves is blended with the last frames'; what is better is of one frame */
  desc.volume = volume;
  desc.history = light_moves && volume == NULL ? ABBE_RENDER_MAX_HISTORY : 0;
  desc.history_of_changes = true; /* the first turn of a camera does not follow photons again */
  desc.aovs = true; /* in motion too: without them other programs would have to be compiled */
  if (light_moves && desc.photons > 0)
    desc.photons = (size_t)fmax(8, (double)desc.photons * fewer[job->light_step]);
  /* so that what keeps up with a hand does not wait for a slider */
  if (!light_moves) {
    if (document->wavelengths > 0) desc.wavelengths = document->wavelengths;
    if (document->photons > 0) desc.photons = document->photons;
    if (document->map_size > 0) desc.map_size = document->map_size;
  }
  return desc;
}
