/* refractor_tilt.h: the refractors of a scene tilted together, as a stone is rocked in the hand
 * while eye, lights and all else stay where they are.
 */
#ifndef ABBE_SCENES_REFRACTOR_TILT_H
#define ABBE_SCENES_REFRACTOR_TILT_H

#include "scenes/scene.h"

/* By tilt_rad, right-handed, about the horizontal axis of azimuth axis_rad (from +x towards +y)
 * through the middle of the bounds of all refractors. abbe_scene_check follows.
 * ABBE_INVALID_ARGUMENT where there is no refractor, or an angle is not finite; the scene is as it
 * was then, and is not to be used after any other error. */
abbe_result abbe_refractors_tilt(abbe_scene *scene, double tilt_rad, double axis_rad,
                                 abbe_error *error);

#endif
