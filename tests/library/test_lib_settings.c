/* Requests as texts: what each kind takes, what is refused, and by which words. */
#include "tests/check.h"

#include "library/lib_materials.h"
#include "library/lib_settings.h"
#include "library/lib_weights.h"

typedef struct request {
  size_t width;
  double low;
  bool on;
  int choice;
  const char *name;
} request;

static abbe_result read(request *q, const char *text, abbe_error *error) {
  static const char *const colours[] = {"red", "green"};
  const abbe_lib_setting known[] = {
      ABBE_LIB_COUNT("width", &q->width, 1, 8192), ABBE_LIB_NUMBER("low", &q->low, -1.5, 2),
      ABBE_LIB_FLAG("on", &q->on), ABBE_LIB_CHOICE("colour", &q->choice, colours),
      ABBE_LIB_TEXT("name", &q->name)};
  return abbe_library_settings_read("render", known, sizeof known / sizeof *known, &text, 1, error);
}

TEST(each_kind_is_taken) {
  request q = {0};
  OK(read(&q, "width=8192", &error));
  OK(read(&q, "low=-1.5e0", &error));
  OK(read(&q, "on=1", &error));
  OK(read(&q, "colour=GREEN", &error));
  OK(read(&q, "name=a=b", &error));
  assert_int_equal(q.width, 8192);
  assert_near(q.low, -1.5, 0);
  assert_true(q.on);
  assert_int_equal(q.choice, 1);
  assert_string_equal(q.name, "a=b");
}

TEST(the_last_one_counts) {
  size_t width = 0;
  const abbe_lib_setting known[] = {ABBE_LIB_COUNT("width", &width, 1, 9)};
  const char *const text[] = {"width=2", "width=3"};
  OK(abbe_library_settings_read("x", known, 1, text, 2, &error));
  assert_int_equal(width, 3);
  OK(abbe_library_settings_read("x", known, 1, NULL, 0, &error));
}

TEST(what_is_none_is_refused) {
  static const char *const wrong[][2] = {
      {"widht=3", "did you mean 'width'?"},
      {"zzzzzzzzzzzz=3", "there are width, low, on, colour, name"},
      {"width", "no value"},
      {"", "no value"},
      {"width=", "is not a whole number from 1 to 8192"},
      {"width=0", "is not a whole number from 1 to 8192"},
      {"width=8193", "is not a whole number"},
      {"width=2.5", "is not a whole number"},
      {"width=1e400", "is not a whole number"},
      {"width=3x", "width '3x' is not"},
      {"low=2.01", "is not a number from -1.5 to 2"},
      {"low=nan", "is not a number"},
      {"low=1,5", "is not a number"},
      {"on=2", "is not a whole number from 0 to 1"},
      {"colour=blue", "is not one of red, green"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    request q = {.width = 7};
    REFUSED(ABBE_INVALID_ARGUMENT, wrong[i][1], read(&q, wrong[i][0], &error));
    assert_int_equal(q.width, 7);
  }
}

/* Weights as arrays: they sum to the white, in every space; what is refused. */

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

TEST(lib_weights_what_is_none_is_refused) {
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

/* Materials by handle: published indices, metals, attenuation, what is refused. */

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

TEST(lib_materials_what_is_none_is_refused) {
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
