/* The chart of known answers: what is in it, and what is refused. */
#include "tests/check.h"

#include "base/file.h"
#include "tests/fontconfig.h"
#include "tests/svg.h"
#include "validation/lab/known/known_answers.h"

#include <unistd.h>

/* The text of the picture that these rows make; the caller frees. */
static char *draw(abbe_known_answer *row, size_t count) {
  char *text = NULL;
  size_t size = 0;
  const abbe_known_answers answers = {.count = count, .row = row};
  const char *path = printed("/tmp/abbe_test_known_chart_%ld.svg", (long)getpid());
  OK(abbe_known_chart_write(path, &answers, &error));
  OK(abbe_file_read(path, 1 << 22, &text, &size, &error));
  unlink(path);
  return text;
}

/* A round mark: the middle of a filled path of curves alone, and its colour. */
typedef struct mark {
  double x, y, red;
} mark;

enum { MOST = 32, LEGEND = 850 }; /* marks of the legend stand right of that */

/* The marks of the data, from left to right. */
static size_t find_marks(const char *text, mark *out) {
  size_t count = 0;
  for (const char *at = text; (at = svg_path(at)) != NULL; at++) {
    double red, x0, y0, c[6];
    if (sscanf(svg_value(at, "fill"), "rgb(%lf%%", &red) != 1 ||
        sscanf(svg_value(at, "d"), "M %lf %lf C %lf %lf %lf %lf %lf %lf", &x0, &y0, &c[0], &c[1],
               &c[2], &c[3], &c[4], &c[5]) != 8)
      continue;
    mark m = {0.5 * (x0 + c[4]), y0, red};
    if (m.x > LEGEND) continue;
    assert_true(count < MOST);
    size_t k = count++;
    for (; k > 0 && out[k - 1].x > m.x; k--) out[k] = out[k - 1];
    out[k] = m;
  }
  return count;
}

TEST(errors_stand_over_their_rows_in_their_groups_colour) {
  abbe_known_answer rows[] = {{.group = "a", .error = 0.5, .tolerance = 1},
                              {.group = "a", .error = -1, .tolerance = 2},
                              {.group = "b", .error = NAN, .tolerance = 1},
                              {.group = "b", .error = 0, .tolerance = 0}};
  FREED char *text = draw(rows, 4);
  mark m[MOST];
  assert_int_equal(find_marks(text, m), 3); /* nothing is drawn of what is no number */
  assert_near(m[2].x - m[1].x, 2 * (m[1].x - m[0].x), 0.01);
  assert_near(m[0].y + m[1].y, 2 * m[2].y, 0.01); /* 0.5, -0.5, 0; downwards */
  assert_near(m[1].y - m[0].y, 200, 1);           /* half of what -1 to 1 take up */
  assert_near(m[0].red, m[1].red, 0);
  assert_true(m[2].red != m[0].red);
}

TEST(rows_out_of_tolerance_are_seen) {
  abbe_known_answer rows[] = {{.group = "a", .error = 0, .tolerance = 1},
                              {.group = "a", .error = -7, .tolerance = 1},
                              {.group = "b", .error = 1, .tolerance = NAN},
                              {.group = "b", .error = 3, .tolerance = 0},
                              {.group = "c", .error = 1e300, .tolerance = 1e-300}};
  FREED char *text = draw(rows, 5);
  mark m[MOST];
  assert_int_equal(find_marks(text, m), 2);
  assert_near(m[1].y - m[0].y, 200 * 7 / 7.7,
              1); /* 1.1 times the furthest reach the frame's edge */
  assert_contains(text, "</svg>");
}

/* Two rows that stand over photons make a second chart above, with their errors. */
TEST(photons_make_a_chart_of_their_own) {
  abbe_known_answer rows[] = {
      {.group = "a", .exact = 0.1, .traced = 0.11, .tolerance = 0.1, .photons = 1000},
      {.group = "a", .exact = 0.05, .traced = 0.04, .tolerance = 0.1, .photons = 4000}};
  FREED char *both = draw(rows, 2), *one = draw(rows, 1);
  mark m[MOST], upper[MOST];
  size_t count = find_marks(both, m), above = 0;
  for (size_t i = 0; i < count; i++)
    if (m[i].y < 450) upper[above++] = m[i];
  assert_int_equal(count - above, 2);
  assert_true(above >= 2); /* and the legend's, which stands inside */
  assert_true(upper[0].x < upper[1].x && upper[0].y < upper[1].y); /* more photons, less error */
  assert_int_equal(find_marks(one, m), 1);
}

TEST(nothing_is_refused) {
  const abbe_known_answers none = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "x.svg: there are no answers",
          abbe_known_chart_write("x.svg", &none, &error));
  abbe_known_answer row = {.group = "a", .tolerance = 1};
  const abbe_known_answers one = {.count = 1, .row = &row};
  REFUSED(ABBE_IO, "", abbe_known_chart_write("/no/such/folder/x.svg", &one, &error));
}
