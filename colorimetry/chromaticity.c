#include "colorimetry/chromaticity.h"

#include "colorimetry/observer_tables.h"

#include <math.h>

bool abbe_chromaticity_xy(const double xyz[3], double xy[2]) {
  const double sum = xyz[0] + xyz[1] + xyz[2];
  if (!(sum > 0 && xyz[1] > 0 && isfinite(sum))) return false;
  xy[0] = xyz[0] / sum;
  xy[1] = xyz[1] / sum;
  return true;
}

bool abbe_chromaticity_xyz(const double xy[2], double xyz[3]) {
  if (!(xy[1] > 0 && isfinite(xy[0]) && isfinite(xy[1]))) return false;
  xyz[0] = xy[0] / xy[1];
  xyz[1] = 1;
  xyz[2] = (1 - xy[0] - xy[1]) / xy[1];
  return true;
}

void abbe_chromaticity_uv_of_xy(const double xy[2], double uv[2]) {
  const double below = -2 * xy[0] + 12 * xy[1] + 3, x = xy[0], y = xy[1];
  uv[0] = 4 * x / below;
  uv[1] = 9 * y / below;
}

void abbe_chromaticity_locus_ends(abbe_observer observer, double *min_nm, double *max_nm) {
  const bool known = (unsigned)observer < ABBE_OBSERVER_COUNT;
  *min_nm = known ? fmax(380, abbe_observer_tables[observer].first_nm) : NAN;
  *max_nm = known ? 700 : NAN;
}

void abbe_chromaticity_locus(abbe_observer observer, double lambda_nm, double xy[2]) {
  double min, max, xyz[3];
  abbe_chromaticity_locus_ends(observer, &min, &max);
  abbe_observer_xyz_of(observer, fmin(fmax(lambda_nm, min), max), xyz);
  if (!abbe_chromaticity_xy(xyz, xy)) xy[0] = xy[1] = NAN;
}

/* How far to the left of the line from `white` along `way` the locus is at lambda_nm; *ahead is how
 * far along it. */
static double side(abbe_observer observer, double lambda_nm, const double white[2],
                   const double way[2], double *ahead) {
  double xy[2];
  abbe_chromaticity_locus(observer, lambda_nm, xy);
  const double dx = xy[0] - white[0], dy = xy[1] - white[1];
  *ahead = dx * way[0] + dy * way[1];
  return way[0] * dy - way[1] * dx;
}

/* The wavelength between two, on either side of the line, where the locus crosses it. */
static double cross(abbe_observer observer, double low_nm, double high_nm, const double white[2],
                    const double way[2], double *ahead) {
  const double at_low = side(observer, low_nm, white, way, ahead);
  for (int i = 0; i < 50; i++) {
    const double middle = (low_nm + high_nm) / 2, at = side(observer, middle, white, way, ahead);
    if ((at < 0) == (at_low < 0))
      low_nm = middle;
    else
      high_nm = middle;
  }
  return (low_nm + high_nm) / 2;
}

/* Where the ray from the white along a unit vector meets the locus (the wavelength) or the purple
 * line (NaN); *distance to it, NaN where it meets neither. */
static double meet(abbe_observer observer, const double white[2], const double way[2],
                   double *distance) {
  double min, max, found = NAN, ahead, before, first_ahead, last_ahead;
  *distance = NAN;
  abbe_chromaticity_locus_ends(observer, &min, &max);
  before = side(observer, min, white, way, &first_ahead);
  const double first = before;
  for (double nm = min + 1; nm <= max; nm++) {
    const double at = side(observer, nm, white, way, &ahead);
    if ((at < 0) != (before < 0)) {
      const double lambda_nm = cross(observer, nm - 1, nm, white, way, &ahead);
      /* rounded tables make the locus' ends jagged: what is furthest out counts */
      if (ahead > 0 && !(ahead <= *distance)) {
        found = lambda_nm;
        *distance = ahead;
      }
    }
    before = at;
  }
  const double last = side(observer, max, white, way, &last_ahead);
  if ((first < 0) == (last < 0)) return found;
  const double purple = first_ahead + (last_ahead - first_ahead) * first / (first - last);
  if (purple > 0 && !(purple <= *distance)) {
    found = NAN;
    *distance = purple;
  }
  return found;
}

bool abbe_chromaticity_dominant(const double xy[2], const double white[2], abbe_observer observer,
                                abbe_dominant *out) {
  *out = (abbe_dominant){NAN, NAN, NAN};
  const double dx = xy[0] - white[0], dy = xy[1] - white[1], length = hypot(dx, dy);
  if (!isfinite(length)) return false;
  if (length < 1e-7) {
    out->purity = 0;
    return false;
  }
  const double way[2] = {dx / length, dy / length}, back[2] = {-way[0], -way[1]};
  double out_there, behind;
  const double lambda_nm = meet(observer, white, way, &out_there);
  const double complementary_nm = meet(observer, white, back, &behind);
  if (!(out_there > 0 && behind > 0)) return false;
  *out = (abbe_dominant){lambda_nm, complementary_nm, length / out_there};
  return true;
}
