#include "scenes/cuts/cut_file.h"

#include "base/file.h"
#include "tests/check.h"

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
