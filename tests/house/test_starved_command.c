/* The program's commands with allocations failing in turn: a sentence and exit code 1, or the whole
 * result. */
#include "tests/cli/run_program.h"

#define FUZZ "\"$house\"/tests/fuzz/"
#define TABLE FUZZ "parts/table.yaml"

/* Those of the program itself, libyaml, cJSON, libpng and OpenEXR count; see faults/preload.c. */
static const char *const commands[] = {
    "\"$abbe\" materials list --table " TABLE,
    "\"$abbe\" materials show crown --table " TABLE " --json",
    "\"$abbe\" materials check --table " TABLE,
    "\"$abbe\" materials export --table " TABLE " -o e.agf",
    "\"$abbe\" materials import " FUZZ "corpus/csv/plain.csv -o i.yaml",
    "\"$abbe\" weights --json",
    "\"$abbe\" plan " FUZZ "corpus/scene/gem.yaml --json",
    "\"$abbe\" info " FUZZ "corpus/exr/map.exr --json",
    "\"$abbe\" compare " FUZZ "corpus/exr/map.exr " FUZZ "corpus/exr/map.exr",
    "\"$abbe\" trace " FUZZ
    "corpus/scene/gem.yaml -q --size 2x2 --photons 16 --map 2 --spp 1 --threads 1 -o t.exr",
};

static size_t allocations_of(const char *command) {
  size_t files = 0, count = 0;
  run_line(printed("LD_PRELOAD='" ABBE_PRELOAD
                   "' ABBE_FAULT_COUNT=../abbe-starved.$$ %s >out || echo "
                   "failed; cat ../abbe-starved.$$; rm ../abbe-starved.$$",
                   command));
  if (sscanf(run_output, "%zu %zu", &files, &count) != 2)
    fail_msg("%s: %s%s", command, run_output, run_errors);
  run_each(run_remove, NULL);
  return count;
}

static bool holds_at(const char *command, const char *how, size_t n) {
  const char *line = printed("LD_PRELOAD='" ABBE_PRELOAD "' ABBE_FAULT=%s:%zu %s", how, n, command);
  const int code = run_line(line);
  bool right = code == 0 || (code == 1 && strstr(run_errors, "abbe") != NULL);
  if (!right) print_error("%s ends with %d: %s\n", line, code, run_errors);
  run_each(run_remove, NULL);
  return right;
}

GROUP(run_setup, run_teardown);

TEST(commands) {
  size_t wrong = 0;
  /* every allocation, where somebody waits for it; in the tests some of them, ever further apart */
  const bool all = getenv("ABBE_FAULTS_ALL") != NULL;
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
    const size_t count = allocations_of(commands[i]);
    assert_true(count > 5);
    for (size_t n = 1; n <= count; n += all ? 1 : 1 + n) {
      wrong += !holds_at(commands[i], "memory", n);
      if (n % 2 == 1) wrong += !holds_at(commands[i], "starve", n);
    }
  }
  assert_int_equal(wrong, 0);
}
