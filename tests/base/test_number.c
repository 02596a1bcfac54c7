#include "tests/check.h"

#include "base/maths.h"
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

/* Short decimals are read, and tidied, without the C library, to the same bits. */
TEST(short_decimals_are_the_c_library_s) {
  srand(2);
  for (int i = 0; i < 200000; i++) {
    char text[80], tidied[40];
    const int digits = 1 + rand() % 18, power = rand() % 60 - 30;
    const double number = ldexp((double)rand() / RAND_MAX - 0.5, rand() % 40 - 10);
    if (i % 2 == 0)
      snprintf(text, sizeof text, "%.*f", digits, number);
    else
      snprintf(text, sizeof text, "%.*g%s%d,", digits, number, i % 4 == 1 ? "e" : "E+",
               i % 4 == 1 ? power : abs(power));
    char *right_end;
    const char *end;
    double value, right = strtod(text, &right_end);
    if (!abbe_number_read(text, &end, &value) || end != right_end ||
        memcmp(&value, &right, sizeof value) != 0)
      fail_msg("'%s' is read as %.17g", text, value);
    right *= i % 3 == 0 ? 1000 : 1;
    snprintf(tidied, sizeof tidied, "%.15g", right);
    if (isfinite(right) && abbe_number_tidy(right) != strtod(tidied, NULL))
      fail_msg("%.17g is tidied to %.17g", right, abbe_number_tidy(right));
  }
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

TEST(products) {
  const double x[3] = {1, 0, 0}, y[3] = {0, 2, 0};
  double z[3];
  abbe_vector_cross(x, y, z);
  assert_true(z[0] == 0 && z[1] == 0 && z[2] == 2);
  assert_true(abbe_vector_dot(x, y) == 0);
  assert_true(abbe_vector_length(y) == 2);
  abbe_vector_subtract(z, y, z);
  assert_true(z[1] == -2 && z[2] == 2);
}

TEST(normalising_zero_or_infinity_is_refused) {
  double zero[3] = {0, 0, 0}, infinite[3] = {INFINITY, 0, 0}, good[3] = {0, 0, -4};
  assert_false(abbe_vector_normalise(zero));
  assert_true(zero[0] == 0 && zero[2] == 0);
  assert_false(abbe_vector_normalise(infinite));
  assert_false(abbe_vector_finite(infinite));
  assert_true(abbe_vector_normalise(good) && good[2] == -1);
}

/* Squares of these are subnormal numbers, of few digits. */
TEST(what_is_next_to_nothing_has_a_direction) {
  for (double size = 1e-120; size > 1e-161; size *= 0.1) {
    double a[3] = {3 * size, -4 * size, 12 * size};
    assert_true(abbe_vector_normalise(a));
    assert_true(fabs(a[0] - 3.0 / 13) < 1e-15 && fabs(a[1] + 4.0 / 13) < 1e-15 &&
                fabs(a[2] - 12.0 / 13) < 1e-15);
  }
}

TEST(triangle_points_along_its_normal) {
  const double a[3] = {1, 1, 5}, b[3] = {3, 1, 5}, c[3] = {1, 2, 5};
  double n[3];
  abbe_vector_triangle(a, b, c, n);
  assert_true(n[0] == 0 && n[1] == 0 && n[2] == 2);
}

/* A frame and its mirror image: columns of length 1, square to each other, to one hand each. */
TEST(frames_are_square) {
  const double a[3] = {0, 3, 0}, b[3] = {-2, 5, 0};
  double frame[9], image[9];
  abbe_vector_frame(a, b, 1, frame);
  abbe_vector_frame(a, b, -1, image);
  const double known[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  for (int k = 0; k < 9; k++) {
    assert_true(fabs(frame[k] - known[k]) < 1e-15);
    assert_true(fabs(image[k] - (k == 8 ? -1 : known[k])) < 1e-15);
  }
}

/* Numbers in order, and in reverse. */

TEST(numbers_come_in_order) {
  double a[] = {2, -INFINITY, 0.5, 1e300, 0.5, -3};
  float b[] = {2, -INFINITY, 0.5f, 1e30f, 0.5f, -3};
  qsort(a, 6, sizeof *a, abbe_order_ascending);
  qsort(b, 6, sizeof *b, abbe_order_ascending_floats);
  for (int i = 0; i < 5; i++) assert_true(a[i] <= a[i + 1] && b[i] <= b[i + 1]);
  qsort(a, 6, sizeof *a, abbe_order_descending);
  qsort(b, 6, sizeof *b, abbe_order_descending_floats);
  for (int i = 0; i < 5; i++) assert_true(a[i] >= a[i + 1] && b[i] >= b[i + 1]);
  assert_true(a[0] == 1e300 && b[0] == 1e30f && a[5] == -INFINITY && b[5] == -INFINITY);
  assert_int_equal(abbe_order_ascending(&a[2], &a[2]), 0);
}
