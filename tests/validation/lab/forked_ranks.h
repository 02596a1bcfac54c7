/* forked_ranks.h: ranks as processes that share a page of memory; rank 0 is the test's own. */
#ifndef ABBE_TESTS_VALIDATION_LAB_FORKED_RANKS_H
#define ABBE_TESTS_VALIDATION_LAB_FORKED_RANKS_H

#include "tests/check.h"

#include "validation/trace/tracer/ranked_run.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { FORKED_MOST = 8 };

static struct forked_page {
  pthread_barrier_t barrier;
  uint64_t value[FORKED_MOST];
} * forked_page;
static size_t forked_count, forked_rank;

static inline uint64_t forked_most(uint64_t value) {
  forked_page->value[forked_rank] = value;
  pthread_barrier_wait(&forked_page->barrier);
  for (size_t r = 0; r < forked_count; r++)
    if (forked_page->value[r] > value) value = forked_page->value[r];
  pthread_barrier_wait(&forked_page->barrier);
  return value;
}

/* Calls work at every rank and gives what rank 0's gives; others[r - 1] (may be NULL) receives what
 * came of rank r. */
static inline abbe_result forked_run(size_t count,
                                     abbe_result (*work)(const abbe_ranks *ranks, void *user),
                                     void *user, abbe_result *others) {
  pthread_barrierattr_t shared;
  pid_t child[FORKED_MOST];
  forked_page =
      mmap(NULL, sizeof *forked_page, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  assert_true(forked_page != MAP_FAILED && count <= FORKED_MOST);
  pthread_barrierattr_init(&shared);
  pthread_barrierattr_setpshared(&shared, PTHREAD_PROCESS_SHARED);
  pthread_barrier_init(&forked_page->barrier, &shared, (unsigned)count);
  forked_count = count;
  for (size_t r = 1; r < count; r++) {
    child[r] = fork();
    assert_true(child[r] >= 0);
    if (child[r] > 0) continue;
    forked_rank = r;
    _exit((int)work(&(abbe_ranks){.rank = r, .count = count, .most = forked_most}, user));
  }
  const abbe_result own = work(&(abbe_ranks){.count = count, .most = forked_most}, user);
  for (size_t r = 1; r < count; r++) {
    int status = 0;
    waitpid(child[r], &status, 0);
    assert_true(WIFEXITED(status));
    if (others != NULL) others[r - 1] = (abbe_result)WEXITSTATUS(status);
  }
  munmap(forked_page, sizeof *forked_page);
  return own;
}

#endif
