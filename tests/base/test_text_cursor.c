#include "tests/check.h"

#include "base/yaml/yaml_tree.h"

/* One character of each length that UTF-8 has. */
static const char mixed[] = "a\u00b5\u2026\U0001F48Ez";

TEST(indices_become_bytes_in_any_order) {
  const size_t byte[] = {0, 1, 3, 6, 10, 11};
  abbe_text_cursor c = abbe_text_cursor_make(mixed, sizeof mixed - 1);
  for (size_t from = 0; from <= 5; from++)
    for (size_t to = 0; to <= 5; to++) {
      assert_int_equal(abbe_text_cursor_byte(&c, from), byte[from]);
      assert_int_equal(abbe_text_cursor_byte(&c, to), byte[to]);
    }
}

TEST(a_byte_order_mark_is_no_character) {
  const char text[] = "\xEF\xBB\xBF"
                      "ab";
  abbe_text_cursor c = abbe_text_cursor_make(text, sizeof text - 1);
  assert_int_equal(abbe_text_cursor_byte(&c, 0), 3);
  assert_int_equal(abbe_text_cursor_byte(&c, 1), 4);
  assert_int_equal(abbe_text_cursor_byte(&c, 0), 3);
}

TEST(it_never_leaves_the_text) {
  abbe_text_cursor c = abbe_text_cursor_make(mixed, sizeof mixed - 1);
  assert_int_equal(abbe_text_cursor_byte(&c, 1000), sizeof mixed - 1);
  assert_int_equal(abbe_text_cursor_byte(&c, 1), 1);
  c = abbe_text_cursor_make("\x80\x80", 2); /* not UTF-8 */
  assert_int_equal(abbe_text_cursor_byte(&c, 1), 2);
  assert_int_equal(abbe_text_cursor_byte(&c, 0), 0);
  c = abbe_text_cursor_make("", 0);
  assert_int_equal(abbe_text_cursor_byte(&c, 3), 0);
}
