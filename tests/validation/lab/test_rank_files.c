#include "validation/lab/ranked_optimum.h"

#include "base/file.h"
#include "tests/check.h"

#include <unistd.h>

static void put(const char *path) {
  OK(abbe_file_write(path, "x", 1, &error));
}

/* Of neighbours only those that a rank would write are found, in the order of their numbers. */
TEST(ranks_files_are_found_and_removed) {
  static const char *const strange[] = {"rank_files.csv",    "rank_files.csv.01",
                                        "rank_files.csv.",   "rank_files.csv.1b",
                                        "rank_files.csv2.1", "a_rank_files.csv.1"};
  size_t *rank, count;
  char *name;
  for (size_t i = 0; i < sizeof strange / sizeof *strange; i++) put(strange[i]);
  OK(abbe_rank_files_find("rank_files.csv", &rank, &count, &error));
  assert_int_equal(count, 0);
  assert_null(rank);
  static const size_t there[] = {0, 2, 11};
  for (size_t i = 3; i-- > 0;) {
    OK(abbe_rank_files_name("rank_files.csv", there[i], &name, &error));
    put(name);
    free(name);
  }
  assert_int_equal(access("rank_files.csv.11", F_OK), 0);
  char here[4096], path[sizeof here + 32];
  assert_non_null(getcwd(here, sizeof here));
  snprintf(path, sizeof path, "%s/rank_files.csv", here);
  OK(abbe_rank_files_find(path, &rank, &count, &error));
  assert_int_equal(count, 3);
  assert_memory_equal(rank, there, sizeof there);
  free(rank);
  abbe_rank_files_remove(path);
  OK(abbe_rank_files_find(path, &rank, &count, &error));
  assert_int_equal(count, 0);
  for (size_t i = 0; i < sizeof strange / sizeof *strange; i++)
    assert_int_equal(unlink(strange[i]), 0);
}

TEST(a_folder_that_is_not_there_is_named) {
  size_t *rank, count;
  REFUSED(ABBE_IO, "nowhere/: the folder cannot be read",
          abbe_rank_files_find("nowhere/a.csv", &rank, &count, &error));
  abbe_rank_files_remove("nowhere/a.csv");
}
