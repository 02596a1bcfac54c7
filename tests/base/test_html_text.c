#include "tests/check.h"

#include "base/encoding.h"

static void becomes(const char *html, const char *wanted) {
  FREED char *text = abbe_html_text(html, 1000);
  assert_string_equal(text, wanted);
}

TEST(tags_and_entities_become_text) {
  becomes("", "");
  becomes("  plain\n  text ", "plain text");
  becomes("<a href=\"https://x\"><i>Appl. Opt.</i> <b>46</b>, 3811-3820 (2007)</a>",
          "Appl. Opt. 46, 3811-3820 (2007)");
  becomes("one<br>two<br/>three", "one two three");
  becomes("H<sub>2</sub>O", "H2O");
  becomes("a &lt; b &amp;&nbsp;c 20&deg;C &unknown;", "a < b & c 20\xc2\xb0\x43 &unknown;");
  becomes("n < 2 and k > 0", "n < 2 and k > 0");
  becomes("open <a end", "open <a end");
  becomes("<b></b>", "");
}

TEST(long_texts_are_cut_between_letters) {
  FREED char *text = abbe_html_text("ab\xc3\xa4\xc3\xa4", 3);
  assert_string_equal(text, "ab");
  free(text);
  text = abbe_html_text("ab\xc3\xa4\xc3\xa4", 4);
  assert_string_equal(text, "ab\xc3\xa4");
}

/* A quarter of a million openings, none of which ends. */
TEST(unending_tags_take_no_time) {
  enum { COUNT = 1 << 18 };
  FREED char *html = malloc(2 * COUNT + 1);
  assert_non_null(html);
  for (size_t i = 0; i < COUNT; i++) memcpy(html + 2 * i, "<a", 2);
  html[2 * COUNT] = '\0';
  FREED char *text = abbe_html_text(html, 10);
  assert_string_equal(text, "<a<a<a<a<a");
}

TEST(escaped_text_comes_back) {
  const char *const texts[] = {"a < b > c & d", "<b>", "&amp;", "", "\xc3\xa4"};
  for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
    FREED char *html = abbe_html_escape(texts[i]);
    becomes(html, texts[i]);
    assert_null(strchr(html, '<'));
  }
}
