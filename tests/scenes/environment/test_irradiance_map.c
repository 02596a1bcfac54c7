/* Irradiance by normal: nodes, and how far off it is between them. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/environment/radiance_map.h"

enum { ROWS = ABBE_IRRADIANCE_MAP_ROWS, COLUMNS = ABBE_IRRADIANCE_MAP_COLUMNS };

/* Of parallel light from a place of the sphere. */
static void fill(const double from[3], abbe_irradiance_map *out) {
  for (size_t row = 0; row < ROWS; row++)
    for (size_t column = 0; column < COLUMNS; column++) {
      double n[3];
      abbe_irradiance_map_normal(row, column, n);
      for (int k = 0; k < 3; k++)
        out->rgb[row][column][k] = (float)((k + 1) * fmax(abbe_vector_dot(n, from), 0));
    }
}

TEST(axes_are_nodes) {
  static const double axes[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  double from[3] = {0.3, -0.5, 0.7}, rgb[3];
  abbe_irradiance_map map;
  abbe_vector_normalise(from);
  fill(from, &map);
  for (int i = 0; i < 6; i++) {
    abbe_irradiance_map_at(&map, axes[i], rgb);
    for (int k = 0; k < 3; k++)
      assert_near(rgb[k], (k + 1) * fmax(abbe_vector_dot(axes[i], from), 0), 1e-6);
  }
}

/* Linear between nodes 9 degrees apart: a cosine is off by at most 2 (pi/40)^2 / 2 of the greatest,
 * from the two directions together, but within a step of where it ends. */
TEST(planes_between_nodes) {
  const double step = 3.14159265358979 / (ROWS - 1);
  for (int i = 0; i < 200; i++) {
    double from[3], n[3], rgb[3];
    abbe_irradiance_map map;
    for (int k = 0; k < 3; k++) {
      from[k] = sin(7.1 * i + 3 * k + 1);
      n[k] = sin(3.3 * i + 5 * k + 2);
    }
    abbe_vector_normalise(from);
    abbe_vector_normalise(n);
    fill(from, &map);
    abbe_irradiance_map_at(&map, n, rgb);
    const double right = abbe_vector_dot(n, from), off = fabs(rgb[0] - fmax(right, 0));
    assert_true(off < (fabs(right) > 2 * step ? step * step / 4 : step / 2));
  }
}
