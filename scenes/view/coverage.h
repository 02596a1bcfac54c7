/* coverage.h: how much of each pixel objects cover, as the camera sees them: the alpha of a picture
 * without what lies behind.
 *
 * Camera rays through the centres of samples x samples parts of a pixel against all objects'
 * triangles. Lights are not objects.
 */
#ifndef ABBE_SCENES_VIEW_COVERAGE_H
#define ABBE_SCENES_VIEW_COVERAGE_H

#include "scenes/scene.h"

/* An image of one channel, A, from 0 to 1, rows downwards, of a camera that is sharp whatever its
 * aperture. samples: 1 to 16. ABBE_NO_MEMORY. */
abbe_result abbe_coverage_make(const abbe_scene *scene, size_t width, size_t height, size_t samples,
                               abbe_image *out, abbe_error *error);

#endif
