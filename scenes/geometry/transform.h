/* transform.h: 4x4 matrices of the graphics pipeline, through GLM.
 *
 * Matrices are column-major double[16] as OpenGL has them; points are columns, right-handed
 * coordinates, the camera looks along -z. Clip space is OpenGL's (z in [-w, w]). The
 * implementation is the C++ bridge transform.cpp. Angles in radians, lengths in metres.
 */
#ifndef ABBE_SCENES_GEOMETRY_TRANSFORM_H
#define ABBE_SCENES_GEOMETRY_TRANSFORM_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

void abbe_transform_identity(double out[16]);
/* out = a * b; out may be a or b. */
void abbe_transform_multiply(const double a[16], const double b[16], double out[16]);
void abbe_transform_translate(const double offset[3], double out[16]);
void abbe_transform_scale(const double factor[3], double out[16]);
/* Right-handed rotation by angle_rad about axis (any length but zero). */
void abbe_transform_rotate(double angle_rad, const double axis[3], double out[16]);
/* World to view. Where up is parallel to the view direction another up is chosen. */
void abbe_transform_look_at(const double eye[3], const double target[3], const double up[3],
                            double out[16]);
/* View to clip; left/right/bottom/top are tangents (perspective) on the plane at distance 1, so
 * that an off-centre frustum needs no second function. 0 < near < far. */
void abbe_transform_perspective(double left, double right, double bottom, double top, double near,
                                double far, double out[16]);
/* View to clip, orthographic, extents in metres. */
void abbe_transform_orthographic(double left, double right, double bottom, double top,
                                 double near, double far, double out[16]);
/* False (out untouched) where the matrix has no inverse. */
bool abbe_transform_inverse(const double m[16], double out[16]);
/* Column-major 3x3 inverse transpose of the upper 3x3, for normals. */
bool abbe_transform_normal_matrix(const double m[16], double out[9]);
/* out = m * (p, 1), divided by w. out may be p. */
void abbe_transform_point(const double m[16], const double p[3], double out[3]);
/* out = m * (d, 0). out may be d. */
void abbe_transform_direction(const double m[16], const double d[3], double out[3]);
double abbe_transform_determinant3(const double m[16]);

#ifdef __cplusplus
}
#endif
#endif
