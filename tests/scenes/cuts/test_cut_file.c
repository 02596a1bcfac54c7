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
  abbe_cut none;
  path = printed("%s/box.gem", folder);
  OK(abbe_file_write(path, "GemCad 5.0\n", 11, &error));
  REFUSED(ABBE_PARSE, "it is GemCad's text, whose name ends with .asc",
          abbe_cut_file_read(path, &none, NULL, &error));
  OK(abbe_file_write(path, "", 0, &error));
  REFUSED(ABBE_PARSE, "the file ends within", abbe_cut_file_read(path, &none, NULL, &error));
  unlink(path);
  rmdir(folder);
}

/* A disk without room shows at the end of what is written. */
TEST(what_cannot_be_written_is_said) {
  OWNED(abbe_cut, cut) = design_parse(design_a);
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  for (int i = 0; i < 6; i++) {
    FILE *full = fopen("/dev/full", "wb");
    assert_non_null(full);
    setvbuf(full, NULL, _IONBF, 0);
    if (i == 0) REFUSED(ABBE_IO, "written", abbe_cut_asc_write(&cut, full, NULL, &error));
    if (i == 1) REFUSED(ABBE_IO, "written", abbe_cut_gem_write(&cut, &p, full, NULL, &error));
    if (i == 2) REFUSED(ABBE_IO, "written", abbe_cut_gcs_write(&cut, &p, full, NULL, &error));
    if (i >= 3)
      REFUSED(
          ABBE_IO, "written",
          abbe_cut_solid_write(&cut, &p, 1, NULL, (abbe_cut_solid_format)(i - 3), full, &error));
    fclose(full);
  }
  REFUSED(ABBE_INVALID_ARGUMENT, "no such kind",
          abbe_cut_solid_write(&cut, &p, 1, NULL, (abbe_cut_solid_format)99, stderr, &error));
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
  REFUSED(ABBE_INVALID_ARGUMENT, "ends with .pdf, .svg or .png",
          abbe_cut_diagram_write(".png", &cut, &p, NULL, 0, &error));
  REFUSED(ABBE_IO, "", abbe_cut_diagram_write("no/such/folder/a.pdf", &cut, &p, NULL, 0, &error));
}

/* The sheet of the same stone with other words, in letters, or without `what` in ticks of teeth
 * that are not cut. */
static size_t marks_on(const char *text, const char *what) {
  FREED char *data = NULL;
  size_t size, marks = 0;
  write_sheet("cut_diagram_test.svg", text, NULL);
  OK(abbe_file_read("cut_diagram_test.svg", 1 << 22, &data, &size, &error));
  assert_int_equal(unlink("cut_diagram_test.svg"), 0);
  for (const char *at = data; what != NULL && (at = strstr(at, what)) != NULL; at++) marks++;
  for (const char *at = data; what == NULL && (at = svg_path(at)) != NULL; at++)
    marks += strncmp(svg_value(at, "stroke-width"), "0.4", 3) == 0;
  return marks;
}

/* A name is left out where its face has no room for it, teeth beyond 160 are not drawn, an empty
 * tier is none, a long instruction goes on below, and what stands at the foot is there. */
TEST(sheets_hold_what_there_is_room_for) {
  const char *const letter = "<use ";
#define BOX "a 90 1 96 24 48 72\na 0 1%s\na -0 1\na 45.5 1.405 96%s\n%s"
  const size_t plain = marks_on(printed("g 96 0\n" BOX, "", "", ""), letter);
  const size_t named = marks_on(printed("g 96 0\n" BOX, " n Top", "", ""), letter);
  const size_t narrow = marks_on(printed("g 96 0\n" BOX, "", " n Bevelled", ""), letter);
  assert_true(named >= plain + 6);     /* on the face and in the table */
  assert_true(narrow < plain + 2 * 8); /* in the table alone */
  assert_true(marks_on(printed("g 96 0\n" BOX, "", "", "F end of it\n"), letter) >= plain + 7);
  assert_true(marks_on("g 160 0\na 90 1 40 80 120 160\na 0 1\na -0 1\n", NULL) > 100);
  assert_int_equal(marks_on("g 164 0\na 90 1 41 82 123 164\na 0 1\na -0 1\n", NULL), 0);
  char words[900] = " G", names[900] = "g 96 0\na 0 1\na -0 1\na 90 1";
  for (int i = 0; i < 60; i++) strcat(words, " polish");
  for (int i = 1; i <= 64; i++) strcat(names, printed(" %d n N%d", i, i));
  assert_true(marks_on(printed("g 96 0\n" BOX, "", words, ""), letter) >= plain + 60 * 6);
  assert_true(marks_on(names, letter) > 64);
  assert_true(marks_on("g 96 0\na 54.73561 0.5 96 32 64\na -54.73561 0.5 16 48 80\n", letter) > 0);
  OWNED(abbe_cut, cut) = design_parse(printed("g 96 0\nH \n" BOX, "", "", "a -30 1.2 96\n"));
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  OK(abbe_cut_add_tier(&cut, 30, 1, &error));
  OK(abbe_cut_diagram_write("cut_diagram_test.svg", &cut, &p, NULL, 1.54, &error));
  assert_int_equal(unlink("cut_diagram_test.svg"), 0);
#undef BOX
}
