/* view_camera.h: a camera that is led by hand: around its target, sideways, nearer, about its eye.
 *
 * Plain maths on the scene's camera. Its `up` stays as it is; no move brings the view nearer to it
 * than a degree. "right" and "up" are the camera's own. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_CAMERA_H
#define ABBE_CLI_VIEW_STATE_VIEW_CAMERA_H

#include "scenes/scene.h"

/* The camera goes to the right and up around the target, the distance kept. */
void abbe_view_camera_orbit(abbe_camera *camera, double right_rad, double up_rad);
/* The view turns to the right and up about the camera. */
void abbe_view_camera_look(abbe_camera *camera, double right_rad, double up_rad);
/* Eye and target go to the right and up, by shares of the picture's height at the target. */
void abbe_view_camera_pan(abbe_camera *camera, double right, double up);
/* The distance to the target is multiplied. */
void abbe_view_camera_zoom(abbe_camera *camera, double factor);
/* Eye and target go right, up and forward, m. */
void abbe_view_camera_fly(abbe_camera *camera, const double step[3]);

/* Where a point shows in a picture of that size, pixels from its upper left corner; false behind
 * the camera. */
bool abbe_view_camera_project(const abbe_camera *camera, size_t width, size_t height,
                              const double point[3], double xy[2]);

/* Where an arrow at the picture's edge, so many pixels inside, points to what is out of it or
 * behind the camera, and the arrow's direction, unit; false where the point shows in the picture.
 */
bool abbe_view_camera_beyond(const abbe_camera *camera, size_t width, size_t height,
                             const double point[3], double inside, double xy[2], double way[2]);

/* The point that a place in the picture shows, so far from the camera, m. */
void abbe_view_camera_point(const abbe_camera *camera, size_t width, size_t height,
                            const double xy[2], double distance, double out[3]);

typedef enum abbe_view_drag {
  ABBE_VIEW_DRAG_LEVEL,  /* in the plane across `up` through the point */
  ABBE_VIEW_DRAG_UPRIGHT /* along `up` */
} abbe_view_drag;

/* Where the point goes when what shows it is drawn from pixel `from` to pixel `to`. False where no
 * place answers to that, as above the horizon; out is then the point. out may be the point. */
bool abbe_view_camera_drag(const abbe_camera *camera, size_t width, size_t height,
                           abbe_view_drag drag, const double point[3], const double from[2],
                           const double to[2], double out[3]);

#endif
