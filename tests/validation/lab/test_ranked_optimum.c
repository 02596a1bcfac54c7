#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
/* Any number of ranks finds what one search finds, to the last bit, also where they were stopped
 * and others go on. */
#include "validation/lab/ranked_optimum.h"

#include "base/file.h"
#include "tests/validation/lab/forked_ranks.h"
#include "tests/validation/measure/gem/gem_stones.h"
#include "validation/measure/gem/gem_grid_file.h"

static const char *const path = "ranked_optimum.csv";

/* One search, as each process has it. */
typedef struct asked {
  judged j;
  abbe_material quartz;
  abbe_gem_optimum_desc search;
  size_t left; /* pairs until rank 1 stops; 0: never */
  size_t judged;
  abbe_gem_optimum out;
  abbe_error error;
} asked;

static asked prepare(void) {
  asked a = {.quartz = glass(1.54)};
  a.search = small_search();
  a.j = judged_make(design_a, &a.quartz, 1);
  return a;
}

static bool progress(void *user, double done) {
  asked *a = user;
  assert_true(done > 0 && done <= 1);
  a->judged++;
  return forked_rank != 1 || a->left == 0 || --a->left > 0;
}

static abbe_result find(const abbe_ranks *ranks, void *user) {
  asked *a = user;
  a->search.progress = progress;
  a->search.user = a;
  const abbe_ranked_optimum_desc desc =
      FIELDS(.cut = &a->j.cut, .polyhedron = &a->j.polyhedron, .material = &a->quartz,
             .wavelengths = &a->j.wavelengths, .weights = &a->j.weights, .search = &a->search,
             .path = path);
  return abbe_ranked_optimum_find(ranks, &desc, &a->out, &a->error);
}

static abbe_gem_optimum alone(const asked *a) {
  abbe_gem_optimum o;
  abbe_gem_optimum_desc search = a->search;
  search.progress = NULL;
  OK(abbe_gem_optimum_find(&a->j.cut, &a->j.polyhedron, &a->quartz, &a->j.wavelengths,
                           &a->j.weights, &search, &o, &error));
  return o;
}

static void check_same(const abbe_gem_optimum *a, const abbe_gem_optimum *b) {
  assert_int_equal(a->crowns * a->pavilions, 12);
  assert_memory_equal(a->value, b->value, 12 * sizeof *a->value);
  assert_int_equal(a->best, b->best);
  assert_true(a->design.value == b->design.value);
}

TEST(any_number_of_ranks_finds_the_same) {
  asked a = prepare();
  abbe_gem_optimum one = alone(&a);
  for (size_t count = 1; count <= 3; count++) {
    abbe_result others[2] = {0};
    a.judged = 0;
    OK(forked_run(count, find, &a, others));
    assert_true(others[0] == ABBE_OK && others[1] == ABBE_OK);
    assert_int_equal(a.judged, 12 / count);
    check_same(&a.out, &one);
    abbe_gem_optimum_free(&a.out);
    abbe_rank_files_remove(path);
  }
  abbe_gem_optimum_free(&one);
  judged_free(&a.j);
}

/* Three ranks of which one is stopped after two of its four pairs; then two, who judge the two
 * pairs that are left. */
TEST(other_ranks_go_on) {
  asked a = prepare();
  abbe_gem_optimum one = alone(&a);
  abbe_result others[2];
  a.left = 2;
  assert_int_equal(forked_run(3, find, &a, others), ABBE_CANCELLED);
  assert_contains(a.error.text, "rank 1 cannot go on");
  assert_true(others[0] == ABBE_CANCELLED && others[1] == ABBE_CANCELLED);
  assert_null(a.out.value);
  a.left = 0;
  a.judged = 0;
  OK(forked_run(2, find, &a, NULL));
  assert_int_equal(a.judged, 1);
  check_same(&a.out, &one);
  abbe_gem_optimum_free(&a.out);
  /* All is known; a search for something else is told so by the files that are there. */
  a.judged = 0;
  OK(forked_run(2, find, &a, NULL));
  assert_int_equal(a.judged, 0);
  abbe_gem_optimum_free(&a.out);
  a.search.measure = ABBE_GEM_COS;
  assert_int_equal(forked_run(2, find, &a, others), ABBE_INVALID_ARGUMENT);
  assert_contains(a.error.text, "ranked_optimum.csv.0 is of another search");
  assert_int_equal(others[0], ABBE_CANCELLED);
  abbe_rank_files_remove(path);
  abbe_gem_optimum_free(&one);
  judged_free(&a.j);
}
