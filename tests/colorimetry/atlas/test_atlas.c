/* The spectral colours against printed chromaticities, and laws of bands and gamuts. */
#include "tests/check.h"
#include "tests/fontconfig.h"

#include "colorimetry/atlas/atlas.h"

#include <unistd.h>

static abbe_atlas make(const abbe_atlas_desc *desc) {
  abbe_atlas atlas;
  OK(abbe_atlas_make(desc, &atlas, &error));
  return atlas;
}

TEST(published_chromaticities) {
  static const double printed[3][3] = {
      {450, 0.15664, 0.01771}, {520, 0.07430, 0.83380}, {600, 0.62704, 0.37249}}; /* [CIE15] */
  OWNED(abbe_atlas, a) = make(&(abbe_atlas_desc){0});
  assert_int_equal(a.count, 301);
  for (int i = 0; i < 3; i++) {
    const abbe_atlas_row *row = &a.row[(int)printed[i][0] - 400];
    assert_near(row->lambda_nm, printed[i][0], 0);
    assert_near(row->xy[0], printed[i][1], 2e-5);
    assert_near(row->xy[1], printed[i][2], 2e-5);
    assert_near(row->xyz[1], 0.5, 1e-12);
  }
  for (size_t i = 0; i < a.count; i++)
    for (int g = 0; g < ABBE_GAMUT_COUNT; g++) {
      assert_near(a.row[i].difference[g][ABBE_GAMUT_MAP_NONE], 0, 0);
      if (a.row[i].excess[g] == 0)
        assert_near(a.row[i].difference[g][ABBE_GAMUT_MAP_WHITE], 0, 1e-6);
      assert_true(a.row[i].excess[ABBE_GAMUT_REC709] >= a.row[i].excess[ABBE_GAMUT_REC2020]);
    }
  abbe_atlas_free(&a);
}

/* More bands, nearer to the truth; one band is the light's own colour. */
TEST(bands) {
  double before = 1e9;
  static const size_t counts[] = {3, 7, 15, 31, 63};
  for (int i = 0; i < 5; i++) {
    double sum = 0;
    OWNED(abbe_atlas, a) = make(&(abbe_atlas_desc){.bands = counts[i]});
    for (size_t k = 0; k < a.count; k++) sum += a.row[k].band_uv;
    assert_true(sum < 0.7 * before);
    before = sum;
  }
  OWNED(abbe_atlas, one) = make(&(abbe_atlas_desc){.bands = 1, .min_nm = 380, .max_nm = 730});
  assert_near(one.row[0].band_xy[0], 0.3127, 5e-4);
  assert_near(one.row[300].band_xy[1], 0.3290, 5e-4);
}

TEST(files) {
  static const char png[] = "/tmp/abbe_test_atlas.png", svg[] = "/tmp/abbe_test_atlas.svg";
  OWNED(abbe_atlas, a) =
      make(&(abbe_atlas_desc){.observer = ABBE_OBSERVER_CIE_2015_10, .bands = 7});
  OK(abbe_atlas_picture(&a, png, &error));
  OK(abbe_atlas_plot(&a, svg, &error));
  assert_int_equal(access(png, R_OK) + access(svg, R_OK), 0);
  assert_int_equal(abbe_atlas_plot(&a, "a.jpg", NULL), ABBE_INVALID_ARGUMENT);
  unlink(png);
  unlink(svg);
}

TEST(refused) {
  static const abbe_atlas_desc wrong[] = {
      {.min_nm = 300, .max_nm = 700},
      {.min_nm = 400, .max_nm = 900},
      {.min_nm = 600, .max_nm = 500},
      {.min_nm = NAN, .max_nm = 500},
      {.bands = 1 << 20},
      {.observer = ABBE_OBSERVER_COUNT},
      {.observer = ABBE_OBSERVER_CIE_2015_2, .min_nm = 380, .max_nm = 700}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    abbe_atlas a;
    assert_int_equal(abbe_atlas_make(&wrong[i], &a, NULL), ABBE_INVALID_ARGUMENT);
    assert_null(a.row);
  }
}
