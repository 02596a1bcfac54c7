/* eye_samples.h: how many samples of each pixel the eye takes in a pass.
 *
 * What shows in glass changes from place to place within a pixel, and one sample of it is far from
 * the mean where the photons of the same pass have found theirs. So pixels that may show a
 * refractor take as many samples as there is time for. The numbers are fixed before the first pass,
 * so that what is seen has no part in them, and the mean stays unbiased.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_WALKS_EYE_SAMPLES_H
#define ABBE_VALIDATION_WALKS_EYE_SAMPLES_H

#include "validation/walks/camera.h"

#define ABBE_EYE_MOST_SAMPLES 16

/* samples[height][width]: 1 for what shows receivers alone; else as many as about `rays` rays in
 * all of the picture allow, or up to five times that the more of it is glass; alike for all, 1 to
 * ABBE_EYE_MOST_SAMPLES. */
void abbe_eye_samples_share(const abbe_geometry *geometry, const abbe_trace_camera *camera,
                            double rays, size_t threads, uint8_t *samples);

/* How far the eye sees, mean over places of the picture that show something; frame; 1: none do. */
float abbe_eye_samples_depth(const abbe_geometry *geometry, const abbe_trace_camera *camera);

#endif
