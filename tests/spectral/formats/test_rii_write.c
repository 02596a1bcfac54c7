#include "tests/spectral/random_material.h"
#include "tests/spectral/same_material.h"

#include "spectral/formats/material_import.h"
#include "spectral/formats/material_table_load.h"
#include "spectral/formats/material_write.h"

static abbe_material reread(const abbe_material *m, abbe_report *report) {
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  abbe_error why = {0};
  OK(abbe_rii_write(m, to, report, &error));
  fclose(to);
  abbe_material back;
  if (abbe_rii_parse(text, size, "x.yml", m->name, &back, NULL, &why) != ABBE_OK)
    fail_msg("%s\n%s", why.text, text);
  return back;
}

TEST(shipped_rows_come_back_the_same) {
  const char *const tables[] = {"default", "thesis"};
  for (int t = 0; t < 2; t++) {
    MADE(abbe_material_table, table, abbe_material_table_load(tables[t], &table, &error));
    for (size_t i = 0; i < table.count; i++) {
      OWNED(abbe_material, back) = reread(&table.material[i], NULL);
      assert_carried(&table.material[i], &back, 1e-14);
    }
  }
}

/* What the database does not carry is left out of the record, the rest comes back; and what was
 * left out is noted. */
TEST(random_records_come_back_the_same) {
  srand(3);
  for (size_t i = 0; i < 400; i++) {
    OWNED(abbe_material, m) = random_material(i);
    free(m.source);
    free(m.comment);
    m.source = strdup("A. Author, \"Title\" & <more>, 2001: p. 3");
    m.comment = i % 2 ? strdup("20 \xc2\xb0\x43 # not a comment") : NULL;
    OWNED(abbe_report, report) = {0};
    OWNED(abbe_material, back) = reread(&m, &report);
    bool lost = m.description != NULL || m.warning != NULL || m.fit[0].terms > 0 || m.extrapolate ||
                abbe_material_is_uniaxial(&m);
    assert_true(!lost || report.kinds[ABBE_NOTE_LOST] > 0);
    m.catalogue.melt_frequency = 0;
    m.catalogue.ratings[0] = -1;
    bool rated = false;
    for (int k = 0; k < 6; k++) rated = rated || m.catalogue.ratings[k] >= 0;
    if (!rated) m.catalogue.rating_count = 0;
    assert_true(same_catalogue(&m.catalogue, &back.catalogue));
    assert_string_equal(m.source, back.source);
    assert_true(same_text(m.comment, back.comment));
    assert_true(same_number(m.temperature_c, back.temperature_c, 1e-12));
    assert_true(m.n_absolute == back.n_absolute);
    assert_true(m.published_n_d == back.published_n_d && m.published_v_d == back.published_v_d);
    if (m.dispersion.table == NULL) {
      bool constant = m.dispersion.count == 1 && back.dispersion.model == ABBE_DISPERSION_CONSTANT;
      /* n = c0 + c1 L^-2 is of both forms */
      bool squares = m.dispersion.model == ABBE_DISPERSION_POWERS &&
                     back.dispersion.model == ABBE_DISPERSION_CAUCHY;
      assert_true(constant || squares || same_dispersion(&m.dispersion, &back.dispersion));
      for (double l = 350; l < 901 && squares; l += 50)
        assert_near(abbe_dispersion_n(&back.dispersion, l), abbe_dispersion_n(&m.dispersion, l), 0);
      assert_near(m.min_nm, back.min_nm, 0);
      assert_near(m.max_nm, back.max_nm, 0);
    } else {
      size_t count = abbe_spectrum_count(m.dispersion.table);
      assert_int_equal(abbe_spectrum_count(back.dispersion.table), count);
      assert_true(same_numbers(abbe_spectrum_value(m.dispersion.table),
                               abbe_spectrum_value(back.dispersion.table), count, 0));
    }
    for (double l = 300; l < 900; l += 50)
      if (m.attenuation == NULL ||
          abbe_spectrum_interpolation(m.attenuation) == ABBE_INTERPOLATION_LINEAR)
        assert_near(abbe_material_attenuation(&back, l), abbe_material_attenuation_along(&m, 0, l),
                    1e-11 * abbe_material_attenuation_along(&m, 0, l));
  }
}

TEST(failures_are_told) {
  abbe_material m =
      FIELDS(.name = (char[]){"x"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 1, .c = {1.5}});
  FILE *full = fopen("/dev/full", "w");
  assert_int_equal(abbe_rii_write(&m, full, NULL, NULL), ABBE_IO);
  m.max_nm = 300;
  assert_int_equal(abbe_rii_write(&m, full, NULL, NULL), ABBE_INVALID_ARGUMENT);
  fclose(full);
}
