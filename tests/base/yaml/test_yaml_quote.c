#include "tests/check.h"

#include "base/yaml/yaml.h"
#include "base/yaml/yaml_quote.h"

static char *quoted(const char *text) {
  char *out = NULL;
  OK(abbe_yaml_quote_make(text, &out, &error));
  return out;
}

/* As a value in block style and in brackets, with a neighbour that must stay one. */
TEST(texts_read_back) {
  const char *texts[] = {
      "plain text",   "a: b",         "x # y",   "true", "1.5",    "",      " lead",
      "tail ",        "[a]",          "\"q\\\"", "a\tb", "\x01",   "µ — é", "-",
      "a\nb",         "*x",           "Off",     "n",    "é",      "a, b",  "a; b",
      "a = (b)",      "\xc2\x85",     "\x7f",    "---",  "a\r\nb", "'",     "\xe2\x80\xa8",
      "\xef\xbb\xbf", "\xef\xbf\xbf", "~",       "null"};
  for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
    for (int flow = 0; flow < 2; flow++) {
      FREED char *quote = quoted(texts[i]);
      abbe_yaml *yaml = NULL;
      abbe_error error = {0};
      assert_null(strchr(quote, '\n'));
      const char *text = printed(flow ? "{k: %s, l: 1}" : "k: %s\nl: 1\n", quote);
      if (abbe_yaml_parse(text, strlen(text), "t", &yaml, &error) != ABBE_OK)
        fail_msg("%s: %s", text, error.text);
      abbe_yaml_node root = abbe_yaml_root(yaml);
      assert_string_equal(abbe_yaml_text(yaml, abbe_yaml_get(yaml, root, "k")), texts[i]);
      assert_int_equal(abbe_yaml_count(yaml, root), 2);
      abbe_yaml_free(yaml);
    }
}

TEST(only_what_must_be_is_quoted) {
  static const struct {
    const char *text, *quote;
  } cases[] = {{"N-BK7, Schott", "\"N-BK7, Schott\""},
               {"a maker's glass", "\"a maker's glass\""},
               {"N-BK7 (2017)", "N-BK7 (2017)"},
               {"no", "\"no\""},
               {"nothing", "nothing"},
               {"1.5", "\"1.5\""},
               {"two\nlines", "\"two\\nlines\""},
               {"µ", "\"µ\""}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    FREED char *quote = quoted(cases[i].text);
    assert_string_equal(quote, cases[i].quote);
  }
}

TEST(bytes_that_are_no_letters_are_replaced) {
  FREED char *quote = quoted("caf\xe9 \xe2\x82");
  assert_string_equal(quote, "\"caf\\ufffd \\ufffd\\ufffd\"");
}
