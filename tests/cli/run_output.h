/* run_output.h: runs the program where the test stands, with both streams in one text. */
#ifndef ABBE_TESTS_CLI_RUN_OUTPUT_H
#define ABBE_TESTS_CLI_RUN_OUTPUT_H

#include "tests/check.h"

#include <sys/wait.h>

static char output[1 << 22];

/* `abbe ARGUMENTS`; its exit code. */
static int run(const char *arguments) {
  char command[2048];
  const int n = snprintf(command, sizeof command, "exec 2>&1; '%s' %s", ABBE_PROGRAM, arguments);
  assert_true(n > 0 && (size_t)n < sizeof command);
  FILE *pipe = popen(command, "r");
  assert_non_null(pipe);
  output[fread(output, 1, sizeof output - 1, pipe)] = '\0';
  const int status = pclose(pipe);
  assert_true(WIFEXITED(status));
  return WEXITSTATUS(status);
}

#endif
