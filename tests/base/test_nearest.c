#include "tests/check.h"

#include "base/nearest.h"

static const char *const words[] = {"diamond", "fused-silica", "n-bk7", "n-bak4", "water", "n"};
enum { COUNT = sizeof words / sizeof words[0] };

TEST(near_words_are_found) {
  assert_string_equal(abbe_nearest_word("diamnod", words, COUNT), "diamond"); /* one swap */
  assert_string_equal(abbe_nearest_word("DIAMOND", words, COUNT), "diamond");
  assert_string_equal(abbe_nearest_word("fused_silicia", words, COUNT), "fused-silica");
  assert_string_equal(abbe_nearest_word("bk7", words, COUNT), "n-bk7");
  assert_string_equal(abbe_nearest_word("wter", words, COUNT), "water");
}

TEST(far_words_are_not) {
  assert_null(abbe_nearest_word("teapot", words, COUNT));
  assert_null(abbe_nearest_word("", words, COUNT));
  assert_null(abbe_nearest_word("x", words, COUNT));
  static const char *const shorts[] = {"rii", "from", "k5"};
  assert_null(abbe_nearest_word("zip", shorts, 3));
  assert_null(abbe_nearest_word("foo", shorts, 3));
  assert_null(abbe_nearest_word("f2", shorts, 3));
  assert_string_equal(abbe_nearest_word("form", shorts, 3), "from");
  assert_null(abbe_nearest_word("water", words, 0));
}

TEST(overlong_words_are_harmless) {
  char word[5000];
  memset(word, 'w', sizeof word - 1);
  word[sizeof word - 1] = '\0';
  const char *const candidates[] = {word, "water"};
  assert_null(abbe_nearest_word(word, words, COUNT));
  assert_string_equal(abbe_nearest_word("water", candidates, 2), "water");
  word[127] = '\0';
  assert_ptr_equal(abbe_nearest_word(word, candidates, 2), word);
}
