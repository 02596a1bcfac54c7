#define _XOPEN_SOURCE 700
#include "tests/check.h"
#include "tests/fontconfig.h"

#include "base/file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/plot/chart.h"

#include <unistd.h>

static char folder[64], path[2][96];

static void make_folder(void) {
  snprintf(folder, sizeof folder, "/tmp/abbe-test-chart-XXXXXX");
  assert_non_null(mkdtemp(folder));
  snprintf(path[0], sizeof path[0], "%s/c.png", folder);
  snprintf(path[1], sizeof path[1], "%s/c.SVG", folder);
}

static void drop_folder(void) {
  unlink(path[0]);
  unlink(path[1]);
  assert_false(rmdir(folder));
}

static abbe_image draw(const abbe_chart *charts, size_t count, size_t width, size_t height) {
  abbe_image image;
  if (abbe_chart_write(path[0], charts, count, width, height, &last_error) != ABBE_OK ||
      abbe_png_read(path[0], &image, &last_error) != ABBE_OK)
    fail_msg("%s", last_error.text);
  return image;
}

/* Whether the pixel is, by half or more, of the series colour 2: vermilion over white. */
static bool is_vermilion(const abbe_image *image, size_t x, size_t y) {
  const float *p = image->data + 3 * (y * image->width + x);
  float share = 1 - p[2];
  return share > 0.5f && fabsf(p[0] - (1 - 0.165f * share)) < 0.05f &&
         fabsf(p[1] - (1 - 0.631f * share)) < 0.07f;
}

typedef struct spot {
  double x, y;
  size_t count;
} spot;

/* The centre of the vermilion pixels in columns [from, to). */
static spot find(const abbe_image *image, size_t from, size_t to) {
  spot s = {0};
  for (size_t y = 0; y < image->height; y++)
    for (size_t x = from; x < to; x++)
      if (is_vermilion(image, x, y)) {
        s.x += (double)x;
        s.y += (double)y;
        s.count++;
      }
  s.x /= (double)s.count;
  s.y /= (double)s.count;
  return s;
}

/* Three points in even steps of their axes lie in even steps of pixels. */
static void check_steps(const double *x, const double *y, bool log, bool reversed) {
  abbe_chart_series series = {.style = ABBE_CHART_POINTS, .count = 3, .x = x, .y = y, .colour = 2};
  abbe_chart chart = FIELDS(.x = {.log = log, .reversed = reversed}, .y = {.log = log},
                            .series_count = 1, .series = &series);
  OWNED(abbe_image, image) = draw(&chart, 1, 400, 300);
  spot s[3];
  size_t at = 0;
  for (int i = 0; i < 3; i++) {
    size_t from = at;
    while (from < image.width && find(&image, from, from + 1).count == 0) from++;
    for (at = from; at < image.width && find(&image, at, at + 1).count > 0;) at++;
    s[i] = find(&image, from, at);
    assert_int_in_range(s[i].count, 24, 44); /* of a dot of radius 3.2 */
  }
  double down = reversed ? -1 : 1;
  assert_near(s[1].x - s[0].x, s[2].x - s[1].x, 0.6);
  assert_near(s[1].y - s[0].y, s[2].y - s[1].y, 0.6);
  assert_true(s[1].x - s[0].x > 100);
  assert_true(down * (s[0].y - s[1].y) > 80);
}

EACH(make_folder, drop_folder);

TEST(points_lie_where_their_axes_say) {
  check_steps((double[]){0, 5, 10}, (double[]){-1, 0, 1}, false, false);
  check_steps((double[]){0, 5, 10}, (double[]){-1, 0, 1}, false, true);
  check_steps((double[]){1, 10, 100}, (double[]){1e-4, 1e-2, 1}, true, false);
}

TEST(gaps_and_bars_are_drawn) {
  const double x[] = {0, 1, 2, 3, 4}, y[] = {1, 1, NAN, 1, 1}, low[] = {0, 0, 0, 0, 0},
               high[] = {2, 2, 2, 2, 2};
  abbe_chart_series series = {.count = 5, .x = x, .y = y, .colour = 2};
  abbe_chart chart = {.y = {.min = -1, .max = 3}, .series_count = 1, .series = &series};
  OWNED(abbe_image, image) = draw(&chart, 1, 400, 300);
  size_t left = 0, right = image.width - 1;
  while (find(&image, left, left + 1).count == 0) left++;
  while (find(&image, right, right + 1).count == 0) right--;
  size_t quarter = (right - left) / 4;
  assert_true(find(&image, left + quarter / 2, left + quarter / 2 + 1).count > 0);
  for (size_t i = left + quarter + 4; i + 4 < left + 3 * quarter; i++)
    assert_int_equal(find(&image, i, i + 1).count, 0);
  abbe_image_free(&image);
  series = (abbe_chart_series){.style = ABBE_CHART_POINTS,
                               .count = 5,
                               .x = x,
                               .y = y,
                               .low = low,
                               .high = high,
                               .colour = 2};
  image = draw(&chart, 1, 400, 300);
  spot s = find(&image, 0, image.width);
  double top = 0, bottom = 0;
  for (size_t row = 0; row < image.height; row++)
    for (size_t i = 0; i < image.width; i++)
      if (is_vermilion(&image, i, row)) {
        if (top == 0) top = (double)row;
        bottom = (double)row;
      }
  assert_near((top + bottom) / 2, s.y, 1);
  assert_true(bottom - top > 100); /* half of the plot's height */
}

TEST(a_field_has_its_colours_and_scale) {
  const float value[] = {-1, 0, 2, NAN};
  abbe_chart_field field = {
      .width = 2, .height = 2, .value = value, .map = ABBE_COLOUR_MAP_DIFFERENCE};
  abbe_chart chart = {.field = &field};
  OWNED(abbe_image, image) = draw(&chart, 1, 400, 300);
  /* the plot is square, as its pixels are: about 270 high, left of the scale bar */
  const double at[4] = {0.25, 0.5, 1, NAN};
  for (int i = 0; i < 4; i++) {
    double rgb[3];
    abbe_colour_map_at(ABBE_COLOUR_MAP_DIFFERENCE, at[i], rgb);
    size_t pixels = 0;
    for (size_t k = 0; k < image.width * image.height; k++) {
      const float *p = image.data + 3 * k;
      pixels += fabs((double)p[0] - rgb[0]) < 0.003 && fabs((double)p[1] - rgb[1]) < 0.003 &&
                fabs((double)p[2] - rgb[2]) < 0.003;
    }
    if (pixels < 120 * 120) fail_msg("colour %d covers %zu pixels", i, pixels);
  }
}

/* Of the two rows and three columns only one chart has a point; the picture's cells are equal. */
TEST(a_grid_runs_row_by_row) {
  const double x[] = {5}, y[] = {5};
  abbe_chart_series series = {.style = ABBE_CHART_POINTS, .count = 1, .x = x, .y = y, .colour = 2};
  spot at[6];
  for (size_t i = 0; i < 6; i++) {
    abbe_chart charts[6] = {0};
    OWNED(abbe_image, image);
    for (size_t k = 0; k < 6; k++) {
      charts[k].x = (abbe_chart_axis){.min = 0, .max = 10};
      charts[k].y = charts[k].x;
    }
    charts[i].series_count = 1;
    charts[i].series = &series;
    if (abbe_chart_write_grid(path[0], charts, 6, 3, 600, 300, &last_error) != ABBE_OK ||
        abbe_png_read(path[0], &image, &last_error) != ABBE_OK)
      fail_msg("%s", last_error.text);
    at[i] = find(&image, 0, image.width);
    assert_int_in_range(at[i].count, 24, 44);
  }
  for (size_t i = 0; i < 6; i++) {
    assert_near(at[i].x - at[0].x, 200.0 * (double)(i % 3), 0.6);
    assert_near(at[i].y - at[0].y, 150.0 * (double)(i / 3), 0.6);
  }
}

TEST(an_svg_is_whole_and_scales) {
  const double x[] = {1, 2}, y[] = {1, 2};
  abbe_chart_series series = {.label = "a & <b>", .count = 2, .x = x, .y = y};
  abbe_chart charts[2] = {{.title = "One", .series_count = 1, .series = &series}, {.share = 0.5}};
  OK(abbe_chart_write(path[1], charts, 2, 500, 400, &error));
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(path[1], 1 << 22, &text, &size, &error));
  assert_contains(text, "<svg");
  assert_contains(text, "viewBox=\"0 0 500 400\"");
  assert_string_equal(text + size - 7, "</svg>\n");
}

/* Behind the header, where the PNG specification wants it, before the palette or the pixels. */
TEST(a_png_says_that_it_is_srgb) {
  const double x[] = {1, 2}, y[] = {1, 2};
  abbe_chart_series series = {.count = 2, .x = x, .y = y};
  abbe_chart chart = {.series_count = 1, .series = &series};
  OWNED(abbe_image, image) = draw(&chart, 1, 100, 80);
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(path[0], 1 << 22, &data, &size, &error));
  assert_memory_equal(data + 12, "IHDR", 4);
  assert_memory_equal(data + 33, "\0\0\0\1sRGB\1\xd9\xc9\x2c\x7f", 13);
}

/* Whatever it is asked to show, it shows something or says why not, and no file is left half done.
 */
TEST(awkward_charts_are_drawn_or_refused) {
  const double wild[] = {NAN, INFINITY, -1e300, 1e300, 0}, one[] = {1, 1, 1, 1, 1};
  const char *const names[] = {"a", NULL, "c", "d", "e"};
  abbe_chart_series many[40];
  for (int i = 0; i < 40; i++)
    many[i] = (abbe_chart_series){.label = "a series with quite a long label",
                                  .style = (abbe_chart_style)(i % 5),
                                  .count = 5,
                                  .x = i % 2 ? wild : one,
                                  .y = i % 3 ? wild : one,
                                  .low = i % 5 == 4 ? wild : NULL,
                                  .high = i % 5 == 4 ? one : NULL,
                                  .text = names};
  for (int log = 0; log < 2; log++) {
    abbe_chart chart = {.x = {.log = log}, .y = {.log = log}, .series_count = 40, .series = many};
    OWNED(abbe_image, image) = draw(&chart, 1, 64 + 800 * (size_t)log, 64 + 300 * (size_t)log);
  }
  const float field[1] = {0};
  abbe_chart_field good = {.width = 1, .height = 1, .value = field}, none = {.width = 1};
  abbe_chart_series bare = {.count = 1}, odd = {.colour = 17};
  const struct {
    abbe_chart chart;
    const char *part;
  } wrong[] = {
      {{.x = {.min = 2, .max = 1}}, "the x axis of a chart cannot run from 2 to 1"},
      {{.y = {.min = 0, .max = 1, .log = true}}, "the y axis of a chart cannot run from 0 to 1 in"},
      {{.y = {.min = 0, .max = INFINITY}}, "cannot run from 0 to inf"},
      {{.series_count = 1, .series = &bare}, "series 0 of a chart lacks"},
      {{.series_count = 1, .series = &odd}, "has the colour 17"},
      {{.field = &none}, "field of 1 x 0"},
  };
  unlink(path[0]);
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, wrong[i].part,
            abbe_chart_write(path[0], &wrong[i].chart, 1, 0, 0, &error));
  }
  abbe_chart empty = {.field = &good};
  REFUSED(ABBE_INVALID_ARGUMENT, ".png or .svg",
          abbe_chart_write("chart.jpg", &empty, 1, 0, 0, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_chart_write(path[0], &empty, 1, 63, 0, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_chart_write(path[0], &empty, 0, 0, 0, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "1 charts do not fill 2 columns",
          abbe_chart_write_grid(path[0], &empty, 1, 2, 0, 0, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_chart_write_grid(path[0], &empty, 1, 0, 0, 0, &error));
  REFUSED(ABBE_IO, "/no/such/c.png", abbe_chart_write("/no/such/c.png", &empty, 1, 0, 0, &error));
  assert_int_not_equal(access(path[0], F_OK), 0);
}
