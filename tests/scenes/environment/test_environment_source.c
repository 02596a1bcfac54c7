#include "tests/check.h"
#include "tests/scenes/environment/irradiance.h"

#include "base/maths.h"
#include "scenes/environment/environment_source.h"

#define DEGREE (ABBE_PI / 180)

static const double up_z[3] = {0, 0, 1};

static void place(abbe_environment_source *s, double elevation, double azimuth) {
  const double e = elevation * DEGREE, a = azimuth * DEGREE;
  const double centre[3] = {cos(e) * cos(a), cos(e) * sin(a), sin(e)};
  const double up[3] = {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)};
  memcpy(s->centre, centre, sizeof centre);
  memcpy(s->up, up, sizeof up);
}

static abbe_radiance_map map_of(size_t width, const abbe_environment_source *s) {
  abbe_radiance_map map;
  OK(abbe_radiance_map_make(width, &map, &error));
  OK(abbe_environment_source_add(s, &map, &error));
  return map;
}

static double integral(const abbe_radiance_map *map, int channel) {
  double mean[3];
  abbe_radiance_map_mean(map, mean);
  return mean[channel] * 4 * ABBE_PI;
}

/* Wherever it stands, and however coarse the map. */
TEST(energies_are_exact) {
  static const double places[][2] = {{90, 0},       {89.9, 40}, {30, 0}, {0, 180},
                                     {-12, -179.9}, {-90, 3},   {60, 77}};
  static const size_t widths[] = {64, 512};
  for (size_t w = 0; w < 2; w++)
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
      for (int kind = 0; kind < 6; kind++) {
        abbe_environment_source s = {.kind = kind < 3   ? ABBE_SOURCE_DISK
                                             : kind < 5 ? ABBE_SOURCE_RECTANGLE
                                                        : ABBE_SOURCE_SPOT,
                                     .radiance = {2, 1, 0.5}};
        static const double radius[] = {0.2665, 7, 100, 0, 0, 2};
        s.radius_rad = radius[kind] * DEGREE;
        s.half_width_rad = (kind == 3 ? 20 : 0.3) * DEGREE;
        s.half_height_rad = (kind == 3 ? 10 : 25) * DEGREE;
        place(&s, places[i][0], places[i][1]);
        if ((w == 1) != (i % 3 == 0)) continue;
        OWNED(abbe_radiance_map, map) = map_of(widths[w], &s);
        const double solid = abbe_environment_source_solid_angle(&s);
        assert_near(integral(&map, 0) / (2 * solid), 1, 1e-6);
        assert_near(integral(&map, 2) / (0.5 * solid), 1, 1e-6);
      }
}

TEST(known_solid_angles) {
  abbe_environment_source s = {.kind = ABBE_SOURCE_DISK, .radius_rad = ABBE_PI / 2};
  assert_near(abbe_environment_source_solid_angle(&s), 2 * ABBE_PI, 1e-12);
  s = (abbe_environment_source){
      .kind = ABBE_SOURCE_RECTANGLE, .half_width_rad = ABBE_PI / 4, .half_height_rad = ABBE_PI / 4};
  assert_near(abbe_environment_source_solid_angle(&s), 4 * ABBE_PI / 6, 1e-12); /* a cube's face */
  s = (abbe_environment_source){.kind = ABBE_SOURCE_SPOT, .radius_rad = 0.01};
  assert_near(abbe_environment_source_solid_angle(&s) / (2 * ABBE_PI * 1e-4), 1, 1e-4);
  assert_near(abbe_environment_source_spot_sigma(abbe_environment_source_solid_angle(&s)), 0.01,
              1e-9);
}

/* A disk overhead: pi L sin^2; the sun: its irradiance, times the sine of its elevation. */
TEST(known_irradiances) {
  double rgb[3];
  abbe_environment_source s = {
      .kind = ABBE_SOURCE_DISK, .radiance = {1, 1, 1}, .radius_rad = 30 * DEGREE};
  place(&s, 90, 0);
  OWNED(abbe_radiance_map, map) = map_of(1024, &s);
  irradiance_of_map(&map, up_z, rgb);
  assert_near(rgb[0] / (ABBE_PI * 0.25), 1, 1e-4);
  abbe_radiance_map_free(&map);
  for (double elevation = 5; elevation <= 90; elevation += 42.5) {
    s.radius_rad = 0.2665 * DEGREE;
    for (int k = 0; k < 3; k++)
      s.radiance[k] = abbe_environment_source_disk_radiance(800, s.radius_rad);
    place(&s, elevation, 33);
    map = map_of(1024, &s);
    irradiance_of_map(&map, s.centre, rgb);
    assert_near(rgb[0] / 800, 1, 1e-4);
    irradiance_of_map(&map, up_z, rgb);
    assert_near(rgb[0] / (800 * sin(elevation * DEGREE)), 1, 1e-4);
    abbe_radiance_map_free(&map);
  }
  /* a rectangle is what a flat window is: inside its edges, not outside */
  s = (abbe_environment_source){.kind = ABBE_SOURCE_RECTANGLE,
                                .radiance = {3, 3, 3},
                                .half_width_rad = 20 * DEGREE,
                                .half_height_rad = 5 * DEGREE};
  place(&s, 0, 90);
  map = map_of(1024, &s);
  abbe_radiance_map_at(&map, (const double[3]){tan(19 * DEGREE), 1, tan(4 * DEGREE)}, rgb);
  assert_near(rgb[0], 3, 1e-3);
  abbe_radiance_map_at(&map, (const double[3]){tan(19 * DEGREE), 1, tan(6 * DEGREE)}, rgb);
  assert_near(rgb[0], 0, 1e-12);
  abbe_radiance_map_at(&map, (const double[3]){tan(21 * DEGREE), 1, tan(4 * DEGREE)}, rgb);
  assert_near(rgb[0], 0, 1e-12);
}

TEST(skies) {
  double rgb[3];
  for (int type = 1; type <= ABBE_SKY_TYPES; type += SANITIZED ? 7 : 1) {
    const abbe_environment_source s = {
        .kind = ABBE_SOURCE_SKY, .radiance = {2, 2, 2}, .sky = {type, {sin(1), 0, cos(1)}}};
    OWNED(abbe_radiance_map, map) = map_of(1024, &s);
    irradiance_of_map(&map, up_z, rgb);
    assert_near(rgb[0] / (2 * abbe_sky_horizontal(&s.sky)), 1, 1e-4);
    irradiance_of_map(&map, (const double[3]){0, 0, -1}, rgb);
    assert_near(rgb[0], 0, 1e-3);
  }
}

TEST(domes) {
  const abbe_dome_knot iso[] = {{0, {1, 1, 1}}, {ABBE_PI / 2, {1, 1, 1}}};
  const abbe_dome_knot bands[] = {{0, {0, 1, 0}},           {45 * DEGREE, {0, 1, 0}},
                                  {45 * DEGREE, {1, 0, 0}}, {75 * DEGREE, {1, 0, 0}},
                                  {75 * DEGREE, {0, 0, 1}}, {90 * DEGREE, {0, 0, 1}}};
  double rgb[3];
  abbe_environment_source s = {
      .kind = ABBE_SOURCE_DOME, .radiance = {2, 2, 2}, .knot_count = 2, .knot = iso};
  OWNED(abbe_radiance_map, map) = map_of(1024, &s);
  irradiance_of_map(&map, up_z, rgb);
  assert_near(rgb[0] / (2 * ABBE_PI), 1, 1e-4);
  assert_near(integral(&map, 0) / (4 * ABBE_PI), 1, 1e-4);
  abbe_radiance_map_free(&map);
  s.knot_count = 6;
  s.knot = bands;
  map = map_of(1024, &s);
  const double solid[] = {sin(75 * DEGREE) - sin(45 * DEGREE), sin(45 * DEGREE),
                          1 - sin(75 * DEGREE)};
  for (int k = 0; k < 3; k++) assert_near(integral(&map, k) / (4 * ABBE_PI * solid[k]), 1, 1e-4);
}

TEST(sources_add_up) {
  abbe_environment_source s = {.kind = ABBE_SOURCE_UNIFORM, .radiance = {1, 2, 3}};
  OWNED(abbe_radiance_map, map) = map_of(64, &s);
  s = (abbe_environment_source){.kind = ABBE_SOURCE_DISK, .radiance = {1, 1, 1}, .radius_rad = 0.3};
  place(&s, 20, 20);
  OK(abbe_environment_source_add(&s, &map, &error));
  OK(abbe_environment_source_add(&s, &map, &error));
  const double solid = abbe_environment_source_solid_angle(&s);
  assert_near(integral(&map, 1), 8 * ABBE_PI + 2 * solid, 1e-5);
}

TEST(what_is_refused) {
  static const abbe_environment_source bad[] = {
      {.kind = ABBE_SOURCE_DISK, .radius_rad = 1e-5},
      {.kind = ABBE_SOURCE_DISK, .radius_rad = NAN},
      {.kind = ABBE_SOURCE_SPOT, .radius_rad = 3},
      {.kind = ABBE_SOURCE_RECTANGLE, .half_width_rad = 1, .half_height_rad = 1.6},
      {.kind = ABBE_SOURCE_SKY, .sky = {17, {0, 0, 1}}},
  };
  MADE(abbe_radiance_map, map, abbe_radiance_map_make(16, &map, &error));
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "a source of the surroundings has a size or a",
            abbe_environment_source_add(&bad[i], &map, &error));
}
