/* Ranks as threads of one process: what they say to each other goes through shared memory. */
#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/ranked_run.h"

#include <pthread.h>
#include <unistd.h>

enum { MOST_RANKS = 4 };

static abbe_scene scene;
static const abbe_trace_desc small = {
    .width = 8, .height = 6, .map_width = 8, .photons = 1000, .threads = 1, .bands = 2};

/* ---- ranks ---- */

static pthread_barrier_t barrier;
static abbe_whole_sum *offered[MOST_RANKS];
static uint64_t values[MOST_RANKS];
static void *given;
static size_t ranks_there;
static _Thread_local size_t own_rank;

static void sum(abbe_whole_sum *x, size_t count) {
  offered[own_rank] = x;
  pthread_barrier_wait(&barrier);
  for (size_t r = ranks_there - 1; own_rank == 0 && r > 0; r--)
    for (size_t i = 0; i < count; i++) x[i] += offered[r][i];
  pthread_barrier_wait(&barrier);
}

static void spread(void *data, size_t size) {
  if (own_rank == 0) given = data;
  pthread_barrier_wait(&barrier);
  if (own_rank > 0) memcpy(data, given, size);
  pthread_barrier_wait(&barrier);
}

static uint64_t most(uint64_t value) {
  values[own_rank] = value;
  pthread_barrier_wait(&barrier);
  for (size_t r = 0; r < ranks_there; r++)
    if (values[r] > value) value = values[r];
  pthread_barrier_wait(&barrier);
  return value;
}

typedef struct job {
  abbe_ranks ranks;
  abbe_tracer *tracer;
  abbe_trace_run_desc desc;
  char file[96];
  bool agrees;
  size_t stop_after; /* calls of progress; 0: never */
  abbe_result result;
  abbe_error error;
} job;

static bool progress(void *user, double done) {
  job *j = user;
  return done >= 0 && done <= 1 && (j->stop_after == 0 || --j->stop_after > 0);
}

static void *work(void *user) {
  job *j = user;
  own_rank = j->ranks.rank;
  j->result = abbe_ranks_compare(&j->ranks, j->tracer, &j->error);
  j->agrees = j->result == ABBE_OK;
  if (j->agrees) j->result = abbe_ranked_run(&j->ranks, j->tracer, &j->desc, &j->error);
  return NULL;
}

/* ---- runs ---- */

static char folder[64];

static void prepare(job *j, const abbe_trace_desc *desc, size_t rank, size_t ranks, bool resume) {
  *j = (job){.ranks = {rank, ranks, sum, spread, most}, .tracer = make_tracer(&scene, desc)};
  snprintf(j->file, sizeof j->file, "%s/rank-%zu.ck", folder, rank);
  OK(abbe_tracer_begin_at(j->tracer, rank, ranks, &error));
  if (resume && access(j->file, F_OK) == 0) OK(abbe_checkpoint_load(j->tracer, j->file, &error));
}

static void run(job *j, size_t ranks) {
  pthread_t thread[MOST_RANKS];
  ranks_there = ranks;
  pthread_barrier_init(&barrier, NULL, (unsigned)ranks);
  for (size_t r = 0; r < ranks; r++)
    assert_int_equal(pthread_create(&thread[r], NULL, work, &j[r]), 0);
  for (size_t r = 0; r < ranks; r++) pthread_join(thread[r], NULL);
  pthread_barrier_destroy(&barrier);
}

static void finish(job *j, size_t ranks) {
  for (size_t r = 0; r < ranks; r++) abbe_tracer_free(j[r].tracer);
}

static void check_same(const abbe_tracer *a, const abbe_tracer *b) {
  abbe_image x, y;
  abbe_trace_statistics s, t;
  assert_int_equal(abbe_tracer_passes(a), abbe_tracer_passes(b));
  for (int map = 0; map < 2; map++) {
    abbe_result (*const image)(const abbe_tracer *, abbe_image *, abbe_error *) =
        map ? abbe_tracer_map : abbe_tracer_picture;
    OK(image(a, &x, NULL));
    OK(image(b, &y, NULL));
    check_same_image(&x, &y);
    abbe_image_free(&x);
    abbe_image_free(&y);
  }
  abbe_tracer_statistics(a, &s);
  abbe_tracer_statistics(b, &t);
  assert_true(s.photons == t.photons && s.light_rays == t.light_rays);
  assert_true(s.eye_rays == t.eye_rays && s.cuts == t.cuts && s.radius == t.radius);
  assert_memory_equal(&s.ledger, &t.ledger, sizeof s.ledger);
}

static abbe_tracer *whole_run(const abbe_trace_desc *desc, size_t passes) {
  abbe_tracer *t = make_tracer(&scene, desc);
  run_passes(t, passes);
  return t;
}

/* ---- tests ---- */

TEST(any_number_of_ranks_gives_the_bits_of_one) {
  static const size_t passes[] = {1, 3, 7};
  for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
    abbe_trace_desc desc = small;
    desc.guides = i == 1;
    HELD(abbe_tracer, whole) = whole_run(&desc, passes[i]);
    for (size_t ranks = 1; ranks <= MOST_RANKS; ranks++) {
      job j[MOST_RANKS];
      for (size_t r = 0; r < ranks; r++) {
        desc.threads = 1 + r % 2;
        prepare(&j[r], &desc, r, ranks, false);
        j[r].desc.passes = passes[i];
      }
      run(j, ranks);
      for (size_t r = 0; r < ranks; r++) assert_int_equal(j[r].result, ABBE_OK);
      check_same(whole, j[0].tracer);
      finish(j, ranks);
    }
  }
}

/* The error is looked at after as many passes, however many ranks there are. */
TEST(an_error_ends_all_at_the_same_pass) {
  HELD(abbe_tracer, whole) = whole_run(&small, 10);
  const double target = abbe_tracer_error(whole) * 1.0001;
  size_t done = 0;
  for (size_t ranks = 1; ranks <= MOST_RANKS; ranks++) {
    job j[MOST_RANKS];
    for (size_t r = 0; r < ranks; r++) {
      prepare(&j[r], &small, r, ranks, false);
      j[r].desc.error = target;
      j[r].desc.progress = progress;
      j[r].desc.user = &j[r];
    }
    run(j, ranks);
    for (size_t r = 0; r < ranks; r++) assert_int_equal(j[r].result, ABBE_OK);
    if (ranks == 1) done = abbe_tracer_passes(j[0].tracer);
    assert_int_equal(abbe_tracer_passes(j[0].tracer), done);
    assert_true(done >= 4 && done <= 10 && abbe_tracer_error(j[0].tracer) <= target);
    abbe_tracer *same = whole_run(&small, done);
    check_same(same, j[0].tracer);
    abbe_tracer_free(same);
    finish(j, ranks);
  }
}

TEST(time_ends_all_with_passes_from_0_on) {
  for (size_t ranks = 1; ranks <= 3; ranks += 2) {
    job j[MOST_RANKS];
    for (size_t r = 0; r < ranks; r++) {
      prepare(&j[r], &small, r, ranks, false);
      j[r].desc.seconds = r == 0 ? 0.05 : 1e6; /* rank 0's clock alone counts */
    }
    run(j, ranks);
    const size_t done = abbe_tracer_passes(j[0].tracer);
    assert_true(j[0].result == ABBE_OK && done >= 2 && done % ranks == 0);
    abbe_tracer *same = whole_run(&small, done);
    check_same(same, j[0].tracer);
    abbe_tracer_free(same);
    finish(j, ranks);
  }
}

/* One is stopped: all end, keep what they have, and go on from it, those of a rank that lost its
 * file from the beginning. */
TEST(ranks_that_were_stopped_go_on) {
  enum { RANKS = 3, PASSES = 8 };
  HELD(abbe_tracer, whole) = whole_run(&small, PASSES);
  for (int lost = 0; lost < 2; lost++) {
    for (int again = 0; again < 2; again++) {
      job j[RANKS];
      for (size_t r = 0; r < RANKS; r++) {
        prepare(&j[r], &small, r, RANKS, again);
        j[r].desc = (abbe_trace_run_desc){.passes = PASSES,
                                          .checkpoint = j[r].file,
                                          .checkpoint_s = 1e6,
                                          .progress = progress,
                                          .user = &j[r]};
        j[r].stop_after = !again && r == 1 ? 2 : 0;
      }
      run(j, RANKS);
      for (size_t r = 0; r < RANKS; r++)
        assert_int_equal(j[r].result, again ? ABBE_OK : ABBE_CANCELLED);
      if (again) check_same(whole, j[0].tracer);
      if (!again) assert_int_equal(abbe_tracer_passes(j[1].tracer), 1);
      if (!again && lost) unlink(j[2].file);
      finish(j, RANKS);
    }
    /* the parts of ranks merge like others */
    char file[RANKS][96];
    for (size_t r = 0; r < RANKS; r++) {
      snprintf(file[r], sizeof file[r], "%s/rank-%zu.ck", folder, r);
      HELD(abbe_tracer, t) = make_tracer(&scene, &small);
      OK(abbe_tracer_begin_at(t, r, RANKS, &error));
      run_passes(t, r < 2 ? 3 : 2);
      OK(abbe_checkpoint_save(t, file[r], &error));
    }
    abbe_tracer *merged = make_tracer(&scene, &small);
    const char *const paths[] = {file[2], file[0], file[1]};
    REFUSED(ABBE_INVALID_ARGUMENT, "pass 1 is missing",
            abbe_checkpoint_merge(merged, paths, 2, NULL, &error));
    OK(abbe_checkpoint_merge(merged, paths, RANKS, NULL, &error));
    check_same(whole, merged);
    abbe_tracer_free(merged);
    for (size_t r = 0; r < RANKS; r++) unlink(file[r]);
  }
}

TEST(ranks_that_differ_are_refused) {
  job j[2];
  abbe_trace_desc other = small;
  other.seed = 5;
  prepare(&j[0], &small, 0, 2, false);
  prepare(&j[1], &other, 1, 2, false);
  run(j, 2);
  assert_int_equal(j[0].result, ABBE_CANCELLED);
  assert_contains(j[0].error.text, "rank 1");
  assert_int_equal(j[1].result, ABBE_INVALID_ARGUMENT);
  assert_contains(j[1].error.text, "seed 0");
  finish(j, 2);
}

/* A part that is beyond what is asked for now. */
TEST(fewer_passes_than_there_are_are_refused) {
  job j[2];
  for (size_t r = 0; r < 2; r++) {
    prepare(&j[r], &small, r, 2, false);
    j[r].desc.passes = 3;
  }
  run_passes(j[1].tracer, 2);
  run(j, 2);
  assert_int_equal(j[0].result, ABBE_INVALID_ARGUMENT);
  assert_contains(j[0].error.text, "pass 3");
  assert_int_equal(j[1].result, ABBE_CANCELLED);
  finish(j, 2);
}

TEST(looks_are_a_quarter_apart_at_the_most) {
  static const size_t first[] = {4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40};
  size_t at = 0;
  for (size_t i = 0; i < sizeof first / sizeof *first; i++) {
    at = abbe_ranked_run_next_look(at);
    assert_int_equal(at, first[i]);
  }
  for (; at < 1u << 20; at = abbe_ranked_run_next_look(at))
    assert_true(4 * abbe_ranked_run_next_look(at) <= 5 * at);
}

static void setup(void) {
  snprintf(folder, sizeof folder, "/tmp/abbe-test-ranks-XXXXXX");
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BEADS("crown"));
  assert_non_null(mkdtemp(folder));
}

static void teardown(void) {
  abbe_scene_free(&scene);
  assert_false(rmdir(folder));
}

GROUP(setup, teardown);
