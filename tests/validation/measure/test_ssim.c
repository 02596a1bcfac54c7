/* SSIM by its definition, where it is known in closed form and summed window by window. */
#include "tests/check.h"

#include "validation/measure/compare_state.h"

enum { W = 17, H = 14 };

static void map_of(const float *a, const float *b, float *out) {
  OK(abbe_ssim_map(a, b, W, H, out, &error));
}

/* Two even greys have no structure: only the means count. */
TEST(even_greys) {
  float a[W * H], b[W * H], out[W * H];
  for (int i = 0; i < W * H; i++) {
    a[i] = 0.25f;
    b[i] = 0.75f;
  }
  map_of(a, b, out);
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++) {
      const bool inside = x >= 5 && x < W - 5 && y >= 5 && y < H - 5;
      assert_int_equal(inside, !isnan(out[y * W + x]));
      if (inside)
        assert_near((double)out[y * W + x], (2 * 0.1875 + 1e-4) / (0.0625 + 0.5625 + 1e-4), 1e-6);
    }
}

/* [Wang2004, eq. 13 to 16], every window summed for itself about its own means. */
TEST(by_definition) {
  float a[W * H], b[W * H], out[W * H];
  for (int i = 0; i < W * H; i++) {
    a[i] = (float)(0.5 + 0.4 * sin(1.7 * i) * cos(0.3 * i));
    b[i] = (float)(0.45 + 0.3 * sin(1.7 * i + 0.4) * cos(0.29 * i));
  }
  map_of(a, b, out);
  double least = 1;
  for (int y = 5; y < H - 5; y++)
    for (int x = 5; x < W - 5; x++) {
      double sum = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
      for (int pass = 0; pass < 2; pass++)
        for (int j = -5; j <= 5; j++)
          for (int i = -5; i <= 5; i++) {
            const double w = exp(-(i * i + j * j) / 4.5);
            const double p = (double)a[(y + j) * W + x + i], q = (double)b[(y + j) * W + x + i];
            if (pass == 0) {
              sum += w;
              ma += w * p;
              mb += w * q;
            } else {
              va += w * (p - ma / sum) * (p - ma / sum);
              vb += w * (q - mb / sum) * (q - mb / sum);
              cov += w * (p - ma / sum) * (q - mb / sum);
            }
          }
      ma /= sum;
      mb /= sum;
      const double expected = (2 * ma * mb + 1e-4) * (2 * cov / sum + 9e-4) /
                              ((ma * ma + mb * mb + 1e-4) * ((va + vb) / sum + 9e-4));
      assert_near((double)out[y * W + x], expected, 1e-6);
      least = fmin(least, expected);
    }
  assert_true(least < 0.9);
  map_of(a, a, out);
  assert_near((double)out[6 * W + 6], 1, 1e-6);
}

/* A picture that no window fits into has no index anywhere; a value that is not finite spoils the
 * windows that it is in alone. */
TEST(edges) {
  float a[W * H] = {0}, out[W * H];
  OK(abbe_ssim_map(a, a, 10, 14, out, &error));
  for (int i = 0; i < 140; i++) assert_true(isnan(out[i]));
  a[5 * W + 0] = NAN;
  map_of(a, a, out);
  assert_true(isnan(out[5 * W + 5]));
  assert_near((double)out[5 * W + 6], 1, 1e-6);
}
