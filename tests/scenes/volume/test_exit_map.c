/* Maps that light is laid on: its sum and its middle stay, tents are as wide as asked for, and even
 * light stays even up to the ends. */
#include "tests/check.h"

#include "scenes/volume/exits/exit_pages.h"

enum { SIDE = 48 };

static float map[SIDE * SIDE][4], smooth[SIDE * SIDE][4];

/* Of a channel: its sum, the mean of x and of y, and their variances. */
static void find_moments(const float (*of)[4], int channel, double moment[5]) {
  memset(moment, 0, 5 * sizeof *moment);
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double v = (double)of[i][channel], x = i % SIDE + 0.5, y = i / SIDE + 0.5;
    moment[0] += v;
    moment[1] += v * x;
    moment[2] += v * y;
    moment[3] += v * x * x;
    moment[4] += v * y * y;
  }
  for (int k = 1; k < 5; k++) moment[k] /= moment[0];
  for (int k = 3; k < 5; k++) moment[k] -= moment[k - 2] * moment[k - 2];
}

TEST(tents) {
  static const float value[4] = {1, 2, 3, 0}, wide[2] = {7.5f, 3.25f};
  double moment[5];
  memset(map, 0, sizeof map);
  abbe_exit_map_add(map, SIDE, 20.3f, 24.9f, value);
  for (int channel = 0; channel < 3; channel++) {
    find_moments((const float(*)[4])map, channel, moment);
    assert_near(moment[0], channel + 1, 1e-6);
    assert_near(moment[1], 20.3, 1e-5);
    assert_near(moment[2], 24.9, 1e-5);
    abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
    find_moments((const float(*)[4])smooth, channel, moment);
    assert_near(moment[0], channel + 1, 1e-5);
    assert_near(moment[1], 20.3, 1e-4);
    assert_near(moment[2], 24.9, 1e-4);
    for (int a = 0; a < 2; a++) /* a place among texels has a share of 1/4 at the most */
      assert_near(moment[3 + a], (double)(wide[a] * wide[a]) / 6, 0.13);
  }
}

/* At the ends nothing is lost, and an even map is even. */
TEST(ends) {
  static const float value[4] = {1, 0, 0, 0}, wide[2] = {9, 200};
  static const float place[][2] = {{0, 0}, {SIDE, 0}, {0.2f, SIDE}, {SIDE, SIDE}, {-1, 3}};
  double moment[5];
  for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
    memset(map, 0, sizeof map);
    abbe_exit_map_add(map, SIDE, place[i][0], place[i][1], value);
    abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
    find_moments((const float(*)[4])smooth, 0, moment);
    assert_near(moment[0], 1, 1e-5);
  }
  for (int i = 0; i < SIDE * SIDE; i++) map[i][1] = 0.5f;
  abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
  for (int i = 0; i < SIDE * SIDE; i++) assert_near((double)smooth[i][1], 0.5, 1e-6);
}

/* Narrow tents are what a place is already; a map of one texel has it all. */
TEST(narrow) {
  static const float value[4] = {1, 2, 3, 4}, wide[2] = {1, 0.5f}, wider[2] = {5, 5};
  float one[1][4] = {{0}}, out[1][4];
  memset(map, 0, sizeof map);
  abbe_exit_map_add(map, SIDE, 10.6f, 11.2f, value);
  abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
  assert_memory_equal(map, smooth, sizeof map);
  abbe_exit_map_add(one, 1, 0.7f, 0.1f, value);
  abbe_exit_map_smooth((const float(*)[4])one, 1, wider, out);
  for (int k = 0; k < 4; k++) assert_near((double)out[0][k], (double)value[k], 1e-6);
}
