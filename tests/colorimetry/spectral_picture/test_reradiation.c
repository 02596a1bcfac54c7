#include "tests/check.h"

#include "colorimetry/spectral_picture/reradiation.h"
#include "spectral/materials/material_table.h"

/* A record with that value of its key fluorescence. */
static void parse(const char *fluorescence, abbe_material_table *out) {
  const char *text = printed("materials:\n- {name: it, source: s, model: constant, coefficients: "
                             "[1.5], absorption: {attenuation_per_m: [[300, 90], [800, 10]]},\n"
                             "   fluorescence: %s}\n",
                             fluorescence);
  OK(abbe_material_table_parse(text, strlen(text), "t.yaml", out, &error));
}

static const char matrix[] = "{matrix: [{nm: 400, emission: [[560, 0], [580, 0.01], [620, 0]]},\n"
                             "  {nm: 460, emission: [[560, 0], [600, 0.012], [640, 0]]},\n"
                             "  {nm: 560, emission: [[600, 0], [620, 0.02], [660, 0]]}]}";

/* Photons by nm by photon absorbed. */
static double comes_back(const abbe_material *m, double from_nm, double to_nm) {
  return abbe_material_excites(m, from_nm) * abbe_material_reradiates(m, from_nm, to_nm);
}

/* Rows and what is between them, at their own and at others' wavelengths. */
TEST(a_matrix_goes_into_a_picture_and_back) {
  static const char *const values[] = {
      matrix,
      "{yield: 0.5, excitation_per_m: [[350, 10], [400, 30], [450, 0]], emission: [[500, 0], [520, "
      "1], [600, 0]]}"};
  for (size_t i = 0; i < 2; i++) {
    FILLED(abbe_material_table, one, parse(values[i], &one));
    MADE(abbe_image, picture, abbe_reradiation_picture(&one.material[0], &picture, &error));
    FREED char *text = NULL;
    OK(abbe_reradiation_text(&picture, "glow.exr", &text, &error));
    FILLED(abbe_material_table, two, parse(text, &two));
    const abbe_fluorescence *back = &two.material[0].fluorescence;
    assert_true(back->rows >= 2);
    for (size_t r = 0; r < back->rows; r++)
      for (double nm = 500; nm < 680; nm += 7)
        if (back->row[r].nm <= 500)
          assert_near(comes_back(&two.material[0], back->row[r].nm, nm),
                      comes_back(&one.material[0], back->row[r].nm, nm), 1e-7);
  }
}

TEST(a_matrix_is_straight_between_its_rows) {
  FILLED(abbe_material_table, table, parse(matrix, &table));
  const abbe_material *m = &table.material[0];
  assert_int_equal(abbe_material_glow_rows(m), 3);
  assert_near(abbe_material_yield(m, 400), 0.3, 1e-12);
  assert_near(abbe_material_yield(m, 430), 0.5 * (0.3 + 0.48), 1e-12);
  assert_near(abbe_material_reradiates(m, 415, 580), 0.75 * 0.01 + 0.25 * 0.006, 1e-12);
  assert_near(abbe_material_excites(m, 399), 0, 0);
  assert_near(abbe_material_yield(m, 561), 0, 0);
}

TEST(what_is_no_matrix_is_refused) {
  FREED char *text = NULL;
  OWNED(abbe_image, picture) = {0}, none = {0};
  static const char *const names[] = {"T.400nm", "T.500nm", "T.500nm.400nm"};
  OK(abbe_image_make(1, 1, 2, names, &none, &error));
  REFUSED(ABBE_NOT_FOUND, "nothing is re-radiated",
          abbe_reradiation_text(&none, "glow.exr", &text, &error));
  OK(abbe_image_make(1, 1, 3, names, &picture, &error));
  picture.data[2] = 0.5f;
  REFUSED(ABBE_INVALID_ARGUMENT, "shorter wavelength than the one that excites",
          abbe_reradiation_text(&picture, "glow.exr", &text, &error));
  const abbe_material clear = {.name = "clear"};
  abbe_image out;
  REFUSED(ABBE_INVALID_ARGUMENT, "clear does not glow",
          abbe_reradiation_picture(&clear, &out, &error));
}
