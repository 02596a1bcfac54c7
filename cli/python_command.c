#define _GNU_SOURCE /* readlink, setenv */
#include "cli/base/command.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Where the module is, from the program's folder: installed, and where both were built. */
static const char *const places[] = {"../lib/python3/dist-packages", "../python"};

/* The folder beside the program that holds the module into `out`; false where there is none. */
static bool find_module(const char *program, const char *name, char *out, size_t size) {
  const char *slash = strrchr(program, '/');
  const int length = slash != NULL ? (int)(slash - program) : 0;
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    char file[2 * PATH_MAX];
    snprintf(out, size, "%.*s/%s", length, program, places[i]);
    snprintf(file, sizeof file, "%s/abbe/%s/__main__.py", out, name);
    if (access(file, R_OK) == 0) return true;
  }
  return false;
}

static void add_path(const char *folder) {
  const char *before = getenv("PYTHONPATH");
  char all[4 * PATH_MAX];
  snprintf(all, sizeof all, "%s%s%s", folder, before != NULL ? ":" : "",
           before != NULL ? before : "");
  setenv("PYTHONPATH", all, 1);
}

int abbe_python_command_run(const char *name, int argc, char **argv) {
  char program[PATH_MAX] = "", folder[PATH_MAX + 64], module[64];
  if (readlink("/proc/self/exe", program, sizeof program - 1) < 0) program[0] = '\0';
  if (!find_module(program, name, folder, sizeof folder)) {
    fprintf(stderr,
            "abbe %s: it is a part of the Python module abbe, which is not beside this program; "
            "where the module is, run python3 -m abbe.%s\n",
            name, name);
    return ABBE_EXIT_FAILED;
  }
  add_path(folder);
  setenv("ABBE_PROGRAM", program, 1);
  char **words = calloc((size_t)argc + 4, sizeof *words);
  if (words == NULL) {
    fprintf(stderr, "abbe %s: no memory for the command line\n", name);
    return ABBE_EXIT_FAILED;
  }
  snprintf(module, sizeof module, "abbe.%s", name);
  words[1] = (char[]){"-m"};
  words[2] = module;
  for (int i = 0; i < argc; i++) words[3 + i] = argv[i];
  /* Debian's own before any other, for numpy is Debian's. */
  const char *const pythons[] = {getenv("ABBE_PYTHON"), "/usr/bin/python3", "python3"};
  for (size_t i = 0; i < sizeof pythons / sizeof *pythons; i++) {
    if (pythons[i] == NULL) continue;
    words[0] = (char *)pythons[i];
    execvp(pythons[i], words);
  }
  free(words);
  fprintf(stderr, "abbe %s: it runs in Python, and there is no python3; install it and numpy\n",
          name);
  return ABBE_EXIT_FAILED;
}
