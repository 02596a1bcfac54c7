#include "tests/check.h"

#include "tests/random.h"
#include "validation/trace/nl_means.h"

enum { SIDE = 96, COUNT = SIDE * SIDE };

static float value[COUNT], variance[COUNT], out[COUNT], left[COUNT], own[COUNT];
static float feature[COUNT], zero[COUNT];

static void fill(double (*light)(size_t x, size_t y), double deviation) {
  uint64_t random = 11;
  for (size_t i = 0; i < COUNT; i++) {
    value[i] = (float)(light(i % SIDE, i / SIDE) + deviation * random_normal(&random));
    variance[i] = (float)(deviation * deviation);
  }
}

static double flat(size_t x, size_t y) {
  (void)x, (void)y;
  return 3;
}

static double edge(size_t x, size_t y) {
  (void)y;
  return x < SIDE / 2 ? 1 : 2;
}

static abbe_nl_means job_of(size_t width, size_t height) {
  return (abbe_nl_means){.width = width,
                         .height = height,
                         .window = 5,
                         .patch = 2,
                         .noise = 0.7f,
                         .compared = 1,
                         .filtered = 1,
                         .compare = {{value, variance}},
                         .filter = {{value, variance}},
                         .out = {out},
                         .out_variance = {left},
                         .own = own};
}

static void run(const abbe_nl_means *job, size_t threads) {
  OK(abbe_nl_means_run(job, threads, &error));
}

static double mean_square(double (*light)(size_t x, size_t y), size_t from, size_t to) {
  double sum = 0;
  size_t n = 0;
  for (size_t i = 0; i < COUNT; i++) {
    const size_t x = i % SIDE, y = i / SIDE;
    if (x < from || x >= to) continue;
    sum += pow((double)out[i] - light(x, y), 2);
    n++;
  }
  return sum / (double)n;
}

/* 121 pixels of equal right to it would leave 1/121 of the variance; chance differences of the
 * patches take some of them away. The variance that is stated is the one that is left. */
TEST(noise_on_a_plain_is_averaged) {
  fill(flat, 0.5);
  const abbe_nl_means job = job_of(SIDE, SIDE);
  run(&job, 2);
  double stated = 0, shares = 0;
  for (size_t i = 0; i < COUNT; i++) {
    stated += (double)left[i] / COUNT;
    shares += (double)own[i] / COUNT;
  }
  const double square = mean_square(flat, 0, SIDE);
  assert_true(square < 0.25 / 60 && square > 0.25 / 121);
  assert_true(square / stated > 0.8 && square / stated < 1.5);
  assert_true(shares > 1.0 / 121 && shares < 1.0 / 50);
}

/* Ten deviations high: what lies beyond it has no part in the means. */
TEST(an_edge_stays) {
  fill(edge, 0.1);
  const abbe_nl_means job = job_of(SIDE, SIDE);
  run(&job, 2);
  assert_true(mean_square(edge, 0, SIDE) < 0.01 / 30);
  assert_true(mean_square(edge, SIDE / 2 - 1, SIDE / 2 + 1) < 0.01 / 5);
}

TEST(what_has_no_noise_is_unchanged) {
  fill(edge, 0.7);
  memset(variance, 0, sizeof variance);
  const abbe_nl_means job = job_of(SIDE, SIDE);
  run(&job, 2);
  assert_memory_equal(out, value, sizeof out);
  fill(edge, 0);
  run(&job, 2);
  for (size_t i = 0; i < COUNT; i++) assert_near((double)out[i], (double)value[i], 1e-6);
}

/* Light that is the same on both sides of where a feature changes is not mixed. */
TEST(features_part_what_looks_alike) {
  fill(flat, 0.5);
  for (size_t i = 0; i < COUNT; i++) feature[i] = i % SIDE < SIDE / 2 ? 0 : 5;
  abbe_nl_means job = job_of(SIDE, SIDE);
  job.features = 1;
  job.feature[0] = (abbe_noisy_plane){feature, zero};
  job.filter[0].value = feature;
  run(&job, 2);
  for (size_t i = 0; i < COUNT; i++) assert_near((double)out[i], (double)feature[i], 1e-5);
  /* a difference within a feature's own noise, or below 1, parts nothing */
  for (size_t i = 0; i < COUNT; i++) feature[i] *= 0.19f;
  job.filter[0].value = value;
  run(&job, 2);
  const float near = out[SIDE * SIDE / 2 + SIDE / 2];
  job.features = 0;
  run(&job, 2);
  assert_true(near == out[SIDE * SIDE / 2 + SIDE / 2]);
}

TEST(threads_do_not_matter) {
  fill(edge, 0.3);
  const abbe_nl_means job = job_of(SIDE, SIDE - 7);
  run(&job, 1);
  static float first[COUNT];
  memcpy(first, out, sizeof first);
  for (size_t threads = 2; threads < 6; threads++) {
    memset(out, 0, sizeof out);
    run(&job, threads);
    assert_memory_equal(out, first, SIDE * (SIDE - 7) * sizeof *out);
  }
}

TEST(small_pictures_are_pictures_too) {
  static const size_t sizes[][2] = {{1, 1}, {3, 3}, {1, 9}, {2, 1}, {65, 2}};
  fill(flat, 0.5);
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
    const abbe_nl_means job = job_of(sizes[s][0], sizes[s][1]);
    run(&job, 2);
    for (size_t i = 0; i < sizes[s][0] * sizes[s][1]; i++)
      assert_true((double)out[i] > 1 && (double)out[i] < 5 && left[i] <= variance[i] * 1.0001f);
  }
  const abbe_nl_means one = job_of(1, 1);
  run(&one, 1);
  assert_true(out[0] == value[0] && own[0] == 1);
}

/* Against the mean taken pixel by pixel. */
TEST(means_over_squares) {
  static float room[COUNT];
  static const size_t cases[][3] = {{13, 9, 2}, {1, 1, 4}, {3, 17, 5}, {20, 20, 0}};
  fill(edge, 0.5);
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    const int w = (int)cases[c][0], h = (int)cases[c][1], r = (int)cases[c][2];
    abbe_plane_mean(value, (size_t)w, (size_t)h, (size_t)r, 2, room, out);
    for (int y = 0; y < h; y++)
      for (int x = 0; x < w; x++) {
        double sum = 0, n = 0;
        for (int v = y - r; v <= y + r; v++)
          for (int u = x - r; u <= x + r; u++)
            if (u >= 0 && v >= 0 && u < w && v < h) {
              sum += (double)value[v * w + u];
              n++;
            }
        assert_near((double)out[y * w + x], sum / n, 1e-6);
      }
  }
}
