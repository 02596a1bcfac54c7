/* Materials by handle: published indices, metals, attenuation, what is refused. */
#include "tests/check.h"

#include "library/lib_materials.h"

static abbe_lib_materials *table;

static void setup(void) {
  OK(abbe_lib_materials_load(NULL, &table, &error));
}

static void teardown(void) {
  abbe_lib_materials_free(table);
}

static size_t place_of(const char *name) {
  size_t index = 0;
  OK(abbe_lib_materials_find(table, name, &index, &error));
  return index;
}

GROUP(setup, teardown);

/* Schott's data sheet of N-BK7: n_d 1.51680, n_F 1.52238, n_C 1.51432 [Schott2014]. */
TEST(indices_are_the_published_ones) {
  const double lines[] = {587.5618, 486.1327, 656.2725}, known[] = {1.51680, 1.52238, 1.51432};
  double n[3], k[3];
  OK(abbe_lib_materials_index(table, place_of("N-BK7"), lines, 3, n, k, &error));
  for (int i = 0; i < 3; i++) {
    assert_near(n[i], known[i], 6e-6);
    assert_true(k[i] >= 0 && k[i] < 1e-6);
  }
}

TEST(metals_have_both_parts) {
  const double green = 550;
  double n, k;
  OK(abbe_lib_materials_index(table, place_of("gold"), &green, 1, &n, &k, &error));
  assert_true(n > 0 && n < 1 && k > 2);
}

TEST(every_row_has_its_texts) {
  const size_t count = abbe_lib_materials_count(table);
  assert_true(count > 10);
  for (size_t i = 0; i < count; i++) {
    double from, to;
    size_t again = count;
    const char *name = abbe_lib_materials_name(table, i);
    OK(abbe_lib_materials_find(table, name, &again, &error));
    assert_int_equal(again, i);
    assert_non_null(abbe_lib_materials_text(table, i, "source"));
    OK(abbe_lib_materials_range(table, i, &from, &to, &error));
    assert_true(from > 0 && from < to);
  }
  assert_null(abbe_lib_materials_name(table, count));
  assert_null(abbe_lib_materials_text(table, 0, "colour"));
}

TEST(what_is_none_is_refused) {
  abbe_lib_materials *none = NULL;
  size_t index;
  double n, far = 1e6;
  REFUSED(ABBE_NOT_FOUND, "diamond", abbe_lib_materials_find(table, "dimond", &index, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_lib_materials_index(table, 99999, &far, 1, &n, NULL, &error));
  REFUSED(ABBE_OUT_OF_RANGE, "",
          abbe_lib_materials_index(table, place_of("gold"), &far, 1, &n, NULL, &error));
  REFUSED(ABBE_IO, "", abbe_lib_materials_load("/nowhere.yaml", &none, &error));
  assert_null(none);
}
