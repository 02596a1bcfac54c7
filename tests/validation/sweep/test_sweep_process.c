/* Whole processes: the command that is run, its caches of shaders, and what becomes of one that
 * fails. A script stands in for the program. */
#include "tests/validation/tradeoff/sweep_row.h"

#include "library/choice/sweep_setting.h"
#include "validation/sweep/sweep_process.h"

#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/abbe-test-process-XXXXXX";
static char program[96], log_path[96];

static void write_program(const char *text) {
  FILE *file = fopen(program, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
  assert_int_equal(chmod(program, 0700), 0);
  unlink(log_path);
}

static void read_log(char *out, size_t size) {
  FILE *file = fopen(log_path, "r");
  assert_non_null(file);
  out[fread(out, 1, size - 1, file)] = '\0';
  fclose(file);
}

static const abbe_sweep_process_desc asked = {
    .program = program, .scene = "a scene.yaml", .width = 32, .height = 16, .runs = 3};

static abbe_sweep_process *make(const abbe_sweep_process_desc *desc) {
  abbe_sweep_process *process = NULL;
  OK(abbe_sweep_process_make(desc, &process, &error));
  return process;
}

static void begin(void) {
  assert_non_null(mkdtemp(folder));
  snprintf(program, sizeof program, "%s/program", folder);
  snprintf(log_path, sizeof log_path, "%s/log", folder);
}

static void finish(void) {
  unlink(program);
  unlink(log_path);
  assert_int_equal(rmdir(folder), 0);
}

GROUP(begin, finish);

/* Cold finds no cache and fills it, which takes a while; what is warm finds it. */
TEST(cold_and_warm) {
  char text[2000], script[600];
  abbe_sweep_row row = sweep_row("default", 64);
  snprintf(script, sizeof script,
           "#!/bin/sh\n"
           "if [ -e \"$MESA_SHADER_CACHE_DIR/filled\" ]; then echo warm\n"
           "else mkdir -p \"$MESA_SHADER_CACHE_DIR\"; touch \"$MESA_SHADER_CACHE_DIR/filled\"\n"
           "  sleep 0.2; echo cold \"$@\"; fi >>%s\n",
           log_path);
  write_program(script);
  abbe_sweep_process *process = make(&asked);
  OK(abbe_sweep_process_measure(process, true, &row, &error));
  assert_true(row.number[ABBE_SWEEP_COLD_MS] >= 200);
  assert_true(row.number[ABBE_SWEEP_WARM_MS] > 0);
  read_log(text, sizeof text);
  assert_contains(text, "cold render a scene.yaml --quiet -o /");
  char *at = strstr(text, "-o ") + 3, left[400];
  snprintf(left, sizeof left, "%.*s", (int)(strstr(at, "/picture.exr") - at), at);
  assert_contains(text, " --size 32x16 --profile default --wavelengths 7 --photons 64 --map 512 "
                        "--samples 1 --fill bridge --model auto --exits 8 --share 0.01\n"
                        "warm\nwarm\nwarm\n");
  /* Without the cold run another cache is filled, once. */
  abbe_sweep_row second = sweep_row("default", 64);
  unlink(log_path);
  for (int i = 0; i < 2; i++) OK(abbe_sweep_process_measure(process, false, &second, &error));
  assert_true(isnan(second.number[ABBE_SWEEP_COLD_MS]));
  assert_true(second.number[ABBE_SWEEP_WARM_MS] > 0);
  read_log(text, sizeof text);
  assert_contains(text, "share 0.01\nwarm\nwarm\nwarm\nwarm\nwarm\nwarm\nwarm\n");
  /* Nothing is left of it. */
  abbe_sweep_process_free(process);
  assert_int_not_equal(access(left, F_OK), 0);
}

TEST(the_tracers_command) {
  char text[2000], script[200];
  abbe_sweep_row row = {0};
  snprintf(script, sizeof script, "#!/bin/sh\necho \"$@\" >>%s\n", log_path);
  write_program(script);
  abbe_sweep_setting_of_trace(256, 4, true, &row.setting);
  abbe_sweep_process *process = make(&asked);
  OK(abbe_sweep_process_measure(process, false, &row, &error));
  abbe_sweep_process_free(process);
  read_log(text, sizeof text);
  assert_contains(text, "trace a scene.yaml --quiet -o /");
  assert_contains(text, " --size 32x16 --spp 4 --photons 65536 --seed ");
  assert_contains(text, " --filter\n");
}

TEST(what_fails_is_said) {
  abbe_sweep_row row = sweep_row("default", 64);
  abbe_sweep_process *process = make(&asked), *none;
  write_program("#!/bin/sh\nexit 1\n");
  REFUSED(ABBE_IO, "did not end well", abbe_sweep_process_measure(process, true, &row, &error));
  assert_contains(last_error.text, "render a scene.yaml --quiet");
  assert_true(isnan(row.number[ABBE_SWEEP_WARM_MS]));
  write_program("#!/bin/sh\nkill -INT $$\n");
  REFUSED(ABBE_CANCELLED, "", abbe_sweep_process_measure(process, true, &row, &error));
  assert_int_equal(unlink(program), 0);
  REFUSED(ABBE_IO, "could not be run", abbe_sweep_process_measure(process, true, &row, &error));
  abbe_sweep_process_free(process);
  assert_int_equal(setenv("TMPDIR", "/there/is/none", 1), 0);
  REFUSED(ABBE_IO, "/there/is/none", abbe_sweep_process_make(&asked, &none, &error));
  assert_int_equal(unsetenv("TMPDIR"), 0);
}
