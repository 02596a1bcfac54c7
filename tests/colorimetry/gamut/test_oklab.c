/* Oklab against the table of its author. */
#include "tests/check.h"

#include "colorimetry/gamut/oklab.h"

TEST(published_table) {
  static const double rows[4][6] = {{0.950, 1, 1.089, 1, 0, 0},
                                    {1, 0, 0, 0.450, 1.236, -0.019},
                                    {0, 1, 0, 0.922, -0.671, 0.263},
                                    {0, 0, 1, 0.153, -1.415, -0.449}};
  for (int i = 0; i < 4; i++) {
    double lab[3], xyz[3];
    abbe_oklab_of_xyz(rows[i], lab);
    for (int c = 0; c < 3; c++) assert_near(lab[c], rows[i][3 + c], 6e-4);
    abbe_oklab_to_xyz(lab, xyz);
    for (int c = 0; c < 3; c++) assert_near(xyz[c], rows[i][c], 1e-12);
  }
}

/* Eight times the light is twice L, a and b. */
TEST(exposure) {
  const double xyz[3] = {0.3, 0.2, -0.01}, eight[3] = {2.4, 1.6, -0.08};
  double lab[2][3];
  abbe_oklab_of_xyz(xyz, lab[0]);
  abbe_oklab_of_xyz(eight, lab[1]);
  for (int c = 0; c < 3; c++) assert_near(lab[1][c], 2 * lab[0][c], 1e-12);
}
