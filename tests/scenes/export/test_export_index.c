/* The index as other formats hold it: forms against materials of their own law, and the stated
 * errors against those measured anew. */
#include "tests/scenes/scene_text.h"

#include "scenes/export/scene_export.h"
#include "spectral/formats/material_import.h"

static abbe_export_index index_of(const abbe_material_table *table, const char *name,
                                  abbe_export_form form) {
  const abbe_material *material = NULL;
  abbe_export_index index;
  OK(abbe_material_table_find(table, name, &material, &error));
  OK(abbe_export_index_make(material, form, &index, &error));
  return index;
}

/* crown: n = 1.5 + 0.006 um2 / lambda^2. */
TEST(a_law_of_two_terms) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  abbe_export_index i = index_of(&scene.table, "crown", ABBE_EXPORT_FORM_ABBE);
  /* n_d = 1.5 + 0.006 / 0.5875618^2; V_d = (n_d - 1) / (0.006 (1 / F^2 - 1 / C^2)) */
  const double n_d = 1.5 + 0.006 / (0.5875618 * 0.5875618);
  const double spread = 0.006 * (1 / (0.4861327 * 0.4861327) - 1 / (0.6562725 * 0.6562725));
  assert_near(i.value[0], n_d, 1e-12);
  assert_near(i.value[1], 20 * spread / (n_d - 1), 1e-12);
  assert_true(i.worst < 1e-12 && i.rms <= i.worst && !i.held);
  i = index_of(&scene.table, "crown", ABBE_EXPORT_FORM_TABLE);
  /* straight between points h = 5 nm apart: h^2 n'' / 8 at most, greatest at the violet end */
  const double most = 0.005 * 0.005 / 8 * 6 * 0.006 / pow(0.3825, 4);
  assert_true(i.worst > 0.9 * most && i.worst < 1.05 * most);
  assert_true(i.worst_nm < 386);
  assert_near(abbe_export_index_at(&i, 500), 1.5 + 0.006 / 0.25, 1e-12);
}

TEST(three_indices) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  abbe_export_index i = index_of(&scene.table, "crown", ABBE_EXPORT_FORM_THREE);
  assert_near(abbe_export_index_at(&i, 700), 1.5 + 0.006 / (0.6114 * 0.6114), 1e-12);
  assert_near(abbe_export_index_at(&i, 540), 1.5 + 0.006 / (0.5491 * 0.5491), 1e-12);
  assert_near(abbe_export_index_at(&i, 400), 1.5 + 0.006 / (0.4642 * 0.4642), 1e-12);
  for (int form = 0; form < ABBE_EXPORT_FORM_COUNT; form++) {
    i = index_of(&scene.table, "flat", (abbe_export_form)form);
    assert_near(i.worst, 0, 1e-12);
    assert_near(abbe_export_index_at(&i, 666), 1.5, 1e-12);
  }
}

/* narrow is known from 400 to 700 nm; loose too, but goes on. */
TEST(records_that_end) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  abbe_export_index i = index_of(&scene.table, "narrow", ABBE_EXPORT_FORM_TABLE);
  assert_true(i.held);
  assert_near(i.table[0], 1.5 + 0.006 / 0.16, 1e-12);
  assert_near(i.table[ABBE_EXPORT_TABLE_COUNT - 1], 1.5 + 0.006 / 0.49, 1e-12);
  assert_true(i.worst_nm >= 400 && i.worst < 5e-6);
  i = index_of(&scene.table, "loose", ABBE_EXPORT_FORM_TABLE);
  assert_true(!i.held);
  assert_near(i.table[0], 1.5 + 0.006 / (0.36 * 0.36), 1e-12);
}

TEST(stated_errors_are_those_measured) {
  MADE(abbe_material_table, table, abbe_material_table_load("default", &table, &error));
  for (size_t m = 0; m < table.count; m++) {
    const abbe_material *material = &table.material[m];
    abbe_export_index index;
    if (abbe_material_is_conductor(material)) {
      assert_int_equal(abbe_export_index_make(material, ABBE_EXPORT_FORM_THREE, &index, NULL),
                       ABBE_UNSUPPORTED);
      continue;
    }
    double worst[ABBE_EXPORT_FORM_COUNT] = {0};
    for (int form = 0; form < ABBE_EXPORT_FORM_COUNT; form++) {
      double sum = 0, n = 0, count = 0;
      index = index_of(&table, material->name, (abbe_export_form)form);
      for (int nm = 380; nm <= 780; nm++) {
        if (abbe_material_n(material, nm, &n, NULL) != ABBE_OK) continue;
        const double off = fabs(abbe_export_index_at(&index, nm) - n);
        worst[form] = fmax(worst[form], off);
        sum += off * off, count++;
      }
      assert_near(index.worst, worst[form], 1e-15);
      assert_near(index.rms, sqrt(sum / count), 1e-15);
    }
    assert_true(worst[ABBE_EXPORT_FORM_TABLE] <= worst[ABBE_EXPORT_FORM_THREE] / 50 + 1e-12);
  }
}
