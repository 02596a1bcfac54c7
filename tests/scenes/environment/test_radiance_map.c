#include "tests/check.h"

#include "base/maths.h"
#include "scenes/environment/environment_source.h"
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

/* A cube of a map: directions, solid angles, and the same light in every level. */

TEST(solid_angles_fill_the_sphere) {
  for (size_t side = 1; side <= 32; side *= 2) {
    double sum = 0;
    for (size_t i = 0; i < side * side; i++)
      sum += 6 * abbe_radiance_cube_solid_angle(side, i % side, i / side);
    assert_near(sum, 4 * ABBE_PI, 1e-12);
  }
}

/* As OpenGL finds them: the major axis is the face, and what goes with it the place. */
TEST(directions_are_opengls) {
  static const int major[6] = {0, 0, 1, 1, 2, 2};
  for (size_t face = 0; face < 6; face++) {
    const double x = 0.7, y = 0.2, sign = face % 2 == 0 ? 1 : -1;
    double d[3];
    abbe_radiance_cube_direction(face, x, y, d);
    const int m = major[face];
    const double ma = fabs(d[m]);
    assert_true(sign * d[m] > 0 && ma >= fabs(d[(m + 1) % 3]) && ma >= fabs(d[(m + 2) % 3]));
    const double sc = m == 0 ? -sign * d[2] : m == 1 ? d[0] : sign * d[0];
    const double tc = m == 1 ? sign * d[2] : -d[1];
    assert_near(0.5 * (sc / ma + 1), x, 1e-12);
    assert_near(0.5 * (tc / ma + 1), y, 1e-12);
  }
}

static void make_map(abbe_radiance_map *map) {
  const abbe_environment_source dusk = {.kind = ABBE_SOURCE_UNIFORM, .radiance = {0.2, 0.3, 0.5}};
  abbe_environment_source spot = FIELDS(.kind = ABBE_SOURCE_SPOT, .radiance = {40, 30, 20},
                                        .centre = {0.6, 0, 0.8}, .radius_rad = 0.05);
  OK(abbe_radiance_map_make(512, map, &error));
  OK(abbe_environment_source_add(&dusk, map, &error));
  OK(abbe_environment_source_add(&spot, map, &error));
}

TEST(every_level_holds_the_light) {
  double mean[3], first[3] = {0, 0, 0};
  FILLED(abbe_radiance_map, map, make_map(&map));
  abbe_radiance_map_mean(&map, mean);
  MADE(abbe_radiance_cube, cube, abbe_radiance_cube_make(&map, 128, &cube, &error));
  assert_int_equal(cube.level_count, 8);
  for (size_t k = 0; k < cube.level_count; k++) {
    const size_t side = cube.side >> k;
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < 6 * side * side; i++)
      for (size_t c = 0; c < 3; c++)
        sum[c] += (double)cube.level[k][3 * i + c] *
                  abbe_radiance_cube_solid_angle(side, i % side, i / side % side) / (4 * ABBE_PI);
    for (int c = 0; c < 3; c++) {
      if (k == 0) first[c] = sum[c];
      assert_near(sum[c], mean[c], 2e-3 * mean[c]);
      assert_near(sum[c], first[c], 1e-5 * mean[c]);
    }
  }
}

/* The texel beyond an edge is that of the neighbour which shares the edge: directions of both are
 * as far apart as of two texels beside each other. */
TEST(borders_are_the_neighbours) {
  enum { SIDE = 8, TEXELS = 6 * SIDE * SIDE };
  float level[3 * TEXELS];
  const abbe_radiance_cube cube = {.side = SIDE, .level_count = 1, .level = {level}};
  for (size_t i = 0; i < TEXELS; i++) { /* each holds its own direction */
    double d[3];
    abbe_radiance_cube_direction(i / (SIDE * SIDE), ((double)(i % SIDE) + 0.5) / SIDE,
                                 ((double)(i / SIDE % SIDE) + 0.5) / SIDE, d);
    for (int k = 0; k < 3; k++) level[3 * i + (size_t)k] = (float)d[k];
  }
  for (size_t face = 0; face < 6; face++)
    for (size_t at = 1; at <= SIDE; at++)
      for (int edge = 0; edge < 4; edge++) {
        const size_t far = edge % 2 == 0 ? 0 : SIDE + 1, near = edge % 2 == 0 ? 1 : SIDE;
        float out[3], in[3];
        abbe_radiance_cube_bordered(&cube, 0, face, edge < 2 ? far : at, edge < 2 ? at : far, out);
        abbe_radiance_cube_bordered(&cube, 0, face, edge < 2 ? near : at, edge < 2 ? at : near, in);
        /* they mirror each other in the plane through the edge, where two components are alike */
        double between[3], size = 0, edge_like = 0;
        for (int k = 0; k < 3; k++) between[k] = 0.5 * ((double)out[k] + (double)in[k]);
        for (int k = 0; k < 3; k++) size = fmax(size, fabs(between[k]));
        for (int k = 0; k < 3; k++) edge_like += fabs(fabs(between[k]) - size) < 1e-6;
        assert_true(edge_like >= 2);
        assert_true(pow((double)out[0] - (double)in[0], 2) +
                        pow((double)out[1] - (double)in[1], 2) +
                        pow((double)out[2] - (double)in[2], 2) <
                    pow(2.5 / SIDE, 2));
      }
  for (size_t face = 0; face < 6; face++) {
    float corner[3];
    abbe_radiance_cube_bordered(&cube, 0, face, 0, SIDE + 1, corner);
    for (int k = 1; k < 3; k++) assert_near(fabs((double)corner[k]), fabs((double)corner[0]), 1e-6);
  }
}

/* Where the map is smooth a texel is what the map shows in its direction. */
TEST(texels_show_the_map) {
  FILLED(abbe_radiance_map, map, make_map(&map));
  MADE(abbe_radiance_cube, cube, abbe_radiance_cube_make(&map, 256, &cube, &error));
  for (size_t i = 0; i < 6 * 256 * 256; i += 97) {
    double d[3], rgb[3];
    abbe_radiance_cube_direction(i / 65536, ((double)(i % 256) + 0.5) / 256,
                                 ((double)(i / 256 % 256) + 0.5) / 256, d);
    abbe_radiance_map_at(&map, d, rgb);
    for (size_t c = 0; c < 3; c++) assert_near((double)cube.level[0][3 * i + c], rgb[c], 0.6);
    if (d[0] < 0) assert_near((double)cube.level[0][3 * i + 1], 0.3, 1e-6);
  }
}

TEST(wrong_sides) {
  abbe_radiance_map map = {0};
  OWNED(abbe_radiance_cube, cube) = {0};
  const size_t wrong[] = {0, 3, 100, 2048};
  for (size_t i = 0; i < 4; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "a power of two",
            abbe_radiance_cube_make(&map, wrong[i], &cube, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a cube of a map without texels",
          abbe_radiance_cube_make(&map, 16, &cube, &error));
  abbe_radiance_cube_free(NULL);
}

/* Irradiance by normal: nodes, and how far off it is between them. */

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
