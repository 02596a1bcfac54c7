#include "colorimetry/gamut/oklab.h"

#include "colorimetry/matrix3.h"
#include "colorimetry/rgb_space.h"

#include <math.h>

/* [Ottosson2020]: XYZ to cones, their cube roots to L, a, b. */
static const double cones[9] = {0.8189330101, 0.3618667424, -0.1288597137,
                                0.0329845436, 0.9293118715, 0.0361456387,
                                0.0482003018, 0.2643662691, 0.6338517070};
static const double opponents[9] = {0.2104542553, 0.7936177850,  -0.0040720468,
                                    1.9779984951, -2.4285922050, 0.4505937099,
                                    0.0259040371, 0.7827717662,  -0.8086757660};

void abbe_oklab_of_xyz(const double xyz[3], double lab[3]) {
  double v[3];
  abbe_rgb_space_apply(cones, xyz, v);
  for (int c = 0; c < 3; c++) v[c] = cbrt(v[c]);
  abbe_rgb_space_apply(opponents, v, lab);
}

void abbe_oklab_to_xyz(const double lab[3], double xyz[3]) {
  double inverse[9], v[3];
  abbe_matrix3_invert(opponents, inverse);
  abbe_rgb_space_apply(inverse, lab, v);
  for (int c = 0; c < 3; c++) v[c] = v[c] * v[c] * v[c];
  abbe_matrix3_invert(cones, inverse);
  abbe_rgb_space_apply(inverse, v, xyz);
}
