#include "tests/check.h"

#include "base/maths.h"
#include "scenes/environment/environment.h"
#include "scenes/environment/environment_source.h"
#include "tests/random.h"

/* Grey noise with black places, a bright spot at the zenith and one where longitude begins again.
 */
static void fill(abbe_radiance_map *map) {
  for (size_t i = 0; i < map->width * map->height; i++) {
    const float value = i * 7919 % 101 < 40 ? 0 : (float)(i * 7919 % 101) / 101;
    for (size_t k = 0; k < 3; k++) map->rgb[3 * i + k] = value;
  }
  for (size_t k = 0; k < 3; k++) map->rgb[3 * 2 + k] = 200;
  for (size_t k = 0; k < 3; k++) map->rgb[3 * map->width * (map->height / 3) + k] = 50;
  for (size_t k = 0; k < 3; k++) map->rgb[3 * (map->width * map->height - 3) + k] = 20;
}

static void make(size_t width, abbe_environment *out) {
  *out = (abbe_environment){0};
  OK(abbe_radiance_map_make(width, &out->map, &error));
  fill(&out->map);
  abbe_environment_turn(0.7, (const double[3]){1, 2, 0.5}, -1.1, out->to_map);
  OK(abbe_environment_prepare(out, &error));
}

TEST(densities_integrate_to_one) {
  static const size_t widths[] = {4, 6, 16, 36};
  for (size_t w = 0; w < 4; w++) {
    double sum = 0, mean = 0;
    FILLED(abbe_environment, e, make(widths[w], &e));
    const int rows = 500, columns = 1000;
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < columns; j++) {
        const double z = 1 - 2 * (i + 0.5) / rows, a = 2 * ABBE_PI * (j + 0.5) / columns;
        const double s = sqrt(1 - z * z), d[3] = {s * cos(a), s * sin(a), z};
        double rgb[3];
        sum += abbe_environment_pdf(&e, d) * 4 * ABBE_PI / (rows * columns);
        abbe_environment_radiance(&e, d, rgb);
        mean += rgb[0] / (rows * columns);
      }
    assert_near(sum, 1, 3e-4);
    assert_near(mean, e.mean[0], 3e-4 * e.mean[0]);
    assert_near(e.luminance, 4 * ABBE_PI * e.mean[0], 1e-9 * e.luminance);
  }
}

/* Each sample's radiance over density is the integral itself, and samples lie as the density says:
 * their shares of the octants, of a cap around a pole and moments. */
TEST(samples_follow_their_density) {
  static const size_t widths[] = {4, 6, 16, 36};
  for (size_t w = 0; w < 4; w++) {
    double is[12] = {0}, expected[12] = {0};
    FILLED(abbe_environment, e, make(widths[w], &e));
    enum { SAMPLES = 200000 };
    uint64_t state64 = 1;
    for (int i = 0; i < SAMPLES; i++) {
      const double u[3] = {random_between(&state64, 0, 1), random_between(&state64, 0, 1),
                           random_between(&state64, 0, 1)};
      double d[3], pdf, rgb[3], own[3], seen[3];
      abbe_environment_sample(&e, u, d, &pdf, seen);
      assert_true(pdf > 0);
      if (i % 100 == 0) {
        assert_near(abbe_vector_length(d), 1, 1e-12);
        assert_near(abbe_environment_pdf(&e, d), pdf, 1e-9 * pdf + 1e-12);
        abbe_environment_radiance(&e, d, rgb);
        for (int k = 0; k < 3; k++) assert_near(seen[k], rgb[k], 1e-9 * e.luminance);
        assert_near(rgb[1] / pdf, e.luminance, 1e-6 * e.luminance);
      }
      for (int k = 0; k < 3; k++) own[k] = abbe_vector_dot(e.to_map + 3 * k, d);
      is[(own[0] > 0) + 2 * (own[1] > 0) + 4 * (own[2] > 0)] += 1.0 / SAMPLES;
      is[8] += (own[2] > 0.98) * 1.0 / SAMPLES;
      for (int k = 0; k < 3; k++) is[9 + k] += own[k] / SAMPLES;
    }
    const int rows = 500, columns = 1000;
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < columns; j++) {
        const double z = 1 - 2 * (i + 0.5) / rows, a = 2 * ABBE_PI * (j + 0.5) / columns;
        const double s = sqrt(1 - z * z), own[3] = {s * cos(a), s * sin(a), z};
        double rgb[3];
        abbe_radiance_map_at(&e.map, own, rgb);
        const double share = rgb[0] / e.luminance * 4 * ABBE_PI / (rows * columns);
        expected[(own[0] > 0) + 2 * (own[1] > 0) + 4 * (own[2] > 0)] += share;
        expected[8] += (own[2] > 0.98) * share;
        for (int k = 0; k < 3; k++) expected[9 + k] += own[k] * share;
      }
    for (int i = 0; i < 12; i++) assert_near(is[i], expected[i], 0.005);
  }
}

/* The ends of [0, 1): nothing is outside, and no sample is where it is dark. */
TEST(extreme_numbers) {
  static const double ends[] = {0, 0x1p-60, 0.5, 1 - 0x1p-53};
  FILLED(abbe_environment, e, make(16, &e));
  for (int i = 0; i < 64; i++)
    for (int j = 0; j < 128; j++) {
      const double u[3] = {(j + 0.5) / 128, ends[i % 4], ends[i / 4 % 4]};
      double d[3], pdf, seen[3];
      abbe_environment_sample(&e, u, d, &pdf, seen);
      assert_true(abbe_vector_finite(d) && isfinite(pdf) && pdf >= 0);
      assert_near(abbe_vector_length(d), 1, 1e-12);
    }
}

TEST(turning_both_changes_nothing) {
  FILLED(abbe_environment, still, make(64, &still));
  FILLED(abbe_environment, turned, make(64, &turned));
  abbe_environment_turn(0, NULL, 0, still.to_map);
  /* a quarter about z takes +x to +y; then a quarter about x takes +y to +z */
  abbe_environment_turn(ABBE_PI / 2, (const double[3]){1, 0, 0}, ABBE_PI / 2, turned.to_map);
  for (int i = 0; i < 200; i++) {
    double d[3] = {sin(i), cos(3 * i), sin(5 * i) + 0.1}, one[3], other[3];
    assert_true(abbe_vector_normalise(d));
    const double moved[3] = {-d[1], -d[2], d[0]};
    abbe_environment_radiance(&still, d, one);
    abbe_environment_radiance(&turned, moved, other);
    for (int k = 0; k < 3; k++) assert_near(one[k], other[k], 1e-9 * (1 + one[k]));
    assert_near(abbe_environment_pdf(&still, d), abbe_environment_pdf(&turned, moved), 1e-9);
  }
}

TEST(light_is_linear) {
  const double n[3] = {0.6, 0, 0.8};
  double a[3], b[3];
  FILLED(abbe_environment, one, make(64, &one));
  FILLED(abbe_environment, three, make(64, &three));
  for (size_t i = 0; i < 3 * 64 * 32; i++) three.map.rgb[i] *= 3;
  abbe_alias_table_free(&three.texels);
  for (size_t i = 0; i < three.level_count; i++) abbe_radiance_map_free(&three.level[i]);
  OK(abbe_environment_prepare(&three, &error));
  abbe_environment_radiance(&one, n, a);
  abbe_environment_radiance(&three, n, b);
  assert_near(b[0], 3 * a[0], 1e-5 * b[0]);
  assert_near(three.mean[0], 3 * one.mean[0], 1e-6 * three.mean[0]);
  assert_near(abbe_environment_pdf(&three, n), abbe_environment_pdf(&one, n), 1e-6);
}

TEST(levels_are_blurred) {
  FILLED(abbe_environment, e, make(64, &e));
  assert_int_equal(e.level_count, 4);
  assert_int_equal(e.level[3].height, 2);
  for (size_t l = 0; l < 8; l++) {
    double rgb[3];
    abbe_environment_radiance_of_level(&e, l, (const double[3]){0, 0, 1}, rgb);
    assert_true(rgb[0] >= 0 && rgb[0] <= 200);
  }
  abbe_environment_free(NULL);
}

TEST(what_is_refused) {
  static const struct {
    float value;
    const char *part;
  } cases[] = {
      {-1e-3f, "is -0.001"}, {NAN, "nan"}, {INFINITY, "inf"}, {2e12f, "2e+12"}, {0, "black"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    MADE(abbe_environment, e, abbe_radiance_map_make(16, &e.map, &error));
    e.map.rgb[3 * (16 * 2 + 5) + 1] = cases[i].value;
    REFUSED(ABBE_INVALID_ARGUMENT, cases[i].part, abbe_environment_prepare(&e, &error));
    if (i < 4) assert_contains(last_error.text, "green of the texel at column 5, row 2");
    assert_null(e.texels.keep);
  }
}

static abbe_sky sky_of(int type, double elevation) {
  return (abbe_sky){type, {cos(elevation), 0, sin(elevation)}};
}

TEST(every_sky_is_1_at_its_zenith) {
  for (int type = 1; type <= ABBE_SKY_TYPES; type++)
    for (double e = 0.1; e < 1.6; e += 0.3) {
      const abbe_sky sky = sky_of(type, e);
      assert_near(abbe_sky_relative(&sky, (const double[3]){0, 0, 1}), 1, 1e-12);
      assert_true(abbe_sky_relative(&sky, (const double[3]){1, 0, 0}) == 0);
      assert_true(abbe_sky_relative(&sky, (const double[3]){0, 0.6, -0.8}) == 0);
      for (double a = 0; a < 6.3; a += 0.3)
        for (double z = 0.001; z < 1; z += 0.1) {
          const double s = sqrt(1 - z * z);
          assert_true(abbe_sky_relative(&sky, (const double[3]){s * cos(a), s * sin(a), z}) > 0);
        }
    }
}

TEST(known_irradiances) {
  const abbe_sky overcast = {.type = ABBE_SKY_OVERCAST}, uniform = {.type = 5};
  assert_near(abbe_sky_horizontal(&overcast), 7 * ABBE_PI / 9, 1e-5);
  assert_near(abbe_sky_horizontal(&uniform), ABBE_PI, 1e-12);
}

/* By hand from the formula: the clear sky, sun at 30 degrees, 45 degrees up, opposite to the sun
 * (105 degrees from it) and towards it (15). */
TEST(the_clear_sky) {
  const abbe_sky sky = sky_of(ABBE_SKY_CLEAR, ABBE_PI / 6);
  const double z = cos(ABBE_PI / 4);
  const double scale = (1 - exp(-0.32 / z)) / (1 - exp(-0.32)) /
                       (1 + 10 * (exp(-ABBE_PI) - exp(-1.5 * ABBE_PI)) + 0.45 * 0.25);
  const double away = 1 + 10 * (exp(-3 * 105 * ABBE_PI / 180) - exp(-1.5 * ABBE_PI)) +
                      0.45 * pow(cos(105 * ABBE_PI / 180), 2);
  const double towards = 1 + 10 * (exp(-3 * 15 * ABBE_PI / 180) - exp(-1.5 * ABBE_PI)) +
                         0.45 * pow(cos(15 * ABBE_PI / 180), 2);
  assert_near(abbe_sky_relative(&sky, (const double[3]){-z, 0, z}), scale * away, 1e-12);
  assert_near(abbe_sky_relative(&sky, (const double[3]){z, 0, z}), scale * towards, 1e-12);
}

TEST(which_need_the_sun) {
  assert_true(abbe_sky_needs_sun(ABBE_SKY_CLEAR) && abbe_sky_needs_sun(2));
  assert_true(!abbe_sky_needs_sun(1) && !abbe_sky_needs_sun(5) && !abbe_sky_needs_sun(16));
  assert_true(!abbe_sky_needs_sun(0) && !abbe_sky_needs_sun(17));
}

/* The share of each entry, from the table itself. */
static void check_shares(const double *weight, size_t count) {
  double share[64] = {0}, sum = 0;
  MADE(abbe_alias_table, table, abbe_alias_table_make(weight, count, &table, &error));
  for (size_t i = 0; i < count; i++) {
    sum += weight[i];
    share[i] += table.keep[i];
    assert_true(table.keep[i] >= 0 && table.keep[i] <= 1);
    if (table.keep[i] < 1) share[table.other[i]] += 1 - table.keep[i];
  }
  for (size_t i = 0; i < count; i++) {
    assert_near(share[i] / (double)count, weight[i] / sum, 1e-15);
    if (weight[i] == 0) assert_true(share[i] == 0);
  }
}

TEST(shares_are_the_weights) {
  double weight[64];
  check_shares((const double[]){3}, 1);
  check_shares((const double[]){1, 1}, 2);
  check_shares((const double[]){1, 2, 3, 4}, 4);
  check_shares((const double[]){0, 0, 1e-20, 0}, 4);
  check_shares((const double[]){0.1, 0, 0.2, 0.7, 0, 1e9, 3}, 7);
  for (size_t n = 1; n <= 64; n++) {
    for (size_t i = 0; i < n; i++)
      weight[i] = i % 3 == 0 ? 0.1 * (double)(i * i % 17) + 0.1 : i % 5 ? 0 : 0.3;
    check_shares(weight, n);
  }
}

TEST(draws) {
  const double weight[] = {0, 5, 0, 1, 2};
  size_t hits[5] = {0};
  MADE(abbe_alias_table, table, abbe_alias_table_make(weight, 5, &table, &error));
  for (int i = 0; i < 80000; i++) hits[abbe_alias_table_draw(&table, (i + 0.5) / 80000)]++;
  for (int i = 0; i < 5; i++) assert_near((double)hits[i], weight[i] * 10000, 3);
  assert_true(weight[abbe_alias_table_draw(&table, 1 - 0x1p-53)] > 0);
  abbe_alias_table_free(NULL);
}

TEST(alias_table_what_is_refused) {
  static const double bad[][2] = {{0, 0},        {-1, 2},        {NAN, 1},
                                  {INFINITY, 1}, {1e308, 1e308}, {0, 1e-320}};
  abbe_alias_table table;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, "weights want to be finite, at least",
            abbe_alias_table_make(bad[i], 2, &table, &error));
    assert_null(table.keep);
  }
  REFUSED(ABBE_INVALID_ARGUMENT, "weights want to be finite, at least",
          abbe_alias_table_make(bad[0], 0, &table, &error));
}
