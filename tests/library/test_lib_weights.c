/* Weights as arrays: they sum to the white, in every space; what is refused. */
#include "tests/check.h"

#include "library/lib_weights.h"

enum { COUNT = 9 };

TEST(weights_sum_to_the_white) {
  double nm[COUNT], weight[3 * COUNT], sum[3] = {0};
  OK(abbe_lib_weights_fill(NULL, NULL, 380, 780, COUNT, nm, weight, &error));
  assert_near(nm[0], 380, 0);
  assert_near(nm[COUNT - 1], 780, 0);
  for (int i = 0; i < 3 * COUNT; i++) {
    assert_true(weight[i] >= 0);
    sum[i % 3] += weight[i];
  }
  /* D65: x 0.31272, y 0.32903 [CIE15], over this range */
  assert_near(sum[1], 1, 1e-12);
  assert_near(sum[0], 0.31272 / 0.32903, 5e-4);
  assert_near(sum[2], (1 - 0.31272 - 0.32903) / 0.32903, 5e-4);
}

TEST(spaces_and_illuminants_are_by_name) {
  double nm[COUNT], weight[3 * COUNT], red = 0, blue = 0;
  OK(abbe_lib_weights_fill("A", "rec709", 380, 780, COUNT, nm, weight, &error));
  for (int i = 0; i < COUNT; i++) {
    red += weight[3 * i];
    blue += weight[3 * i + 2];
  }
  assert_true(red > 2 * blue); /* a lamp is reddish */
}

TEST(what_is_none_is_refused) {
  double nm[COUNT], weight[3 * COUNT];
  REFUSED(ABBE_NOT_FOUND, "lab",
          abbe_lib_weights_fill(NULL, "lab", 380, 780, COUNT, nm, weight, &error));
  REFUSED(ABBE_IO, "",
          abbe_lib_weights_fill("/nowhere", NULL, 380, 780, COUNT, nm, weight, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_lib_weights_fill(NULL, NULL, 780, 380, COUNT, nm, weight, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_lib_weights_fill(NULL, NULL, 380, 780, 0, nm, weight, &error));
}
