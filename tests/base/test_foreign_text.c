#include "tests/check.h"

#include "base/foreign_text.h"

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

static void encoding_becomes(const char *bytes, size_t size, const char *wanted) {
  FREED char *text = NULL;
  size_t length = 0;
  OK(abbe_encoding_decode(bytes, size, &text, &length, &error));
  assert_string_equal(text, wanted);
  assert_int_equal(length, strlen(wanted));
}
#define BECOMES(bytes, wanted) encoding_becomes(bytes, sizeof bytes - 1, wanted)

TEST(every_encoding_becomes_utf8) {
  BECOMES("", "");
  BECOMES("NM F2", "NM F2");
  BECOMES("\xef\xbb\xbfNM", "NM");
  BECOMES("\xff\xfeN\0M\0\xb5\0", "NM\xc2\xb5");
  BECOMES("\xfe\xff\0N\0M\0\xb5", "NM\xc2\xb5");
  BECOMES("N\0M\0 \0F\0002\0\n\0", "NM F2\n"); /* no mark */
  BECOMES("\0N\0M\0 \0F\0002\0\n", "NM F2\n");
  BECOMES("\xff\xfe\x3d\xd8\x8e\xdc", "\xf0\x9f\x92\x8e"); /* a pair of surrogates */
  BECOMES("25\xb0\x43 \x96 \x80", "25\xc2\xb0\x43 \xe2\x80\x93 \xe2\x82\xac"); /* Windows-1252 */
  BECOMES("25\xc2\xb0\x43", "25\xc2\xb0\x43");
}

TEST(lines_end_in_one_way) {
  BECOMES("a\r\nb\rc\n\nd", "a\nb\nc\n\nd");
  BECOMES("\xff\xfe"
          "a\0\r\0\n\0b\0",
          "a\nb");
}

TEST(what_cannot_be_decoded_is_replaced) {
  BECOMES("\xff\xfe\x00\xd8"
          "a\0",
          "\xef\xbf\xbd"
          "a"); /* half a pair */
  BECOMES("\xff\xfe\x00\xdc", "\xef\xbf\xbd");
  BECOMES("\xff\xfe"
          "a\0b",
          "a\xef\xbf\xbd");                                    /* an odd byte at the end */
  BECOMES("\xef\xbb\xbf\xc0\x80", "\xef\xbf\xbd\xef\xbf\xbd"); /* overlong */
  BECOMES("\xef\xbb\xbf\xed\xa0\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
  BECOMES("a\x1b[2J\x07"
          "b\tc",
          "a [2J b\tc");
  BECOMES("a\0b", "a b");
}

TEST(texts_are_told_from_other_files) {
  static const char latin[] = "NM F2 25\xb0\x43\r\n\x1a", marked[] = "\xff\xfeN\0M\0",
                    unmarked[] = "N\0M\0 \0F\0002\0\n",
                    xls[] = "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0\0",
                    gzip[] = "\x1f\x8b\x08\x08\x01\x02\x03\x04\x05",
                    elf[] = "\x7f"
                            "ELF\2\1\1";
  assert_false(abbe_encoding_is_binary("", 0));
  assert_false(abbe_encoding_is_binary(latin, sizeof latin - 1));
  assert_false(abbe_encoding_is_binary(marked, sizeof marked - 1));
  assert_false(abbe_encoding_is_binary(unmarked, sizeof unmarked));
  assert_true(abbe_encoding_is_binary(xls, sizeof xls - 1));
  assert_true(abbe_encoding_is_binary(gzip, sizeof gzip - 1));
  assert_true(abbe_encoding_is_binary(elf, sizeof elf - 1));
}
