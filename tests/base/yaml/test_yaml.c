#include "tests/check.h"

#include "base/yaml/yaml.h"
#include "base/yaml/yaml_tree.h"

HOLDS(abbe_yaml);

static abbe_yaml *parse(const char *text) {
  abbe_yaml *yaml = NULL;
  OK(abbe_yaml_parse(text, strlen(text), "t.yaml", &yaml, &error));
  return yaml;
}

TEST(a_mistyped_key_is_named_where_one_is_missing) {
  HELD(abbe_yaml, y) = parse("a: 1\nintensitty: 3\n");
  abbe_yaml_node node;
  abbe_error e = {0};
  assert_int_equal(abbe_yaml_require(y, abbe_yaml_root(y), "intensity", &node, &e), ABBE_SCHEMA);
  assert_contains(e.text, "t.yaml:2: the key 'intensity' is missing here, and 'intensitty' is no "
                          "key; did you mean 'intensity'?");
  assert_int_equal(abbe_yaml_require(y, abbe_yaml_root(y), "colour", &node, &e), ABBE_SCHEMA);
  assert_contains(e.text, "the key 'colour' is missing here");
}

TEST(a_tab_names_itself) {
  static const char *const texts[] = {"a:\n\tb: 1\n", "a:\n  b: 1\n  \tc: 2\n", "a: 1\n\tb: 2\n"};
  static const char *const lines[] = {"t.yaml:2: ", "t.yaml:3: ", "t.yaml:2: "};
  for (int i = 0; i < 3; i++) {
    abbe_yaml *yaml = NULL;
    REFUSED(ABBE_PARSE, lines[i],
            abbe_yaml_parse(texts[i], strlen(texts[i]), "t.yaml", &yaml, &error));
    assert_contains(last_error.text, "begins with a tab; YAML indents by blanks");
  }
}

static void refuses_bytes(const char *text, size_t size, abbe_result code, const char *part) {
  abbe_yaml *yaml = NULL;
  abbe_error error = {0};
  assert_int_equal(abbe_yaml_parse(text, size, "t.yaml", &yaml, &error), code);
  assert_null(yaml);
  assert_contains(error.text, part);
}

static void refuses(const char *text, abbe_result code, const char *part) {
  refuses_bytes(text, strlen(text), code, part);
}

TEST(a_document_is_walked) {
  HELD(abbe_yaml, y) =
      parse("# a comment\nname: glass\nlist: [1, 2.5, -3e2]\nnested:\n  on: true\n");
  abbe_yaml_node root = abbe_yaml_root(y), list;
  assert_true(abbe_yaml_is_mapping(y, root));
  assert_int_equal(abbe_yaml_count(y, root), 3);
  assert_string_equal(abbe_yaml_text(y, abbe_yaml_key(y, root, 1)), "list");
  OK(abbe_yaml_require(y, root, "list", &list, &error));
  assert_true(abbe_yaml_is_sequence(y, list));
  assert_int_equal(abbe_yaml_line(y, list), 3);
  assert_string_equal(abbe_yaml_text(y, abbe_yaml_item(y, list, 1)), "2.5");
  assert_int_equal(abbe_yaml_item(y, list, 3).id, 0);
  assert_int_equal(abbe_yaml_value(y, root, 9).id, 0);
  assert_null(abbe_yaml_text(y, list));
  assert_int_equal(abbe_yaml_line(y, (abbe_yaml_node){0}), 0);
  assert_int_equal(abbe_yaml_get(y, list, "x").id, 0);
  assert_int_equal(abbe_yaml_get(y, (abbe_yaml_node){0}, "x").id, 0);
  assert_int_equal(abbe_yaml_count(y, (abbe_yaml_node){999}), 0);
  abbe_yaml_free(NULL);
}

TEST(typed_values_are_read_and_defaults_kept) {
  HELD(abbe_yaml, y) =
      parse("n: -1.5e-3\nc: 42\nb: true\ns: 'a text'\nw: two\nv: [1, 2, 3]\ne: []\n");
  abbe_yaml_node root = abbe_yaml_root(y);
  double n = 7, absent = 7, v[3], *list = NULL;
  size_t c = 7, count = 9;
  bool b = false;
  FREED char *s = NULL;
  int w = -1;
  const char *const words[] = {"one", "two", NULL};
  OK(abbe_yaml_get_number(y, root, "n", -1, 1, &n, &error));
  assert_near(n, -1.5e-3, 0);
  OK(abbe_yaml_get_number(y, root, "absent", -1, 1, &absent, &error));
  assert_near(absent, 7, 0);
  OK(abbe_yaml_get_count(y, root, "c", 42, 42, &c, &error));
  assert_int_equal(c, 42);
  OK(abbe_yaml_get_bool(y, root, "b", &b, &error));
  assert_true(b);
  OK(abbe_yaml_get_string(y, root, "s", &s, &error));
  OK(abbe_yaml_get_string(y, root, "s", &s, &error)); /* frees the first */
  assert_string_equal(s, "a text");
  OK(abbe_yaml_get_choice(y, root, "w", words, &w, &error));
  assert_int_equal(w, 1);
  OK(abbe_yaml_get_numbers(y, root, "v", 3, 0, 3, v, &error));
  assert_near(v[2], 3, 0);
  OK(abbe_yaml_get_list(y, root, "v", 3, &list, &count, &error));
  assert_int_equal(count, 3);
  assert_near(list[1], 2, 0);
  free(list);
  OK(abbe_yaml_get_list(y, root, "e", 3, &list, &count, &error));
  assert_int_equal(count, 0);
  free(list);
  OK(abbe_yaml_get_list(y, root, "absent", 3, &list, &count, &error));
  assert_null(list);
  OK(abbe_yaml_check_keys(y, root, "the file", &error));
}

static void refuses_number(const char *text, const char *part) {
  HELD(abbe_yaml, y) = parse(text);
  double x = 5;
  REFUSED(ABBE_SCHEMA,
          "t.yaml:2: ", abbe_yaml_get_number(y, abbe_yaml_root(y), "x", 0, 10, &x, &error));
  assert_contains(last_error.text, part);
  assert_near(x, 5, 0);
}

TEST(lengths_take_units) {
  HELD(abbe_yaml, y) =
      parse("a: 6.5mm\nb: 0.2 in\nc: [1cm, -2 mm, 0.5]\nd: 3 mn\ne: 4km\nf: 1.5m\n");
  const abbe_yaml_node root = abbe_yaml_root(y);
  double x = 7, v[3];
  OK(abbe_yaml_get_length(y, root, "a", 0, 1, &x, &error));
  assert_near(x, 0.0065, 0);
  OK(abbe_yaml_get_length(y, root, "b", 0, 1, &x, &error));
  assert_near(x, 0.00508, 0);
  OK(abbe_yaml_get_lengths(y, root, "c", 3, -1, 1, v, &error));
  assert_true(v[0] == 0.01 && v[1] == -0.002 && v[2] == 0.5);
  x = 7;
  REFUSED(ABBE_SCHEMA,
          "'d: 3 mn' is not a finite number, of metres or with its unit behind it (um, mm, cm, m, "
          "in, ft)",
          abbe_yaml_get_length(y, root, "d", 0, 9, &x, &error));
  REFUSED(ABBE_SCHEMA, "", abbe_yaml_get_length(y, root, "e", 0, 9, &x, &error));
  REFUSED(ABBE_SCHEMA, "'f: 1.5m' is not in the range from 0 to 1 m",
          abbe_yaml_get_length(y, root, "f", 0, 1, &x, &error));
  REFUSED(ABBE_SCHEMA, "'a: 6.5mm' is not a finite number",
          abbe_yaml_get_number(y, root, "a", 0, 9, &x, &error));
  assert_near(x, 7, 0);
}

TEST(numbers_are_finite_plain_and_in_range) {
  refuses_number("a: 1\nx: nan\n", "'x: nan' is not a finite number");
  refuses_number("a: 1\nx: .inf\n", "finite");
  refuses_number("a: 1\nx: infinity\n", "finite");
  refuses_number("a: 1\nx: 1e999\n", "finite");
  refuses_number("a: 1\nx: 0x10\n", "finite");
  refuses_number("a: 1\nx: 1.5.2\n", "finite");
  refuses_number("a: 1\nx: 1,5\n", "finite");
  refuses_number("a: 1\nx:\n", "finite");
  refuses_number("a: 1\nx: '3'\n", "text in quotes");
  refuses_number("a: 1\nx: [3]\n", "a list");
  refuses_number("a: 1\nx: {y: 3}\n", "a mapping");
  refuses_number("a: 1\nx: 11\n", "range from 0 to 10");
  refuses_number("a: 1\nx: -0.1\n", "range from 0 to 10");
}

/* One getter a case: the sentence that its wrong value gets. */
TEST(other_types_are_refused_too) {
  HELD(abbe_yaml, y) =
      parse("m: {a: 1}\nl: [1, x]\nw: twoo\ne: ''\nc: 1.5\nh: 99999999999999999999\n"
            "z: -3\ny: yes\n");
  abbe_yaml_node r = abbe_yaml_root(y), node;
  abbe_error e;
  size_t c = 0;
  bool b = false;
  char *s = NULL;
  int w = 0;
  double v[2] = {8, 8}, *list = NULL;
  const char *const words[] = {"one", "two", NULL};
  assert_int_equal(abbe_yaml_get_count(y, r, "c", 0, 9, &c, &e), ABBE_SCHEMA);
  assert_contains(e.text, "t.yaml:5: 'c: 1.5' is not a whole number from 0 to 9");
  assert_int_equal(abbe_yaml_get_count(y, r, "h", 0, SIZE_MAX, &c, &e), ABBE_SCHEMA);
  assert_int_equal(abbe_yaml_get_count(y, r, "z", 0, SIZE_MAX, &c, &e), ABBE_SCHEMA);
  assert_int_equal(abbe_yaml_get_count(y, r, "m", 0, 9, &c, &e), ABBE_SCHEMA);
  assert_contains(e.text, "'m' wants a whole number, not a mapping");
  assert_int_equal(abbe_yaml_get_bool(y, r, "y", &b, &e), ABBE_SCHEMA);
  assert_contains(e.text, "true nor false");
  assert_int_equal(abbe_yaml_get_bool(y, r, "m", &b, &e), ABBE_SCHEMA);
  assert_int_equal(abbe_yaml_get_string(y, r, "l", &s, &e), ABBE_SCHEMA);
  assert_contains(e.text, "not a list");
  assert_int_equal(abbe_yaml_get_string(y, r, "e", &s, &e), ABBE_SCHEMA);
  assert_contains(e.text, "empty");
  assert_null(s);
  assert_int_equal(abbe_yaml_get_choice(y, r, "w", words, &w, &e), ABBE_SCHEMA);
  assert_contains(e.text, "t.yaml:3: 'w: twoo' is not known; did you mean 'two'?");
  assert_contains(e.text, "one, two");
  assert_int_equal(abbe_yaml_get_choice(y, r, "l", words, &w, &e), ABBE_SCHEMA);
  assert_int_equal(abbe_yaml_get_numbers(y, r, "l", 2, 0, 9, v, &e), ABBE_SCHEMA);
  assert_contains(e.text, "'l: x' is not a finite number");
  assert_near(v[0], 8, 0);
  assert_int_equal(abbe_yaml_get_numbers(y, r, "l", 3, 0, 9, v, &e), ABBE_SCHEMA);
  assert_contains(e.text, "wants 3 numbers, not 2");
  assert_int_equal(abbe_yaml_get_numbers(y, r, "m", 3, 0, 9, v, &e), ABBE_SCHEMA);
  assert_int_equal(abbe_yaml_get_list(y, r, "l", 9, &list, &c, &e), ABBE_SCHEMA);
  assert_null(list);
  assert_int_equal(abbe_yaml_get_list(y, r, "l", 1, &list, &c, &e), ABBE_SCHEMA);
  assert_contains(e.text, "at most 1");
  assert_int_equal(abbe_yaml_get_list(y, r, "m", 1, &list, &c, &e), ABBE_SCHEMA);
  assert_int_equal(abbe_yaml_require(y, r, "gone", &node, &e), ABBE_SCHEMA);
  assert_contains(e.text, "t.yaml:1: the key 'gone' is missing");
  assert_int_equal(abbe_yaml_require(y, abbe_yaml_get(y, r, "l"), "a", &node, &e), ABBE_SCHEMA);
  assert_contains(e.text, "t.yaml:2: a mapping");
}

TEST(unknown_keys_get_the_nearest_known) {
  HELD(abbe_yaml, y) = parse("colour: 1\nm: {tempreature: 3}\nq: {unheard-of: 3}\n");
  abbe_error e;
  abbe_yaml_node r = abbe_yaml_root(y);
  abbe_yaml_node m = abbe_yaml_get(y, r, "m"), q = abbe_yaml_get(y, r, "q");
  abbe_yaml_get(y, m, "temperature");
  abbe_yaml_get(y, m, "temperature");
  abbe_yaml_get(y, m, "range");
  assert_int_equal(abbe_yaml_check_keys(y, m, "a material", &e), ABBE_SCHEMA);
  assert_string_equal(e.text,
                      "t.yaml:2: a material has no key 'tempreature'; did you mean 'temperature'?");
  assert_int_equal(abbe_yaml_check_keys(y, q, "a material", &e), ABBE_SCHEMA);
  assert_string_equal(e.text, "t.yaml:3: a material has no key 'unheard-of'");
  assert_int_equal(abbe_yaml_check_keys(y, r, "the file", &e), ABBE_SCHEMA);
  assert_contains(e.text, "t.yaml:1: the file has no key 'colour'");
  assert_int_equal(abbe_yaml_check_keys(y, abbe_yaml_get(y, r, "colour"), "a camera", &e),
                   ABBE_SCHEMA);
  assert_contains(e.text, "a camera must be a mapping");
}

TEST(malformed_documents_name_the_line) {
  refuses("a: 1\nb: [1, 2\nc: 3\n", ABBE_PARSE, "t.yaml:3: is not well-formed YAML");
  refuses("a: 'open\n", ABBE_PARSE, "t.yaml:2");
  refuses("\ta: 1\n", ABBE_PARSE, "t.yaml:1");
  refuses("a: \xff\xfe\n", ABBE_PARSE, "at byte 3");
  refuses("", ABBE_PARSE, "t.yaml: is empty");
  refuses("# only a comment\n", ABBE_PARSE, "empty");
  refuses("a: 1\n---\nb: 2\n", ABBE_SCHEMA, "t.yaml:2: a second document");
  refuses("a: 1\nb: 2\na: 3\n", ABBE_SCHEMA,
          "t.yaml:3: the key 'a' stands here a second time; the first is on line 1");
  refuses("[1]: 2\n", ABBE_SCHEMA, "t.yaml:1: a key must be a plain word");
  refuses("? {a: 1}\n: 2\n", ABBE_SCHEMA, "plain word");
  refuses("a: \"x\\0y\"\n", ABBE_SCHEMA, "zero byte");
  refuses_bytes("a: \0", 4, ABBE_PARSE, "byte");
}

TEST(complaints_hold_no_control_characters) {
  HELD(abbe_yaml, y) = parse("\"\\e[31mred\\n\": 1\n");
  abbe_error e;
  assert_int_equal(abbe_yaml_check_keys(y, abbe_yaml_root(y), "it", &e), ABBE_SCHEMA);
  assert_string_equal(e.text, "t.yaml:1: it has no key '\xe2\x90\x9b[31mred '");
}

TEST(aliases_are_resolved_and_kept_harmless) {
  HELD(abbe_yaml, y) = parse("a: &x [1, 2]\nb: *x\n");
  double v[2];
  OK(abbe_yaml_get_numbers(y, abbe_yaml_root(y), "b", 2, 0, 9, v, &error));
  assert_near(v[1], 2, 0);
  refuses("a: &x [1, *x]\n", ABBE_SCHEMA, "inside what it names");
  refuses("a: *y\n", ABBE_SCHEMA, "t.yaml:1: the alias *y has no anchor");
  refuses("a: &x k\n*x : 2\n", ABBE_SCHEMA, "write the key itself");
  char bomb[4096];
  int used = snprintf(bomb, sizeof bomb, "a0: &a0 [1,1,1,1,1,1,1,1,1,1]\n");
  for (int i = 1; i < 6; i++) { /* a million and a ninth values, written out */
    used += snprintf(bomb + used, sizeof bomb - (size_t)used, "a%d: &a%d [", i, i);
    for (int k = 0; k < 10; k++)
      used += snprintf(bomb + used, sizeof bomb - (size_t)used, "*a%d,", i - 1);
    used += snprintf(bomb + used, sizeof bomb - (size_t)used, "]\n");
  }
  refuses(bomb, ABBE_SCHEMA, "aliases");
}

static char *repeat(const char *part, size_t times, size_t *size) {
  size_t length = strlen(part);
  char *text = malloc(length * times + 1);
  assert_non_null(text);
  for (size_t i = 0; i < times; i++) memcpy(text + i * length, part, length);
  text[ *size = length * times] = '\0';
  return text;
}

TEST(depth_and_size_are_bounded) {
  size_t size = 0;
  FREED char *text = repeat("[", 65, &size);
  refuses_bytes(text, size, ABBE_SCHEMA, "deeper than 64");
  free(text);
  text = repeat("- ", 65, &size);
  refuses_bytes(text, size, ABBE_SCHEMA, "deeper than 64");
  free(text);
  text = repeat("- 1\n", 1000001, &size);
  refuses_bytes(text, size, ABBE_SCHEMA, "more than 1000000 values");
  free(text);
  text = repeat("- &a 1\n", 1025, &size);
  refuses_bytes(text, size, ABBE_SCHEMA, "anchors");
  free(text);
  text = repeat("# a line\n", (16 << 20) / 9 + 1, &size);
  refuses_bytes(text, size, ABBE_IO, "at most 16777216");
  free(text);
  text = repeat("- 1\n", 65, &size);
  HELD(abbe_yaml, y) = parse(text);
  assert_int_equal(abbe_yaml_count(y, abbe_yaml_root(y)), 65);
}

TEST(files_are_loaded_or_named) {
  abbe_yaml *y = NULL;
  abbe_error e;
  assert_int_equal(abbe_yaml_load("/no/such.yaml", &y, &e), ABBE_IO);
  assert_contains(e.text, "/no/such.yaml: ");
  assert_int_equal(abbe_yaml_load(ABBE_SOURCE_DIR "/tests", &y, &e), ABBE_IO);
  assert_null(y);
}

/* The text that the value of a key takes up. */
static void spans(const char *text, const char *key, const char *wanted) {
  HELD(abbe_yaml, y) = parse(text);
  size_t from = 0, to = 0;
  abbe_yaml_span(y, abbe_yaml_get(y, abbe_yaml_root(y), key), &from, &to);
  if (to - from != strlen(wanted) || memcmp(text + from, wanted, to - from) != 0)
    fail_msg("'%s' of '%s' is '%.*s'", key, text, (int)(to - from), text + from);
}

TEST(values_know_their_bytes) {
  spans("a: 1 # one\nb: 2\n", "a", "1");
  spans("# \u00b5\u2026\na: \u00e9 # \u00e9\nb: 2\n", "b", "2");
  spans("\xEF\xBB\xBF"
        "a: 1\r\nb: '2'\r\n",
        "b", "'2'");
  spans("a: [1, # one\n  2 ]\nb: 2", "a", "[1, # one\n  2 ]");
  spans("a:\n  - 1\n  - {c: 2} # two\n\n# b follows\nb: 2\n", "a", "- 1\n  - {c: 2}");
  spans("a: >-\n  two\n  lines\n\n\nb: 2\n", "a", ">-\n  two\n  lines");
  spans("a: &x \"q\"\nb: {c: *x}\n", "a", "&x \"q\"");
  spans("a: &x \"q\"\nb:\n  c: *x\n", "b", "c: *x");
  spans("a:\nb: 2\n", "a", "");
  HELD(abbe_yaml, y) = parse("a: [1]\nb:\n- 1\n");
  assert_true(abbe_yaml_is_flow(y, abbe_yaml_get(y, abbe_yaml_root(y), "a")));
  assert_false(abbe_yaml_is_flow(y, abbe_yaml_get(y, abbe_yaml_root(y), "b")));
  assert_false(abbe_yaml_is_flow(y, abbe_yaml_root(y)));
}

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
