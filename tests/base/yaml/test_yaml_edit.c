#include "tests/check.h"

#include "base/yaml/yaml.h"
#include "base/yaml/yaml_edit.h"
#include "base/yaml/yaml_edit_text.h"

static abbe_yaml_edit edit_of(const char *text) {
  abbe_yaml_edit e;
  OK(abbe_yaml_edit_make(text, strlen(text), "t", &e, &error));
  return e;
}

/* The mapping or list at a path of keys and indices, such as "a/0/b"; and the last step's index. */
static abbe_yaml_node walk(abbe_yaml_edit *e, const char *path, size_t *index) {
  abbe_yaml_node at = abbe_yaml_root(e->yaml), parent = at;
  char copy[64];
  snprintf(copy, sizeof copy, "%s", path);
  for (char *step = strtok(copy, "/"); step != NULL; step = strtok(NULL, "/")) {
    parent = at;
    *index = (size_t)atoi(step);
    if (abbe_yaml_is_mapping(e->yaml, parent)) {
      for (*index = 0;
           strcmp(abbe_yaml_text(e->yaml, abbe_yaml_key(e->yaml, parent, *index)), step) != 0;)
        ++*index;
      at = abbe_yaml_value(e->yaml, parent, *index);
    } else {
      at = abbe_yaml_item(e->yaml, parent, *index);
    }
  }
  return parent;
}

static void check_text(abbe_yaml_edit *e, const char *wanted) {
  assert_int_equal(e->size, strlen(e->text));
  assert_string_equal(e->text, wanted);
  abbe_yaml_edit_free(e);
}

static void replaced(const char *text, const char *path, const char *value, const char *wanted) {
  abbe_yaml_edit e = edit_of(text);
  size_t index = 0;
  abbe_yaml_node parent = walk(&e, path, &index);
  OK(abbe_yaml_edit_replace(&e, parent, index, value, &error));
  check_text(&e, wanted);
}

static void inserted(const char *text, const char *path, const char *value, const char *wanted) {
  abbe_yaml_edit e = edit_of(text);
  size_t index = 0;
  abbe_yaml_node parent = walk(&e, path, &index);
  OK(abbe_yaml_edit_insert_pair(&e, parent, index, "new", value, &error));
  check_text(&e, wanted);
}

static void removed(const char *text, const char *path, const char *wanted) {
  abbe_yaml_edit e = edit_of(text);
  size_t index = 0;
  abbe_yaml_node parent = walk(&e, path, &index);
  OK(abbe_yaml_edit_remove(&e, parent, index, &error));
  check_text(&e, wanted);
}

static void appended(const char *text, const char *item, const char *wanted) {
  abbe_yaml_edit e = edit_of(text);
  OK(abbe_yaml_edit_append(&e, abbe_yaml_root(e.yaml), 0, item, &error));
  check_text(&e, wanted);
}

TEST(a_value_is_replaced_and_nothing_else) {
  replaced("a: 1 # one\nb: 2\n", "a", "10", "a: 10 # one\nb: 2\n");
  replaced("a: 1\r\nb: '2'\r\n", "b", "[3]", "a: 1\r\nb: [3]\r\n");
  replaced("# \xC2\xB5\na: \xC3\xA9\nb: 2", "b", "3", "# \xC2\xB5\na: \xC3\xA9\nb: 3");
  replaced("\xEF\xBB\xBF"
           "a: 1\n",
           "a", "2",
           "\xEF\xBB\xBF"
           "a: 2\n");
  replaced("{a: 1, b: 2}", "a", "x", "{a: x, b: 2}");
  replaced("a: [1, # one\n  2]\n", "a/1", "3", "a: [1, # one\n  3]\n");
  replaced("a: >-\n  two\n  lines\n\nb: 2\n", "a", "one", "a: one\n\nb: 2\n");
  replaced("a:\nb: 2\n", "a", "1", "a: 1\nb: 2\n");
  replaced("{a: , b: 2}", "a", "1", "{a: 1, b: 2}");
  replaced("- 1\n- 2 # two\n", "1", "3", "- 1\n- 3 # two\n");
  replaced("l:\n- a: 1\n  b: 2\n- a: 3\n", "l/1/a", "4", "l:\n- a: 1\n  b: 2\n- a: 4\n");
}

TEST(a_block_gives_way_to_a_line) {
  replaced("a:\n  # why\n  b: 1\n  c: 2 # two\n# end\nd: 3\n", "a", "{b: 2}",
           "a: {b: 2}\n  # why\n# end\nd: 3\n");
  replaced("a:\n- 1\n- 2\nd: 3\n", "a", "[2]", "a: [2]\nd: 3\n");
  replaced("a:\r\n  b: 1", "a", "2", "a: 2");
}

TEST(long_lists_are_wrapped) {
  replaced("a: [1]\n", "a",
           "[[1, 1.2345678901], [2, 1.2345678901], [3, 1.2345678901], [4, 1.2345678901], [5, "
           "1.2345678901], [6, 1]]",
           "a: [\n  [1, 1.2345678901], [2, 1.2345678901], [3, 1.2345678901], [4, 1.2345678901], "
           "[5, 1.2345678901],\n  [6, 1]\n]\n");
}

TEST(a_pair_finds_its_place) {
  inserted("a: 1 # one\nb: 2\n", "a", "3", "a: 1 # one\nnew: 3\nb: 2\n");
  inserted("a: 1\nb: 2", "b", "3", "a: 1\nb: 2\nnew: 3");
  inserted("l:\r\n  - a: 1\r\n    b: [1,\r\n      2] # x\r\n", "l/0/b", "3",
           "l:\r\n  - a: 1\r\n    b: [1,\r\n      2] # x\r\n    new: 3\r\n");
  inserted("{a: 1, b: 2}\n", "a", "3", "{a: 1, new: 3, b: 2}\n");
  inserted("a: >-\n  text\n\nb: 2\n", "a", "3", "a: >-\n  text\nnew: 3\n\nb: 2\n");
  inserted("x: {}\na: 1\n", "x", "3", "x: {}\nnew: 3\na: 1\n");
  abbe_yaml_edit e = edit_of("x: {}\n");
  OK(abbe_yaml_edit_insert_pair(&e, abbe_yaml_value(e.yaml, abbe_yaml_root(e.yaml), 0),
                                ABBE_YAML_EDIT_END, "k", "1", &error));
  check_text(&e, "x: {k: 1}\n");
}

TEST(a_pair_is_taken_out) {
  removed("a: 1\n# two\nb: 2 # two\n# three\nc: 3\n", "b", "a: 1\n# two\n# three\nc: 3\n");
  removed("{a: 1, b: 2, c: 3}", "b", "{a: 1, c: 3}");
  removed("{a: 1, b: 2, c: 3}", "c", "{a: 1, b: 2}");
  removed("{a: 1,\n b: 2}", "a", "{\n b: 2}");
  removed("l:\n- a: 1\n  b: 2\n", "l/0/a", "l:\n- b: 2\n");
  removed("l:\n- a: 1\n  b:\n    - x\n    - y\n- c\n", "l/0/b", "l:\n- a: 1\n- c\n");
  removed("a: 1\nb: >-\n  text\n  more\nc: 3\n", "b", "a: 1\nc: 3\n");
  removed("a: 1\nb: 2", "b", "a: 1");
}

TEST(an_item_is_taken_out) {
  const char *text = "l:\n  # first\n  - a: 1\n    b: 2\n    # of it\n\n  # second\n  - a: 2\n\n"
                     "  - a: 3 # end\n# last\n";
  removed(text, "l/0", "l:\n  # first\n\n  # second\n  - a: 2\n\n  - a: 3 # end\n# last\n");
  removed(
      text, "l/1",
      "l:\n  # first\n  - a: 1\n    b: 2\n    # of it\n\n  # second\n\n  - a: 3 # end\n# last\n");
  removed(text, "l/2",
          "l:\n  # first\n  - a: 1\n    b: 2\n    # of it\n\n  # second\n  - a: 2\n\n# last\n");
  removed("l:\n- a: 1\n\n- a: 2\n\n- a: 3\n", "l/1", "l:\n- a: 1\n\n- a: 3\n");
  removed("l:\n- a: 1\n\n- a: 2\n\n- a: 3\n", "l/2", "l:\n- a: 1\n\n- a: 2\n");
  removed("l:\n- a: 1\n\n- a: 2\n", "l/0", "l:\n- a: 2\n");
  removed("l:\n- a: 1\n- a: 2", "l/1", "l:\n- a: 1");
  removed("l:\n-\n  # x\n  a: 1\n- a: 2\n", "l/0", "l:\n- a: 2\n");
  removed("l: [{a: 1}, {a: 2}]\n", "l/0", "l: [{a: 2}]\n");
  removed("l: [{a: 1}, {a: 2}]\n", "l/1", "l: [{a: 1}]\n");
}

TEST(an_item_is_put_at_the_end) {
  appended("l:\n  - a: 1 # one\n# end\n", "a: 2\nb: 3\n",
           "l:\n  - a: 1 # one\n  - a: 2\n    b: 3\n# end\n");
  appended("l:\n- a: 1\n\n- a: 2\n", "a: 3", "l:\n- a: 1\n\n- a: 2\n\n- a: 3\n");
  appended("l:\n- a: 1\n\n- a: 2", "a: 3", "l:\n- a: 1\n\n- a: 2\n\n- a: 3");
  appended("l:\n- a: 1\n", "  - a: 2\n    b: |\n      x\n\n      y\n",
           "l:\n- a: 1\n- a: 2\n  b: |\n    x\n\n    y\n");
  appended("l:\r\n- a: 1\r\n", "a: 2\nb: 3\n", "l:\r\n- a: 1\r\n- a: 2\r\n  b: 3\r\n");
  appended("l: [{a: 1}]\n", "a: 2\nb: [3, 'x, y', \"4\"]\n",
           "l: [{a: 1}, {a: 2, b: [3, \"x, y\", \"4\"]}]\n");
  appended("l: []\n", "a: 2", "l: [{a: 2}]\n");
  appended("l: # none yet\n", "a: 2", "l: # none yet\n  - a: 2\n");
}

TEST(an_item_is_told_as_it_stands) {
  OWNED(abbe_yaml_edit, e) =
      edit_of("l:\n  - a: 1 # one\n    b:\n      - 2\n    # end\n  - {a: 3}\n");
  abbe_yaml_node list = abbe_yaml_value(e.yaml, abbe_yaml_root(e.yaml), 0);
  FREED char *text = NULL;
  OK(abbe_yaml_edit_item(&e, list, 0, &text, &error));
  assert_string_equal(text, "a: 1 # one\nb:\n  - 2\n# end");
  free(text);
  OK(abbe_yaml_edit_item(&e, list, 1, &text, &error));
  assert_string_equal(text, "{a: 3}");
}

static void refused(const char *text, const char *path, const char *value, const char *part) {
  abbe_yaml_edit e = edit_of(text);
  size_t index = 0;
  abbe_yaml_node parent = walk(&e, path, &index);
  abbe_error error = {0};
  abbe_result result = value != NULL ? abbe_yaml_edit_replace(&e, parent, index, value, &error)
                                     : abbe_yaml_edit_remove(&e, parent, index, &error);
  if (result == ABBE_OK) fail_msg("'%s' of '%s' became '%s'", path, text, e.text);
  assert_contains(error.text, part);
  check_text(&e, text);
}

TEST(what_the_text_would_misread_is_refused) {
  refused("a: 1\nb: 2\n", "a", "1 # one", "put it in quotes");
  refused("a: 1\nb: 2\n", "a", "x: y", "would break the file");
  refused("a: 1\nb: 2\n", "a", "[1, 2", "would break the file");
  refused("{a: 1, b: 2}\n", "a", "1, c: 3", "put it in quotes");
  refused("a: 1\nb: 2\n", "a", "1\nb: 3", "one line");
  refused("a: 1\nb: 2\n", "a", "", "one line");
  refused("a: 1\nb: 2\n", "a", "*x", "would break the file");
  refused("a: &x 1\nb: *x\n", "b", "2", "alias");
  refused("a: &x 1\nb: *x\n", "a", "2", "would break the file");
  refused("a: [&x 1, *x]\n", "a/1", "2", "alias");
  refused("l:\n- &x {a: 1}\n- *x\n", "l/0", NULL, "would break the file");
  refused("l:\n- a: 1\n", "l/0", NULL, "only one");
  abbe_yaml_edit e;
  REFUSED(ABBE_UNSUPPORTED, "iconv",
          abbe_yaml_edit_make("\xFF\xFE"
                              "a\0",
                              4, "t", &e, &error));
  REFUSED(ABBE_PARSE, "", abbe_yaml_edit_make("a: [", 4, "t", &e, &error));
}

TEST(numbers_read_back) {
  FREED char *list = NULL;
  OK(abbe_yaml_edit_list((double[]){1.5, 0.0042}, 2, &list, &error));
  assert_string_equal(list, "[1.5, 0.0042]");
}

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
