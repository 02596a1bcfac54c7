#include "tests/check.h"

#include "colorimetry/plot/text_plot.h"

static abbe_text_plot make(size_t columns, size_t rows) {
  abbe_text_plot p;
  abbe_axis x = {0, 1, false, false}, y = {0, 1, false, false};
  OK(abbe_text_plot_make(columns, rows, x, y, &p, &error));
  return p;
}

static void check_rows(abbe_text_plot *p, bool plain, const char *wanted) {
  char text[1024] = "", cell[4];
  for (size_t row = 0; row < p->rows; row++) {
    for (size_t i = 0; i < p->columns; i++)
      strcat(text, abbe_text_plot_cell(p, i, row, plain, cell));
    strcat(text, "\n");
  }
  assert_string_equal(text, wanted);
}

TEST(lines_are_dots) {
  abbe_text_plot p = make(4, 2);
  const double x[] = {0, 1}, up[] = {0, 1};
  abbe_text_plot_line(&p, 1, 2, x, up); /* the diagonal of an 8 x 8 grid */
  check_rows(&p, false, "  ⡠⠊\n⡠⠊  \n");
  check_rows(&p, true, "  .'\n.'  \n");
  assert_int_equal(abbe_text_plot_curve(&p, 0, 1), 1);
  assert_int_equal(abbe_text_plot_curve(&p, 0, 0), 0);
  const double flat[] = {1, 1};
  abbe_text_plot_line(&p, 2, 2, x, flat);
  check_rows(&p, false, "⠉⠉⡩⠋\n⡠⠊  \n");
  assert_int_equal(abbe_text_plot_curve(&p, 3, 0), 2);
  abbe_text_plot_free(&p);
}

TEST(gaps_stay_open) {
  abbe_text_plot p = make(4, 1);
  const double x[] = {0, 0.25, 0.5, 0.75, 1}, y[] = {0, 0, NAN, 5, 0};
  abbe_text_plot_line(&p, 1, 5, x, y);
  check_rows(&p, false, "⣀⡀ ⢀\n");
  abbe_text_plot_free(&p);
}

TEST(points_are_crosses) {
  abbe_text_plot p = make(3, 2);
  const double x[] = {0.4, 2, 1}, y[] = {0.43, 0.5, NAN};
  abbe_text_plot_points(&p, 3, 3, x, y);
  check_rows(&p, false, " ⡀ \n⠈⠋ \n");
  abbe_text_plot_free(&p);
}

TEST(sides_are_checked) {
  abbe_text_plot p;
  abbe_axis a = {0, 1, false, false};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_text_plot_make(0, 1, a, a, &p, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_text_plot_make(1, 1025, a, a, &p, &error));
  abbe_text_plot_free(&p);
}
