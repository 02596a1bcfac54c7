/* Tables of a view against the view, as OpenColorIO reads them. */
#include "colorimetry/screen/lut.h"

#include "base/file.h"

#include "tests/check.h"

#include <unistd.h>

static const char *const endings[] = {".cube", ".clf"};

static const char *path_of(const char *ending) {
  static char path[64];
  snprintf(path, sizeof path, "/tmp/abbe-test-lut-%ld%s", (long)getpid(), ending);
  return path;
}

static abbe_display *make_display(const char *view) {
  abbe_display *display = NULL;
  OK(abbe_display_make(&(abbe_display_desc){.view = view}, &display, &error));
  return display;
}

static const char *const names[] = {"R", "G", "B"};

/* Light at node (r, g, b) of n, -10 to 6.5 stops around 0.18. */
static void node_light(const int node[3], int n, float *out) {
  const double a = 0.18 / 1024, h = 0.18 * exp2(6.5);
  for (int c = 0; c < 3; c++)
    out[c] = (float)(a * (pow((h + a) / a, (double)node[c] / (n - 1)) - 1));
}

/* All three channels differ, so a table whose order is wrong fails. */
TEST(nodes_are_the_views_own) {
  static const int nodes[][3] = {{0, 0, 0},   {8, 8, 8},  {16, 16, 16},
                                 {11, 9, 13}, {3, 12, 7}, {15, 1, 10}};
  enum { COUNT = sizeof nodes / sizeof *nodes };
  for (int e = 0; e < 2; e++) {
    abbe_display *display = make_display("Looking");
    abbe_lut_error off;
    MADE(abbe_image, shown, abbe_image_make(COUNT, 1, 3, names, &shown, &error));
    MADE(abbe_image, looked_up, abbe_image_make(COUNT, 1, 3, names, &looked_up, &error));
    for (int i = 0; i < COUNT; i++) {
      node_light(nodes[i], 17, shown.data + 3 * i);
      node_light(nodes[i], 17, looked_up.data + 3 * i);
    }
    const abbe_lut_desc desc = {.display = display, .input = "A&B", .output = "<C\">", .nodes = 17};
    OK(abbe_lut_write(&desc, path_of(endings[e]), &off, &error));
    OK(abbe_display_apply(display, &shown, &error));
    OK(abbe_lut_apply(path_of(endings[e]), &looked_up, &error));
    /* Between the shaper's 65,536 entries the darkest nodes are cut by a straight line. */
    for (int i = 0; i < 3 * COUNT; i++)
      assert_float_equal(looked_up.data[i], shown.data[i], e == 0 ? 2e-4 : 2e-6);
    abbe_display_free(display);
    unlink(path_of(endings[e]));
  }
}

/* Linear interpolation of a smooth view errs by the square of the nodes' distance. */
TEST(twice_the_nodes_leave_a_quarter_of_the_error) {
  abbe_display *display = make_display("Looking");
  abbe_lut_error few, many;
  abbe_lut_desc desc = {.display = display, .input = "ACEScg", .output = "sRGB", .nodes = 17};
  OK(abbe_lut_write(&desc, path_of(".clf"), &few, &error));
  desc.nodes = 33;
  OK(abbe_lut_write(&desc, path_of(".clf"), &many, &error));
  assert_true(few.mean > 0.001 && few.mean < 0.01);
  assert_in_range(1000 * few.mean / many.mean, 3000, 5000);
  assert_in_range(1000 * few.most_grey / many.most_grey, 3000, 5000);
  assert_true(many.most < few.most && many.most_grey < many.most);
  abbe_display_free(display);
  unlink(path_of(".clf"));
}

/* The shaper's range has all digits, however dark the table is. */
TEST(a_dark_table_is_right_too) {
  abbe_display *display = NULL;
  OK(abbe_display_make(&(abbe_display_desc){.view = "Looking", .exposure = 25}, &display, &error));
  abbe_lut_error off;
  const abbe_lut_desc desc = {
      .display = display, .input = "a", .output = "b", .nodes = 33, .low = -32, .high = -20};
  OK(abbe_lut_write(&desc, path_of(".cube"), &off, &error));
  assert_true(off.mean < 0.01 && off.most < 0.1);
  abbe_display_free(display);
  unlink(path_of(".cube"));
}

TEST(a_file_says_what_it_is_for) {
  abbe_display *display = make_display("Plain");
  for (int e = 0; e < 2; e++) {
    abbe_lut_error off;
    FREED char *text = NULL;
    size_t size;
    const abbe_lut_desc desc = FIELDS(.display = display, .input = "ACEScg",
                                      .output = "sRGB / Plain", .nodes = 2, .low = -3, .high = 2);
    OK(abbe_lut_write(&desc, path_of(endings[e]), &off, &error));
    OK(abbe_file_read(path_of(endings[e]), 1 << 24, &text, &size, &error));
    assert_non_null(strstr(text, "ACEScg"));
    assert_non_null(strstr(text, "sRGB / Plain"));
    assert_non_null(strstr(text, "-3 to 2 stops from 0.18"));
    /* Resolve's ranges of the shaper, up to 0.18 * 2^2, and of the table; the version of CLF. */
    if (e == 0) assert_non_null(strstr(text, "\nLUT_1D_INPUT_RANGE 0 0.72\n"));
    if (e == 0) assert_non_null(strstr(text, "\nLUT_3D_INPUT_RANGE 0 1\n"));
    if (e == 1) assert_non_null(strstr(text, " compCLFversion=\"3.0\""));
    unlink(path_of(endings[e]));
  }
  abbe_display_free(display);
}

TEST(what_is_no_table_is_refused) {
  abbe_display *display = make_display(NULL);
  abbe_lut_error off;
  const struct {
    size_t nodes;
    double low, high;
    const char *path, *words;
  } wrong[] = {{1, -1, 1, "a.cube", "2 to 129"},          {130, -1, 1, "a.cube", "2 to 129"},
               {3, 1, -1, "a.cube", "do not rise"},       {3, -41, 1, "a.cube", "do not rise"},
               {3, NAN, 1, "a.cube", "do not rise"},      {3, -1, 1, "a.png", ".cube or .clf"},
               {3, -1, 1, "/nowhere/a.clf", "/nowhere/a"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    const abbe_lut_desc desc =
        FIELDS(.display = display, .input = "a", .output = "b", .nodes = wrong[i].nodes,
               .low = wrong[i].low, .high = wrong[i].high);
    REFUSED(i == 6 ? ABBE_IO : ABBE_INVALID_ARGUMENT, wrong[i].words,
            abbe_lut_write(&desc, wrong[i].path, &off, &error));
  }
  abbe_display_free(display);
}
