#include "tests/check.h"

#include "base/error.h"

TEST(every_code_has_its_own_text) {
  for (int i = 0; i < ABBE_RESULT_COUNT; i++) {
    assert_string_not_equal(abbe_result_text((abbe_result)i), "unknown result");
    for (int k = 0; k < i; k++)
      assert_string_not_equal(abbe_result_text((abbe_result)i), abbe_result_text((abbe_result)k));
  }
  assert_string_equal(abbe_result_text((abbe_result)-1), "unknown result");
  assert_string_equal(abbe_result_text(ABBE_RESULT_COUNT), "unknown result");
}

TEST(the_sentence_is_kept_cut_and_optional) {
  REFUSED(ABBE_IO, "", abbe_error_set(&error, ABBE_IO, "%s:%d", "file", 7));
  assert_int_equal(last_error.code, ABBE_IO);
  assert_string_equal(last_error.text, "file:7");
  assert_int_equal(abbe_error_set(NULL, ABBE_GL, "x"), ABBE_GL);
  REFUSED(ABBE_IO, "", abbe_error_set(&error, ABBE_IO, "%5000s", "x"));
  assert_int_equal(strlen(last_error.text), sizeof last_error.text - 1);
}

TEST(the_sentence_is_printable) {
  abbe_error error;
  abbe_error_set(&error, ABBE_IO, "%s: no\n%s\xff", "a\x1b[31m", "b\xc2\x9b");
  assert_string_equal(error.text, "a\xe2\x90\x9b[31m: no b\xef\xbf\xbd\xef\xbf\xbd");
  abbe_error_set(&error, ABBE_IO, "%s, again", error.text); /* its own text in a larger sentence */
  assert_string_equal(error.text, "a\xe2\x90\x9b[31m: no b\xef\xbf\xbd\xef\xbf\xbd, again");
  char many[900];
  memset(many, '\x1b', sizeof many - 1);
  many[sizeof many - 1] = '\0';
  abbe_error_set(&error, ABBE_IO, "%s", many); /* pictures take three bytes: cut between them */
  assert_int_equal(strlen(error.text), (sizeof error.text - 1) / 3 * 3);
}
