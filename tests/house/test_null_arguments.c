/* Every function of the API that returns a result, called wrongly: a pointer to nowhere is an
 * assertion in a debug build and ABBE_INVALID_ARGUMENT in all others; zeros are used or refused. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MADV_DONTNEED */
#include "tests/check.h"
#include "tests/null_arguments/null_arguments.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

/* Parameters that may be NULL, by their headers. */
static const struct {
  const char *function, *parameter;
} optional[] = {
    {"abbe_lib_comparison_draw", "title"},
    {"abbe_lib_comparison_make", "mask"},
    {"abbe_lib_comparison_make", "settings"},
    {"abbe_lib_gem_report_make", "progress"},
    {"abbe_lib_gem_report_make", "settings"},
    {"abbe_lib_gem_report_make", "user"},
    {"abbe_lib_materials_index", "k"},
    {"abbe_lib_materials_index", "lambda_nm"},
    {"abbe_lib_materials_index", "n"},
    {"abbe_lib_materials_load", "table"},
    {"abbe_lib_presets_read", "path"},
    {"abbe_lib_scene_lay_map", "like"},
    {"abbe_lib_scene_plan", "settings"},
    {"abbe_lib_scene_times", "picture"},
    {"abbe_lib_scene_times", "settings"},
    {"abbe_lib_scene_trace_times", "picture"},
    {"abbe_lib_scene_trace_times", "settings"},
    {"abbe_lib_picture_make", "pixels"},
    {"abbe_lib_picture_save_png", "settings"},
    {"abbe_lib_scene_change", "set"},
    {"abbe_lib_scene_look", "eye"},
    {"abbe_lib_scene_look", "target"},
    {"abbe_lib_scene_look", "up"},
    {"abbe_lib_scene_map", "light"},
    {"abbe_lib_scene_open", "materials"},
    {"abbe_lib_scene_open", "set"},
    {"abbe_lib_scene_open", "stone"},
    {"abbe_lib_scene_render", "settings"},
    {"abbe_lib_scene_trace", "like"},
    {"abbe_lib_scene_trace", "map"},
    {"abbe_lib_scene_trace", "picture"},
    {"abbe_lib_scene_trace", "settings"},
    {"abbe_lib_weights_fill", "illuminant"},
    {"abbe_lib_weights_fill", "space"},
};

enum { ROOM = 1 << 18, NONE = -2, ALL = -1, CRASHED = 256, MOST_TRIALS = 1 << 10 };
static int null_at;
static bool frees; /* the function called may free what it is given */
static char *zeros;

/* A function to be called with the pointer of that number NULL, or with none or all of them; its
 * result, or CRASHED and the signal's number, 0 where the process left by itself. */
typedef struct trial {
  const null_call *call;
  int at, result;
} trial;

/* Shared with the children that fill in the results. */
static struct {
  size_t count, under_way;
  trial trial[MOST_TRIALS];
} * board;

void *null_pointer(int at, null_kind kind) {
  if (null_at == ALL || null_at == at || kind == NULL_HANDLE) return NULL;
  return frees ? calloc(1, ROOM) : zeros + (size_t)at * ROOM;
}

static bool is_free(const char *function) {
  const size_t length = strlen(function);
  return length > 5 && strcmp(function + length - 5, "_free") == 0;
}

static void *map(size_t size, int flags) {
  void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, flags | MAP_ANONYMOUS, -1, 0);
  return memory == MAP_FAILED ? NULL : memory;
}

static void setup(void) {
  zeros = map(NULL_PARAMETERS * ROOM, MAP_PRIVATE);
  board = map(sizeof *board, MAP_SHARED);
  assert_non_null(zeros);
  assert_non_null(board);
}

static void teardown(void) {
  munmap(zeros, NULL_PARAMETERS * ROOM);
  assert_false(munmap(board, sizeof *board));
}

static void add_trial(const null_call *call, int at) {
  assert_true(board->count < MOST_TRIALS);
  board->trial[board->count++] = (trial){call, at, 0};
}

/* The trials from one on, until they end or one of them ends the process. */
static void run_from(size_t first) {
  if (freopen("/dev/null", "w", stderr) == NULL) _exit(200);
  signal(SIGABRT, SIG_DFL);
  signal(SIGSEGV, SIG_DFL);
  for (size_t i = first; i < board->count; i++) {
    trial *t = &board->trial[i];
    board->under_way = i;
    /* what the last call wrote is nothing but zeros again */
    if (madvise(zeros, NULL_PARAMETERS * ROOM, MADV_DONTNEED) != 0) _exit(201);
    null_at = t->at;
    frees = is_free(t->call->name);
    alarm(600); /* for what hangs */
    t->result = (int)t->call->run();
  }
  board->under_way = board->count;
  _exit(0);
}

/* All trials, in children: one, and another after each crash. */
static void run_trials(void) {
  for (size_t first = 0; first < board->count; first = board->under_way + 1) {
    int status = 0;
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) run_from(first);
    assert_int_equal(waitpid(child, &status, 0), child);
    if (board->under_way < board->count)
      board->trial[board->under_way].result =
          CRASHED + (WIFSIGNALED(status) ? WTERMSIG(status) : 0);
  }
}

static bool may_be_null(const char *function, const char *parameter) {
  if (is_free(function)) return true;
  for (size_t i = 0; i < sizeof optional / sizeof *optional; i++)
    if (strcmp(optional[i].function, function) == 0 &&
        strcmp(optional[i].parameter, parameter) == 0)
      return true;
  return false;
}

/* An assertion is no crash where there are any. */
static bool is_a_crash(int result) {
#ifdef NDEBUG
  return result >= CRASHED;
#else
  return result >= CRASHED && result != CRASHED + SIGABRT;
#endif
}

static bool is_refused(int result) {
#ifdef NDEBUG
  return result == ABBE_INVALID_ARGUMENT;
#else
  return result == CRASHED + SIGABRT;
#endif
}

/* Whether a call with this pointer NULL, or with ALL of them, has to be refused. */
static bool must_be_refused(const null_call *call, int at) {
  for (int p = at == ALL ? 0 : at; p < (at == ALL ? call->count : at + 1); p++)
    if (call->parameter[p][0] != '\0' && !may_be_null(call->name, call->parameter[p])) return true;
  return false;
}

GROUP(setup, teardown);

TEST(a_pointer_to_nowhere_is_refused) {
  size_t wrong = 0;
  assert_true(null_call_count > 25);
  board->count = 0;
  for (size_t i = 0; i < null_call_count; i++) {
    for (int p = 0; p < null_calls[i].count; p++)
      if (null_calls[i].parameter[p][0] != '\0') add_trial(&null_calls[i], p);
    add_trial(&null_calls[i], ALL);
  }
  assert_true(board->count > 100);
  run_trials();
  for (size_t i = 0; i < board->count; i++) {
    const trial *t = &board->trial[i];
    if (must_be_refused(t->call, t->at) ? is_refused(t->result) : !is_a_crash(t->result)) continue;
    wrong++;
    print_error("%s: with %s NULL it ends with %d\n", t->call->name,
                t->at == ALL ? "all pointers" : t->call->parameter[t->at], t->result);
  }
  assert_int_equal(wrong, 0);
}

TEST(zeros_are_used_or_refused) {
  size_t wrong = 0;
  board->count = 0;
  for (size_t i = 0; i < null_call_count; i++) add_trial(&null_calls[i], NONE);
  run_trials();
  for (size_t i = 0; i < board->count; i++) {
    if (!is_a_crash(board->trial[i].result)) continue;
    wrong++;
    print_error("%s: of zeros it ends with %d\n", board->trial[i].call->name,
                board->trial[i].result);
  }
  assert_int_equal(wrong, 0);
}
