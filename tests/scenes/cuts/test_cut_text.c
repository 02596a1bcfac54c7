#include "scenes/cuts/cut_text.h"

#include "tests/check.h"

static void letters_of_windows_1252_become_a_byte_each(void **state) {
  (void)state;
  char out[32];
  assert_int_equal(abbe_cut_text_narrow("a\xc3\xa9\xe2\x82\xac\xc2\xb0", out, sizeof out), 4);
  assert_string_equal(out, "a\xe9\x80\xb0");
  assert_int_equal(abbe_cut_text_narrow("\xe2\x88\x92\n\x7f", out, sizeof out), 3);
  assert_string_equal(out, "?  ");
  assert_int_equal(abbe_cut_text_narrow("\xff", out, sizeof out), 1);
  assert_string_equal(out, "?");
  assert_int_equal(abbe_cut_text_narrow("abcdef", out, 4), 3);
  assert_string_equal(out, "abc");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(letters_of_windows_1252_become_a_byte_each)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
