#include "tests/check.h"

#include "base/text.h"

#include <cjson/cJSON.h>
#include <float.h>

TEST(letters_are_told_and_cut_ones_trimmed) {
  assert_int_equal(abbe_utf8_letter(""), 0);
  assert_int_equal(abbe_utf8_letter("a"), 1);
  assert_int_equal(abbe_utf8_letter("\xe2\x82\xac"), 3);
  assert_int_equal(abbe_utf8_letter("\xe2\x82"), 0);
  assert_int_equal(abbe_utf8_letter("\x80"), 0);
  const char *const rows[][2] = {{"", ""},
                                 {"ab", "ab"},
                                 {"a\xe2\x82", "a"},
                                 {"a\xe2\x82\xac", "a\xe2\x82\xac"},
                                 {"\xf0\x9f\x92", ""},
                                 {"a\xc3", "a"}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    char text[16];
    strcpy(text, rows[i][0]);
    abbe_utf8_trim(text);
    assert_string_equal(text, rows[i][1]);
  }
}

TEST(what_a_terminal_obeys_becomes_pictures) {
  static const struct {
    const char *text, *lines, *line;
  } rows[] = {{"", "", ""},
              {"plain \xe2\x82\xac \xf0\x9f\x92\x8e", "plain \xe2\x82\xac \xf0\x9f\x92\x8e",
               "plain \xe2\x82\xac \xf0\x9f\x92\x8e"},
              {"a\nb\tc\r\nd\re",
               "a\nb\tc\r\nd\xe2\x90\x8d"
               "e",
               "a b c  d\xe2\x90\x8d"
               "e"},
              {"\x1b[2J\x7f\x01", "\xe2\x90\x9b[2J\xe2\x90\xa1\xe2\x90\x81",
               "\xe2\x90\x9b[2J\xe2\x90\xa1\xe2\x90\x81"},
              {"\xc2\x9b"
               "1m\xc2\xa0",
               "\xef\xbf\xbd"
               "1m\xc2\xa0",
               "\xef\xbf\xbd"
               "1m\xc2\xa0"},
              {"\x9b\xc0\x80\xed\xa0\x80\xe2\x82", NULL, NULL}}; /* eight bytes that are no UTF-8 */
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char out[64], eight[25] = "";
    for (int k = 0; k < 8; k++) strcat(eight, "\xef\xbf\xbd");
    for (int lines = 0; lines < 2; lines++) {
      const char *right = rows[i].lines == NULL ? eight : lines ? rows[i].lines : rows[i].line;
      const size_t n =
          abbe_utf8_printable(rows[i].text, strlen(rows[i].text), lines != 0, out, sizeof out);
      assert_string_equal(out, right);
      assert_int_equal(n, strlen(right));
    }
  }
  char zero[16], small[4] = "xyz";
  assert_int_equal(abbe_utf8_printable("a\0b", 3, false, zero, sizeof zero), 5);
  assert_string_equal(zero, "a\xe2\x90\x80"
                            "b");
  assert_int_equal(abbe_utf8_printable("a\x1b"
                                       "b",
                                       3, false, small, 4),
                   1); /* a letter is whole */
  assert_string_equal(small, "a");
  assert_int_equal(abbe_utf8_printable("ab", 2, false, small, 1), 0);
  assert_string_equal(small, "");
}

TEST(what_misleads_the_eye_is_shown) {
  /* of each range its ends, and the letters beside them, which stay */
  static const struct {
    const char *first, *last, *before, *after;
  } rows[] = {{"\u061c", "\u061c", "\u061b", "\u061d"},
              {"\u200b", "\u200f", "\u200a", "\u2010"},
              {"\u2028", "\u202e", "\u2027", "\u202f"},
              {"\u2060", "\u206f", "\u205f", "\u2070"},
              {"\ufeff", "\ufeff", "\ufefc", "\uff01"},
              {"\ufff9", "\ufffb", "\uffee", "\ufffc"},
              {"\U000e0001", "\U000e007f", "\u6c34", "\U000e0100"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int lines = 0; lines < 2; lines++) {
      char out[64];
      const char *text =
          printed("%s a%sb%sc %s", rows[i].before, rows[i].first, rows[i].last, rows[i].after);
      const char *right = printed("%s a\ufffdb\ufffdc %s", rows[i].before, rows[i].after);
      const size_t n = abbe_utf8_printable(text, strlen(text), lines != 0, out, sizeof out);
      assert_string_equal(out, right);
      assert_int_equal(n, strlen(right));
    }
}

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

static const double hard[] = {0.1 + 0.2,
                              2.4175239999999997,
                              1.0 / 3,
                              DBL_MAX,
                              DBL_MIN,
                              5e-324,
                              1 - DBL_EPSILON / 2,
                              1e22,
                              -0.1,
                              123456789012345678.0,
                              1e15 + 0.5,
                              0.1,
                              42,
                              -7e-30,
                              -0.0};
enum { HARD = sizeof hard / sizeof *hard };

TEST(every_number_reads_back_to_the_same_double) {
  for (int lines = 0; lines < 2; lines++) {
    cJSON *root = cJSON_CreateObject(), *list = cJSON_CreateDoubleArray(hard, HARD);
    cJSON_AddItemToObject(root, "list", list);
    cJSON_AddNumberToObject(root, "sum", 0.1 + 0.2);
    char *text = abbe_json_text(root, lines != 0);
    assert_non_null(text);
    assert_contains(text, "0.30000000000000004");
    cJSON *back = cJSON_Parse(text);
    assert_non_null(back);
    for (int i = 0; i < HARD; i++) {
      const double value = cJSON_GetArrayItem(cJSON_GetObjectItem(back, "list"), i)->valuedouble;
      assert_memory_equal(&value, &hard[i], sizeof value);
    }
    /* what was printed is not changed */
    assert_true(cJSON_IsNumber(cJSON_GetObjectItem(root, "sum")));
    cJSON_free(text);
    cJSON_Delete(back);
    cJSON_Delete(root);
  }
}

TEST(random_doubles_read_back) {
  uint64_t bits = 88172645463325252u;
  for (int i = 0; i < 2000; i++) {
    double value;
    bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
    memcpy(&value, &bits, sizeof value);
    if (!isfinite(value)) continue;
    cJSON *number = cJSON_CreateNumber(value);
    char *text = abbe_json_text(number, false);
    cJSON *back = cJSON_Parse(text);
    assert_memory_equal(&back->valuedouble, &value, sizeof value);
    cJSON_free(text);
    cJSON_Delete(number);
    cJSON_Delete(back);
  }
}

TEST(other_items_are_as_cjson_prints_them) {
  cJSON *root = cJSON_Parse("{\"a\":[true,null,\"0.1\",0.5],\"b\":{\"c\":-3}}");
  cJSON_AddNumberToObject(root, "no", NAN);
  char *text = abbe_json_text(root, false);
  assert_string_equal(text, "{\"a\":[true,null,\"0.1\",0.5],\"b\":{\"c\":-3},\"no\":null}");
  cJSON_free(text);
  cJSON_Delete(root);
  assert_null(abbe_json_text(NULL, true));
}
