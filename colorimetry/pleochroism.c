#include "colorimetry/pleochroism.h"

#include "colorimetry/difference.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"
#include "spectral/wavelengths.h"

#include <math.h>

/* XYZ of the fields, and the white's, whose Y is 1. */
static void see(const abbe_material *m, double metres, abbe_pleochroism *out, double white[3]) {
  const abbe_illuminant d65 = {0};
  for (double nm = ABBE_WAVELENGTH_MIN_NM + 0.5; nm < ABBE_WAVELENGTH_MAX_NM; nm += 1) {
    double bar[3];
    const double power = abbe_illuminant_power(&d65, nm);
    abbe_observer_xyz(nm, bar);
    for (int c = 0; c < 3; c++) white[c] += power * bar[c];
    for (int axis = 0; axis < 3; axis++) {
      const double left = exp(-abbe_material_attenuation_along(m, axis, nm) * metres);
      for (int c = 0; c < 3; c++) out->field[axis][c] += power * bar[c] * left;
    }
  }
  const double scale = 1 / white[1];
  for (int c = 0; c < 3; c++) {
    white[c] *= scale;
    for (int axis = 0; axis < 3; axis++) out->field[axis][c] *= scale;
  }
}

void abbe_pleochroism_make(const abbe_material *material, double metres, abbe_pleochroism *out) {
  double white[3] = {0};
  *out = (abbe_pleochroism){.axis = {0, 2}};
  see(material, metres, out, white);
  for (int axis = 0; axis < 3; axis++) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int c = 0; c < 3; c++) out->face[axis][c] = (out->field[a][c] + out->field[b][c]) / 2;
    abbe_difference_lab(out->field[axis], white, out->field_lab[axis]);
    abbe_difference_lab(out->face[axis], white, out->face_lab[axis]);
  }
  for (int a = 0; a < 3; a++)
    for (int b = a + 1; b < 3; b++) {
      const double off = abbe_difference_cie76(out->field_lab[a], out->field_lab[b]);
      if (!(off > out->largest)) continue;
      out->largest = off;
      out->axis[0] = a;
      out->axis[1] = b;
    }
}
