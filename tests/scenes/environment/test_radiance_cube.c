/* A cube of a map: directions, solid angles, and the same light in every level. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/environment/environment_source.h"
#include "scenes/environment/radiance_map.h"

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
  abbe_radiance_cube cube;
  const size_t wrong[] = {0, 3, 100, 2048};
  for (size_t i = 0; i < 4; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "a power of two",
            abbe_radiance_cube_make(&map, wrong[i], &cube, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a cube of a map without texels",
          abbe_radiance_cube_make(&map, 16, &cube, &error));
  abbe_radiance_cube_free(&cube);
  abbe_radiance_cube_free(NULL);
}
