#include "tests/check.h"

#include "spectral/wavelengths.h"

TEST(seven_over_the_default_range) {
  MADE(abbe_wavelengths, w, abbe_wavelengths_make(7, 380, 780, &w, &error));
  assert_int_equal(w.count, 7);
  assert_near(w.lambda_nm[0], 380, 0);
  assert_near(w.lambda_nm[1], 380 + 400.0 / 6, 1e-12);
  assert_near(w.lambda_nm[3], 580, 1e-12);
  assert_near(w.lambda_nm[6], 780, 0);
  assert_near(w.edge_nm[0], 380, 0);
  assert_near(w.edge_nm[1], 380 + 200.0 / 6, 1e-12);
  assert_near(w.edge_nm[6], 780 - 200.0 / 6, 1e-12);
  assert_near(w.edge_nm[7], 780, 0);
  abbe_wavelengths_free(&w);
  assert_null(w.lambda_nm);
  assert_int_equal(w.count, 0);
}

TEST(one_stands_in_the_middle) {
  MADE(abbe_wavelengths, w, abbe_wavelengths_make(1, 400, 700, &w, &error));
  assert_near(w.lambda_nm[0], 550, 0);
  assert_near(w.edge_nm[0], 400, 0);
  assert_near(w.edge_nm[1], 700, 0);
}

TEST(bands_tile_the_range_at_any_count) {
  for (size_t count = 2; count <= ABBE_WAVELENGTHS_MAX_COUNT; count = count * 3 / 2 + 1) {
    MADE(abbe_wavelengths, w, abbe_wavelengths_make(count, 361.3, 829.7, &w, &error));
    assert_near(w.edge_nm[0], 361.3, 0);
    assert_near(w.edge_nm[count], 829.7, 0);
    for (size_t i = 0; i < count; i++) {
      assert_true(w.edge_nm[i] < w.edge_nm[i + 1]);
      assert_true(w.edge_nm[i] <= w.lambda_nm[i] && w.lambda_nm[i] <= w.edge_nm[i + 1]);
      if (i > 0)
        assert_near(w.lambda_nm[i] - w.lambda_nm[i - 1], 468.4 / (double)(count - 1), 1e-9);
    }
  }
}

static void refuses(size_t count, double min_nm, double max_nm, const char *part) {
  abbe_wavelengths w;
  REFUSED(ABBE_INVALID_ARGUMENT, part, abbe_wavelengths_make(count, min_nm, max_nm, &w, &error));
  assert_null(w.lambda_nm);
}

TEST(what_is_no_sampling_is_refused) {
  refuses(0, 380, 780, "0 wavelengths");
  refuses(ABBE_WAVELENGTHS_MAX_COUNT + 1, 380, 780, "4097");
  refuses(SIZE_MAX, 380, 780, "wavelengths");
  refuses(7, 780, 380, "780:380");
  refuses(7, 500, 500, "500:500");
  refuses(7, 0, 780, "0:780");
  refuses(7, -1, 780, "-1:780");
  refuses(7, NAN, 780, "nan");
  refuses(7, 380, INFINITY, "inf");
  refuses(100, 500, nextafter(500, 501), "too narrow");
}
