/* The program killed at every call that changes files, and at any moment: the old files or the new
 * ones, and the same command goes on to the very same result. */
#include "tests/cli/run_program.h"

#include "base/file.h"

#include <signal.h>

#define SCENE "\"$house\"/tests/fuzz/corpus/scene/gem.yaml"
#define TRACE                                                                                      \
  "\"$abbe\" trace " SCENE " -q --size 4x3 --photons 64 --map 4 --spp 3 --checkpoint-every 0 "     \
  "--resume -o t.exr --save-map m.exr --png t.png"

/* A command, what it writes, and what may stand beside that when it was killed. */
typedef struct command {
  const char *line;
  const char *output[4];
  const char *old;    /* what stands in the outputs before; NULL: nothing stands there */
  const char *beside; /* or NULL */
  size_t stride;      /* of the calls that are tried */
} command;

/* Of the calls that are tried, every third. */
static size_t sparse(void) {
  return all_cases() ? 1 : 3;
}

static const char *path_of(const char *name) {
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", run_folder, name);
  return path;
}

typedef struct content {
  char *data;
  size_t size;
} content;

static content read_whole(const char *name) {
  content c = {0};
  abbe_file_read(path_of(name), 1 << 24, &c.data, &c.size, NULL);
  return c;
}

static bool holds(const char *name, const content *wanted) {
  content c = read_whole(name);
  const bool same = (c.data == NULL) == (wanted->data == NULL) && c.size == wanted->size &&
                    (c.size == 0 || memcmp(c.data, wanted->data, c.size) == 0);
  free(c.data);
  return same;
}

static void put_old(const command *c) {
  run_each(run_remove, NULL);
  for (int i = 0; c->old != NULL && c->output[i] != NULL; i++)
    OK(abbe_file_write(path_of(c->output[i]), c->old, strlen(c->old), &error));
}

static const command *present;

static void count_strangers(const char *path, const char *name, void *user) {
  (void)path;
  for (int i = 0; present->output[i] != NULL; i++)
    if (strcmp(name, present->output[i]) == 0) return;
  if (present->beside != NULL && strcmp(name, present->beside) == 0) return;
  if (strncmp(name, ".abbe-", 6) == 0) return; /* a whole file of its own name, in nobody's way */
  print_error("left behind: %s\n", name);
  ++*(size_t *)user;
}

static bool old_or_new(const command *c, const content *whole) {
  const content old = {(char *)c->old, c->old != NULL ? strlen(c->old) : 0};
  size_t strangers = 0;
  bool right = true;
  for (int i = 0; c->output[i] != NULL; i++)
    if (!holds(c->output[i], &old) && !holds(c->output[i], &whole[i])) {
      print_error("%s is neither the old file nor the new one\n", c->output[i]);
      right = false;
    }
  present = c;
  run_each(count_strangers, &strangers);
  return right && strangers == 0;
}

static bool is_whole(const command *c, const content *whole) {
  bool right = true;
  for (int i = 0; c->output[i] != NULL; i++) right = right && holds(c->output[i], &whole[i]);
  return right;
}

/* False where the n-th call is past the last one. */
static bool kill_at(const command *c, const content *whole, size_t n) {
  put_old(c);
  const char *line = printed("LD_PRELOAD='" ABBE_PRELOAD "' ABBE_FAULT=kill:%zu %s", n, c->line);
  const int code = run_line(line);
  if (code == 0) {
    assert_true(is_whole(c, whole));
    return false;
  }
  if (code != 137) fail_msg("%s ends with %d: %s", line, code, run_errors);
  if (!old_or_new(c, whole)) fail_msg("after %s", line);
  const int again = run_line(c->line);
  if (again != 0 || !is_whole(c, whole))
    fail_msg("after %s it does not go on: %d, %s", line, again, run_errors);
  return true;
}

static void kill_everywhere(const command *c) {
  content whole[4] = {{0}};
  put_old(c);
  const int code = run_line(c->line);
  if (code != 0) fail_msg("%s ends with %d: %s", c->line, code, run_errors);
  for (int i = 0; c->output[i] != NULL; i++) whole[i] = read_whole(c->output[i]);
  size_t n = 1;
  while (kill_at(c, whole, n)) n += c->stride > 1 ? c->stride * sparse() : 1;
  assert_true(n > 5);
  for (int i = 0; i < 4; i++) free(whole[i].data);
  run_each(run_remove, NULL);
}

static void begin(void) {
  signal(SIGHUP, SIG_DFL); /* whoever runs the tests may ignore it, which programs inherit */
  run_setup();
}

GROUP(begin, run_teardown);

TEST(a_trace) {
  kill_everywhere(&(command){TRACE, {"t.exr", "m.exr", "t.png"}, "old", "t.exr.checkpoint", 31});
}

TEST(a_picture) {
  kill_everywhere(&(command){"\"$abbe\" render " SCENE
                             " -q --size 8x8 --photons 16 --map 32 -o r.exr --png r.png",
                             {"r.exr", "r.png"},
                             "old",
                             NULL,
                             40});
}

TEST(a_table) {
  static const char old[] =
      "materials:\n- {name: a, model: constant, coefficients: [1.5], source: s}\n";
  kill_everywhere(
      &(command){"\"$abbe\" materials set a source=t --table t.yaml", {"t.yaml"}, old, NULL, 1});
}

/* At moments of the clock, by each signal: taken up until it is done, it is the unbroken trace. */
TEST(any_moment) {
  static const char *const signals[] = {"INT", "TERM", "HUP", "KILL"};
  char line[2048];
  static const char trace[] =
      "\"$abbe\" trace " SCENE
      " -q --size 16x16 --photons 20000 --map 16 --spp 12 --checkpoint-every 0 --resume -o";
  snprintf(line, sizeof line, "%s whole.exr", trace);
  run_must(line);
  content whole = read_whole("whole.exr");
  for (int i = 0; i < 4; i++) {
    snprintf(line, sizeof line,
             "i=1; until timeout -s %s 0.$((i / 10 %% 10))$((i %% 10)) %s t.exr; do i=$((i + 7)); "
             "[ $i -lt 99 ] || { %s t.exr; exit $?; }; done",
             signals[i], trace, trace);
    const int code = run_line(line);
    if (code != 0) fail_msg("%s ends with %d: %s", line, code, run_errors);
    assert_true(holds("t.exr", &whole));
    assert_int_equal(access(path_of("t.exr.checkpoint"), F_OK), -1);
    unlink(path_of("t.exr"));
  }
  free(whole.data);
}

/* Asked to end, it says what it did and how to go on; the checkpoint is there. */
TEST(asked_to_end) {
  static const char *const signals[] = {"INT", "TERM", "HUP"};
  for (int i = 0; i < 3; i++) {
    run_fails(
        printed("\"$abbe\" trace " SCENE
                " -q --size 8x8 --photons 64 --map 4 --spp 1000000 --checkpoint-every 0 -o t.exr & "
                "p=$!; while [ ! -e t.exr.checkpoint ]; do sleep 0.02; done; kill -%s $p; wait $p",
                signals[i]),
        1, "with --resume goes on");
    run_must("rm t.exr t.exr.checkpoint");
  }
}

/* `all`: at all of the calls that are counted out above, not at every third; another argument picks
 * one of the tests. */
