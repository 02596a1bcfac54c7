#include "tests/check.h"

#include "spectral/error.h"

static void every_code_has_its_own_text(void **state) {
  (void)state;
  for (int i = 0; i < ABBE_RESULT_COUNT; i++) {
    assert_string_not_equal(abbe_result_text((abbe_result)i), "unknown result");
    for (int k = 0; k < i; k++)
      assert_string_not_equal(abbe_result_text((abbe_result)i), abbe_result_text((abbe_result)k));
  }
  assert_string_equal(abbe_result_text((abbe_result)-1), "unknown result");
  assert_string_equal(abbe_result_text(ABBE_RESULT_COUNT), "unknown result");
}

static void the_sentence_is_kept_cut_and_optional(void **state) {
  (void)state;
  abbe_error error;
  assert_int_equal(abbe_error_set(&error, ABBE_IO, "%s:%d", "file", 7), ABBE_IO);
  assert_int_equal(error.code, ABBE_IO);
  assert_string_equal(error.text, "file:7");
  assert_int_equal(abbe_error_set(NULL, ABBE_GL, "x"), ABBE_GL);
  assert_int_equal(abbe_error_set(&error, ABBE_IO, "%5000s", "x"), ABBE_IO);
  assert_int_equal(strlen(error.text), sizeof error.text - 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_code_has_its_own_text),
      cmocka_unit_test(the_sentence_is_kept_cut_and_optional),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
