/* view.h: what a light or the camera looks through: a frustum from a point or along a direction.
 *
 * The window is left, right, bottom, top: tangents on the plane at distance 1 (perspective) or
 * metres (orthographic), off-centre where that fits tighter. Doubles; the shaders' View is its
 * float copy. Lengths in metres, world coordinates. */
#ifndef ABBE_SCENES_VIEW_VIEW_H
#define ABBE_SCENES_VIEW_VIEW_H

#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_view {
  bool orthographic;
  double origin[3];
  double right[3], up[3], forward[3]; /* unit, right-handed with -forward */
  double window[4];                   /* left, right, bottom, top */
  double near, far;                   /* along forward; 0 < near < far */
} abbe_view;

/* Widest tangent of a fitted window: 76 degrees off axis. */
#define ABBE_VIEW_MAX_TANGENT 4.0

/* An empty view from origin along forward (any length but zero); up is a hint. */
void abbe_view_look(const double origin[3], const double forward[3], const double up[3],
                    bool orthographic, abbe_view *out);

/* Grows window, near and far around the points. Returns false where a point lies behind the
 * origin or beyond ABBE_VIEW_MAX_TANGENT; the window then ends there. */
bool abbe_view_fit(abbe_view *view, const double (*points)[3], size_t count);

/* Widens window and depth range by the share (0.02: 2 % of each side), and keeps both non-empty. */
void abbe_view_pad(abbe_view *view, double share);

/* Widens the shorter side of the window to the longer, about its middle. */
void abbe_view_square(abbe_view *view);

/* Column-major world-to-clip matrix. */
void abbe_view_matrix(const abbe_view *view, double out[16]);

/* The same with depths for a buffer of floats, from 1 at near to 0 at infinity (perspective, where
 * far does not matter) or at far: a float resolves depths to 2^-23 of them at any distance, however
 * close near is. */
void abbe_view_reversed_matrix(const abbe_view *view, double out[16]);

/* uv in [0, 1] inside the window, and the distance along the ray (perspective) or along forward.
 * False behind the origin. */
bool abbe_view_project(const abbe_view *view, const double p[3], double uvz[3]);

/* The ray through uv: origin and unit direction. */
void abbe_view_ray(const abbe_view *view, const double uv[2], double origin[3],
                   double direction[3]);

/* Area of the whole window: solid-angle measure at its axis (sr) or m2. */
double abbe_view_area(const abbe_view *view);

/* The shaders' View: six vec4 (origin and kind, right, up, forward, window, range). */
void abbe_view_pack(const abbe_view *view, float out[24]);

/* How much of each pixel objects cover, as the camera sees them: the alpha of a picture
 * without what lies behind.
 *
 * Camera rays through the centres of samples x samples parts of a pixel against all objects'
 * triangles. Lights are not objects. */

/* An image of one channel, A, from 0 to 1, rows downwards, of a camera that is sharp whatever its
 * aperture. samples: 1 to 16. ABBE_NO_MEMORY. */
abbe_result abbe_coverage_make(const abbe_scene *scene, size_t width, size_t height, size_t samples,
                               abbe_image *out, abbe_error *error);

#endif
