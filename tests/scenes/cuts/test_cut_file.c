#include "tests/check.h"

#include "base/file.h"
#include "scenes/cuts/cut_file.h"
#include "tests/fontconfig.h"
#include "tests/scenes/cuts/designs.h"
#include "tests/svg.h"

#include <unistd.h>

TEST(the_ending_says_the_kind) {
  char folder[] = "/tmp/abbe_cut_XXXXXX";
  const char text[] = "g 96 0\na 90 1 96 24 48 72\na 0 1\na -0 1\n";
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/box.ASC", folder);
  OK(abbe_file_write(path, text, strlen(text), &error));
  MADE(abbe_cut, cut, abbe_cut_file_read(path, &cut, NULL, &error));
  assert_int_equal(cut.facet_count, 6);
  unlink(path);
  rmdir(folder);
}

TEST(others_are_refused) {
  abbe_cut cut;
  REFUSED(ABBE_UNSUPPORTED, "'stone.stl' is no design",
          abbe_cut_file_read("stone.stl", &cut, NULL, &error));
  REFUSED(ABBE_UNSUPPORTED, "is no design that is known by its name",
          abbe_cut_file_read("a.asc/stone", &cut, NULL, &error));
  REFUSED(ABBE_IO, "No such file or directory",
          abbe_cut_file_read("/nowhere/stone.gcs", &cut, NULL, &error));
  REFUSED(ABBE_IO, "No such file or directory",
          abbe_cut_file_read("/dev/zero.gem", &cut, NULL, &error));
}

/* Planes that close no stone, however well they are written. */
TEST(an_open_design_is_named) {
  char folder[] = "/tmp/abbe_cut_XXXXXX";
  const char open[] = "g 96 0\na 90 1 96 24 48 72\n",
             box[] = "g 96 0\na 90 1 96 24 48 72\na 0 1\na -0 1\n";
  OWNED(abbe_cut, cut) = {0};
  OWNED(abbe_cut_polyhedron, stone) = {0};
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/open.asc", folder);
  OK(abbe_file_write(path, open, strlen(open), &error));
  REFUSED(ABBE_GEOMETRY, path, abbe_cut_file_read_stone(path, 1e-6, &cut, &stone, NULL, &error));
  assert_contains(last_error.text, "leave the stone open on top: the crown lacks facets");
  abbe_cut_polyhedron_free(&stone);
  abbe_cut_free(&cut);
  OK(abbe_file_write(path, box, strlen(box), &error));
  OK(abbe_cut_file_read_stone(path, 1e-6, &cut, &stone, NULL, &error));
  assert_int_equal(stone.face_count, 6);
  unlink(path);
  rmdir(folder);
}

/* Sheets to cut from: all that a cutter reads is on them, in each format, or nothing is. */

static void write_sheet(const char *path, const char *text, const char *note) {
  OWNED(abbe_cut, cut) = design_parse(text);
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  OK(abbe_cut_diagram_write(path, &cut, &p, note, 1.54, &error));
}

/* Each face that is seen is one closed path, filled and outlined: of design A 33 from above, 24
 * from below and half of all from each side. */
TEST(an_svg_has_all_faces) {
  FREED char *data = NULL;
  size_t size;
  write_sheet("cut_diagram_test.svg", design_a, "a note");
  OK(abbe_file_read("cut_diagram_test.svg", 1 << 22, &data, &size, &error));
  assert_int_equal(unlink("cut_diagram_test.svg"), 0);
  /* the profile's sides show 8 of 16 girdle facets and those of crown and pavilion that look there
   */
  size_t outlines = 0;
  for (const char *at = data; (at = svg_path(at)) != NULL; at++)
    outlines += strncmp(svg_value(at, "stroke-width"), "0.7", 3) == 0;
  if (outlines < 33 + 24 + 2 * 30 || outlines > 33 + 24 + 2 * 45)
    fail_msg("%zu outlines of faces", outlines);
}

/* Design A has a pavilion of 43 degrees, and one of 44.5: below the critical angle of water, 48.6,
 * and not of quartz. Letters are drawn as shapes in red. */
TEST(flat_tiers_are_marked) {
  size_t red[2];
  for (int i = 0; i < 2; i++) {
    FREED char *data = NULL;
    size_t size;
    OWNED(abbe_cut, cut) = design_parse(design_a);
    MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
    OK(abbe_cut_diagram_write("cut_diagram_test.svg", &cut, &p, NULL, i == 0 ? 1.544 : 1.333,
                              &error));
    OK(abbe_file_read("cut_diagram_test.svg", 1 << 22, &data, &size, &error));
    assert_int_equal(unlink("cut_diagram_test.svg"), 0);
    red[i] = 0;
    for (const char *at = data; (at = strstr(at, "rgb(75%")) != NULL; at++) red[i]++;
  }
  assert_int_equal(red[0], 0);
  assert_true(red[1] > 0);
}

TEST(a_png_is_as_long_as_its_table) {
  size_t height[3];
  char headed[20100], tall[20000] = "g 96 0\na -45 1 96 24 48 72\na 0 1 96\n";
  for (int i = 0; i < 60; i++) strcat(tall, "a -90 1 96 24 48 72 G and a line that says why\n");
  snprintf(headed, sizeof headed, "H a title\nH one\nH two\nH three\n%s", tall);
  for (int i = 0; i < 3; i++) {
    FREED char *data = NULL;
    size_t size;
    write_sheet("cut_diagram_test.png", i == 0 ? design_c : i == 1 ? tall : headed, NULL);
    OK(abbe_file_read("cut_diagram_test.png", 1 << 24, &data, &size, &error));
    const unsigned char *head = (const unsigned char *)data;
    assert_memory_equal(head + 12, "IHDR", 4);
    assert_int_equal(head[18] * 256 + head[19], 595 * ABBE_CUT_DIAGRAM_PIXELS);
    height[i] = (size_t)(head[22] * 256 + head[23]);
  }
  assert_int_equal(unlink("cut_diagram_test.png"), 0);
  assert_int_equal(height[0], 842 * ABBE_CUT_DIAGRAM_PIXELS);
  assert_true(height[1] > height[0] + 60 * 8 * ABBE_CUT_DIAGRAM_PIXELS / 2);
  /* two of the five lines below the title find no room above the views */
  assert_true(height[2] >= height[1] + 2 * 11 * ABBE_CUT_DIAGRAM_PIXELS);
}

TEST(a_pdf_and_what_is_refused) {
  FREED char *data = NULL;
  size_t size;
  write_sheet("cut_diagram_test.pdf", design_d, NULL);
  OK(abbe_file_read("cut_diagram_test.pdf", 1 << 22, &data, &size, &error));
  assert_memory_equal(data, "%PDF", 4);
  assert_int_equal(unlink("cut_diagram_test.pdf"), 0);
  OWNED(abbe_cut, cut) = design_parse(design_c);
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "ends with .pdf, .svg or .png",
          abbe_cut_diagram_write("sheet.jpg", &cut, &p, NULL, 0, &error));
  REFUSED(ABBE_IO, "", abbe_cut_diagram_write("no/such/folder/a.pdf", &cut, &p, NULL, 0, &error));
}
