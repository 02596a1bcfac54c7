#include "tests/check.h"

#include "base/maths.h"
#include "scenes/environment/radiance_map.h"

static abbe_radiance_map make(size_t width) {
  abbe_radiance_map map;
  OK(abbe_radiance_map_make(width, &map, &error));
  return map;
}

static abbe_radiance_map pattern(size_t width) {
  abbe_radiance_map map = make(width);
  for (size_t i = 0; i < 3 * map.width * map.height; i++)
    map.rgb[i] = (float)(i * 7919 % 101) / 101;
  return map;
}

static const double normals[][3] = {
    {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-0.6, 0.64, 0.48}, {0.1, -0.7, -0.70710678118654746}};

TEST(where_directions_are) {
  OWNED(abbe_radiance_map, map) = make(64);
  static const struct {
    double direction[3], x, y;
  } cases[] = {{{1, 0, 0}, 32, 16},  {{0, 1, 0}, 16, 16}, {{0, -3, 0}, 48, 16}, {{0, 0, 1}, 32, 0},
               {{0, 0, -1}, 32, 32}, {{1, 0, 1}, 32, 8},  {{-1, 1, 0}, 8, 16}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double x, y, back[3], length = abbe_vector_length(cases[i].direction);
    abbe_radiance_map_place(&map, cases[i].direction, &x, &y);
    assert_near(y, cases[i].y, 1e-12);
    if (y > 0 && y < 32) assert_near(x, cases[i].x, 1e-12);
    abbe_radiance_map_direction(&map, x, y, back);
    for (int k = 0; k < 3; k++) assert_near(back[k], cases[i].direction[k] / length, 1e-12);
  }
}

TEST(solid_angles_add_up) {
  for (size_t width = 4; width <= 8192; width *= 2) {
    const abbe_radiance_map map = {.width = width + (width == 64 ? 2 : 0),
                                   .height = width / 2 + (width == 64)};
    double sum = 0;
    for (size_t row = 0; row < map.height; row++) {
      sum += abbe_radiance_map_solid_angle(&map, row) * (double)map.width;
      assert_true(abbe_radiance_map_solid_angle(&map, row) > 0);
    }
    assert_near(sum, 4 * ABBE_PI, 1e-11);
  }
}

TEST(values_stand_at_middles_and_are_continuous) {
  OWNED(abbe_radiance_map, map) = pattern(16);
  for (size_t y = 0; y < 8; y++)
    for (size_t x = 0; x < 16; x++) {
      double direction[3], rgb[3];
      abbe_radiance_map_direction(&map, (double)x + 0.5, (double)y + 0.5, direction);
      abbe_radiance_map_at(&map, direction, rgb);
      for (size_t k = 0; k < 3; k++) assert_near(rgb[k], map.rgb[3 * (16 * y + x) + k], 1e-12);
    }
  /* over the poles, and where longitude begins again */
  for (int i = 0; i < 64; i++) {
    const double a = 0.1 * i, e = 1e-9;
    const double pairs[3][2][3] = {{{e * cos(a), e * sin(a), 1}, {-e * cos(a), -e * sin(a), 1}},
                                   {{e * cos(a), e * sin(a), -1}, {-e * cos(a), -e * sin(a), -1}},
                                   {{-1, e, cos(a)}, {-1, -e, cos(a)}}};
    for (int p = 0; p < 3; p++) {
      double one[3], other[3];
      abbe_radiance_map_at(&map, pairs[p][0], one);
      abbe_radiance_map_at(&map, pairs[p][1], other);
      for (int k = 0; k < 3; k++) assert_near(one[k], other[k], 1e-6);
    }
  }
}

/* By a midpoint rule of its own. */
TEST(the_mean_is_the_integral) {
  OWNED(abbe_radiance_map, map) = pattern(16);
  double mean[3], sum[3] = {0};
  const int rows = 800, columns = 1600;
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++) {
      const double z = 1 - 2 * (i + 0.5) / rows, a = 2 * ABBE_PI * (j + 0.5) / columns,
                   s = sqrt(1 - z * z);
      double rgb[3];
      abbe_radiance_map_at(&map, (const double[3]){s * cos(a), s * sin(a), z}, rgb);
      for (int k = 0; k < 3; k++) sum[k] += rgb[k] / (rows * columns);
    }
  abbe_radiance_map_mean(&map, mean);
  for (int k = 0; k < 3; k++) assert_near(mean[k], sum[k], 2e-5);
}

TEST(uniform_light) {
  static const size_t widths[] = {4, 8, 100, 512, 1024, 2048};
  for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
    OWNED(abbe_radiance_map, map) = make(widths[w]);
    double rgb[3];
    for (size_t i = 0; i < map.width * map.height; i++) {
      map.rgb[3 * i] = 1;
      map.rgb[3 * i + 1] = 2;
      map.rgb[3 * i + 2] = 0.5f;
    }
    abbe_radiance_map_mean(&map, rgb);
    assert_near(rgb[1], 2, 1e-12);
    for (size_t n = 0; n < sizeof normals / sizeof *normals; n++) {
      abbe_radiance_map_irradiance(&map, normals[n], rgb);
      assert_near(rgb[0] / ABBE_PI, 1, 1e-4);
      assert_near(rgb[1] / ABBE_PI, 2, 2e-4);
      assert_near(rgb[2] / ABBE_PI, 0.5, 5e-5);
    }
  }
}

/* Radiance 1 + n.d: irradiance pi + 2 pi / 3. */
TEST(light_from_one_side) {
  OWNED(abbe_radiance_map, map) = make(512);
  for (size_t n = 0; n < sizeof normals / sizeof *normals; n++) {
    double rgb[3];
    for (size_t i = 0; i < map.width * map.height; i++) {
      double d[3];
      abbe_radiance_map_direction(&map, (double)(i % 512) + 0.5, (double)(i / 512) + 0.5, d);
      map.rgb[3 * i] = (float)fmax(1 + abbe_vector_dot(d, normals[n]), 0);
    }
    abbe_radiance_map_irradiance(&map, normals[n], rgb);
    assert_near(rgb[0], ABBE_PI * (1 + 2.0 / 3), 3e-4);
  }
}

static double sum_over_cells(const abbe_radiance_map *map) {
  double sum = 0;
  for (size_t i = 0; i < map->width * map->height; i++) {
    const double top = ABBE_PI * (double)(i / map->width) / (double)map->height;
    sum += (double)map->rgb[3 * i] * (cos(top) - cos(top + ABBE_PI / (double)map->height)) * 2 *
           ABBE_PI / (double)map->width;
  }
  return sum;
}

TEST(halves_keep_the_light) {
  static const size_t widths[] = {8, 10, 64, 100, 250, 374};
  for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
    OWNED(abbe_radiance_map, map) = pattern(widths[w]);
    while (map.height >= 4) {
      abbe_radiance_map half;
      OK(abbe_radiance_map_halve(&map, &half, &error));
      assert_true(half.height == map.height / 2 && half.width == 2 * half.height);
      assert_near(sum_over_cells(&half) / sum_over_cells(&map), 1, 1e-6);
      abbe_radiance_map_free(&map);
      map = half;
    }
  }
}

TEST(what_is_refused) {
  static const size_t widths[] = {0, 2, 5, 8194, (size_t)-2};
  OWNED(abbe_radiance_map, map) = {0};
  abbe_radiance_map half;
  for (size_t w = 0; w < sizeof widths / sizeof *widths; w++)
    REFUSED(ABBE_INVALID_ARGUMENT, "texels across is not possible",
            abbe_radiance_map_make(widths[w], &map, &error));
  map = make(6);
  REFUSED(ABBE_INVALID_ARGUMENT, "texels is too small to be halved",
          abbe_radiance_map_halve(&map, &half, &error));
  abbe_radiance_map_free(NULL);
}
