/* camera.h: the scene's camera in the tracer's frame: a pinhole, or a thin lens.
 *
 * Pixels are counted from the top left; a pixel's value is the mean radiance over its area on the
 * film. Film coordinates are tangents at distance 1. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_CAMERA_H
#define ABBE_VALIDATION_TRACE_WALKS_CAMERA_H

#include "validation/trace/transport/geometry.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_trace_camera {
  float eye[3], right[3], up[3], forward[3]; /* frame; unit */
  float half_width, half_height;             /* half sizes of the film */
  size_t width, height;                      /* pixels */
  float pixel_area;                          /* on the film */
  float lens, focus; /* the radius of the lens, and how far away it is sharp, frame; 0: a pinhole */
  float moved[2];    /* on the film: of a place on the lens, that it sees things with others */
} abbe_trace_camera;

/* The scene's camera with width x height pixels; its vertical angle holds for the height. */
void abbe_trace_camera_make(const abbe_geometry *geometry, size_t width, size_t height,
                            abbe_trace_camera *out);

/* The pinhole at a place on the lens, even in u and v from 0 to 1 over its area. What lies as far
 * away as it is sharp stays in its pixel; all else moves by a disk whose radius on the film is
 * lens |1 / focus - 1 / distance|. Of a pinhole it is the same. */
static inline abbe_trace_camera abbe_trace_camera_at(const abbe_trace_camera *c, float u, float v) {
  abbe_trace_camera out = *c;
  if (!(c->lens > 0)) return out;
  const float r = c->lens * sqrtf(u), x = r * cosf(6.28318531f * v), y = r * sinf(6.28318531f * v);
  for (int k = 0; k < 3; k++) out.eye[k] += x * c->right[k] + y * c->up[k];
  out.moved[0] = x / c->focus;
  out.moved[1] = y / c->focus;
  return out;
}

/* Unit direction through the place (x, y) in pixels, fractions included. */
static inline void abbe_trace_camera_ray(const abbe_trace_camera *c, float x, float y, float d[3]) {
  float a = (2 * x / (float)c->width - 1) * c->half_width - c->moved[0];
  float b = (1 - 2 * y / (float)c->height) * c->half_height - c->moved[1];
  float scale = 1 / sqrtf(1 + a * a + b * b);
  for (int k = 0; k < 3; k++) d[k] = scale * (c->forward[k] + a * c->right[k] + b * c->up[k]);
}

/* The pixel that a point (frame) is seen in; false where it is behind the camera or outside the
 * picture. *distance to the camera (frame), d the unit direction from the camera, *per_pixel: what
 * a pixel's mean radiance gains, for an isotropic radiance towards the camera of 1 from a unit of
 * projected area at unit distance (1 / the film's area and cosine^3). */
static inline bool abbe_trace_camera_pixel(const abbe_trace_camera *c, const float p[3],
                                           size_t *pixel, float *distance, float d[3],
                                           float *per_pixel) {
  float x = 0, y = 0, z = 0, square = 0;
  for (int k = 0; k < 3; k++) {
    d[k] = p[k] - c->eye[k];
    x += d[k] * c->right[k];
    y += d[k] * c->up[k];
    z += d[k] * c->forward[k];
    square += d[k] * d[k];
  }
  if (!(z > 0)) return false;
  float a = 0.5f * ((x / z + c->moved[0]) / c->half_width + 1) * (float)c->width;
  float b = 0.5f * (1 - (y / z + c->moved[1]) / c->half_height) * (float)c->height;
  if (!(a >= 0 && b >= 0 && a < (float)c->width && b < (float)c->height)) return false;
  *distance = sqrtf(square);
  float cosine = z / *distance;
  for (int k = 0; k < 3; k++) d[k] /= *distance;
  *pixel = (size_t)b * c->width + (size_t)a;
  *per_pixel = 1 / (c->pixel_area * cosine * cosine * cosine);
  return true;
}

/* How many samples of each pixel the camera takes in a pass.
 *
 * What shows in glass changes from place to place within a pixel, and one sample of it is far from
 * the mean where the photons of the same pass have found theirs. So pixels that may show a
 * refractor take as many samples as there is time for. The numbers are fixed before the first
 * pass, so that what is seen has no part in them, and the mean stays unbiased. */

#define ABBE_EYE_MOST_SAMPLES 16

/* samples[height][width]: 1 for what shows receivers alone; else as many as about `rays` rays in
 * all of the picture allow, or up to five times that the more of it is glass; alike for all, 1 to
 * ABBE_EYE_MOST_SAMPLES. */
void abbe_eye_samples_share(const abbe_geometry *geometry, const abbe_trace_camera *camera,
                            double rays, size_t threads, uint8_t *samples);

/* How far the camera sees, mean over places of the picture that show something; frame; 1: none do.
 */
float abbe_eye_samples_depth(const abbe_geometry *geometry, const abbe_trace_camera *camera);

#endif
