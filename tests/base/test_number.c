#include "tests/check.h"

#include "base/number.h"

#include <locale.h>

TEST(written_numbers_are_short_and_read_back) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  assert_string_equal(abbe_number_text(1.5168, text), "1.5168");
  assert_string_equal(abbe_number_text(0.1 + 0.2, text), "0.30000000000000004");
  assert_string_equal(abbe_number_text(0, text), "0");
  assert_string_equal(abbe_number_text(NAN, text), "nan");
  assert_string_equal(abbe_number_text(-INFINITY, text), "-inf");
  srand(1);
  for (int i = 0; i < 20000; i++) {
    double value = ldexp((double)rand() / RAND_MAX - 0.5, rand() % 600 - 300), back = 0;
    const char *end;
    assert_true(abbe_number_read(abbe_number_text(value, text), &end, &back));
    assert_int_equal(*end, '\0');
    assert_true(back == value);
  }
}

TEST(only_decimal_numbers_are_read) {
  const char *end;
  double value = 7;
  const char *const none[] = {"", "-", ".", "x1", "nan", "inf", "0x10", "+", "-.", "e5"};
  for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
    assert_false(abbe_number_read(none[i], &end, &value));
    assert_ptr_equal(end, none[i]);
  }
  const char *text = " \t-1.5E-003 rest";
  assert_true(abbe_number_read(text, &end, &value));
  assert_near(value, -0.0015, 0);
  assert_string_equal(end, " rest");
  assert_true(abbe_number_read(".5,", &end, &value));
  assert_near(value, 0.5, 0);
  assert_true(abbe_number_read("1e999", &end, &value) && isinf(value));
}

TEST(lengths_have_units) {
  static const struct {
    const char *text;
    double metres;
    const char *rest;
  } read[] = {{"6.5mm", 0.0065, ""},   {"6.5 mm", 0.0065, ""}, {"-3cm", -0.03, ""},
              {"0.2 in", 0.00508, ""}, {"2ft", 0.6096, ""},    {"7um", 7e-6, ""},
              {"1.5 m", 1.5, ""},      {"0.25", 0.25, ""},     {"1e-3m, 2", 1e-3, ", 2"},
              {"3 mn", 3, " mn"},      {"3 mmm", 3, " mmm"},   {"4 inches", 4, " inches"}};
  for (size_t i = 0; i < sizeof read / sizeof *read; i++) {
    const char *end;
    double metres = 0;
    assert_true(abbe_number_read_length(read[i].text, &end, &metres));
    assert_near(metres, read[i].metres, 0);
    assert_string_equal(end, read[i].rest);
  }
  const char *end;
  double metres;
  assert_false(abbe_number_read_length("mm", &end, &metres));
}

/* Where the host has a locale with a decimal comma, it is without effect, and left as it was. */
TEST(the_hosts_locale_is_without_effect) {
  const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "C.UTF-8"};
  for (int i = 0; i < 4 && setlocale(LC_ALL, names[i]) == NULL; i++)
    ;
  char text[ABBE_NUMBER_TEXT_SIZE];
  const char *before = printed("%.1f", 0.5);
  double value = 0;
  const char *end;
  assert_string_equal(abbe_number_text(0.5, text), "0.5");
  assert_true(abbe_number_read("2.5", &end, &value));
  assert_near(value, 2.5, 0);
  assert_string_equal(before, printed("%.1f", 0.5));
  setlocale(LC_ALL, "C");
}
