/* pleochroism.h: the colours of a crystal that absorbs by the direction of the light's field.
 *
 * Light of D65 through so much of it, for fields along its principal axes x, y and z (z is the
 * optic axis of a uniaxial one), and unpolarised through the faces across them. Reflection is left
 * out. Observer of 1931, 380 to 780 nm.
 */
#ifndef ABBE_COLORIMETRY_PLEOCHROISM_H
#define ABBE_COLORIMETRY_PLEOCHROISM_H

#include "spectral/materials/material.h"

typedef struct abbe_pleochroism {
  double field[3][3];     /* XYZ of light whose field lies along each axis; Y of D65 is 1 */
  double face[3][3];      /* XYZ along each axis, unpolarised: the mean of the other two fields */
  double field_lab[3][3]; /* CIELAB of these, D65 its white */
  double face_lab[3][3];
  double largest; /* CIE 1976 difference of two fields at the most */
  int axis[2];    /* which they are */
} abbe_pleochroism;

/* Through metres >= 0 of the material, which need not be a crystal. */
void abbe_pleochroism_make(const abbe_material *material, double metres, abbe_pleochroism *out);

#endif
