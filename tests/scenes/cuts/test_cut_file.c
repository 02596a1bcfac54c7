#include "scenes/cuts/cut_file.h"

#include "base/file.h"
#include "tests/check.h"

#include <stdlib.h>
#include <unistd.h>

TEST(the_ending_says_the_kind) {
  char folder[] = "/tmp/abbe_cut_XXXXXX", path[64];
  const char text[] = "g 96 0\na 90 1 96 24 48 72\na 0 1\na -0 1\n";
  abbe_cut cut;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/box.ASC", folder);
  assert_int_equal(abbe_file_write(path, text, strlen(text), NULL), ABBE_OK);
  assert_int_equal(abbe_cut_file_read(path, &cut, NULL, NULL), ABBE_OK);
  assert_int_equal(cut.facet_count, 6);
  abbe_cut_free(&cut);
  unlink(path);
  rmdir(folder);
}

TEST(others_are_refused) {
  abbe_cut cut;
  abbe_error error;
  assert_int_equal(abbe_cut_file_read("stone.stl", &cut, NULL, &error), ABBE_UNSUPPORTED);
  assert_contains(error.text, "'stone.stl' is no design");
  assert_int_equal(abbe_cut_file_read("a.asc/stone", &cut, NULL, &error), ABBE_UNSUPPORTED);
  assert_int_equal(abbe_cut_file_read("/nowhere/stone.gcs", &cut, NULL, &error), ABBE_IO);
  assert_int_equal(abbe_cut_file_read("/dev/zero.gem", &cut, NULL, &error), ABBE_IO);
}

/* Planes that close no stone, however well they are written. */
TEST(an_open_design_is_named) {
  char folder[] = "/tmp/abbe_cut_XXXXXX", path[64];
  const char open[] = "g 96 0\na 90 1 96 24 48 72\n",
             box[] = "g 96 0\na 90 1 96 24 48 72\na 0 1\na -0 1\n";
  abbe_cut cut;
  abbe_cut_polyhedron stone;
  abbe_error error;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/open.asc", folder);
  assert_int_equal(abbe_file_write(path, open, strlen(open), NULL), ABBE_OK);
  assert_int_equal(abbe_cut_file_read_stone(path, 1e-6, &cut, &stone, NULL, &error), ABBE_GEOMETRY);
  assert_contains(error.text, path);
  assert_contains(error.text, "leave the stone open on top: the crown lacks facets");
  abbe_cut_polyhedron_free(&stone);
  abbe_cut_free(&cut);
  assert_int_equal(abbe_file_write(path, box, strlen(box), NULL), ABBE_OK);
  assert_int_equal(abbe_cut_file_read_stone(path, 1e-6, &cut, &stone, NULL, &error), ABBE_OK);
  assert_int_equal(stone.face_count, 6);
  abbe_cut_polyhedron_free(&stone);
  abbe_cut_free(&cut);
  unlink(path);
  rmdir(folder);
}
