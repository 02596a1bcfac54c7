#include "cli/base/command.h"
#include "cli/base/progress.h"

#include "base/text.h"
#include "colorimetry/image/display_ocio.h"

#include <argp.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef ABBE_VERSION
#error "the build defines ABBE_VERSION"
#endif

const char *argp_program_version = "abbe " ABBE_VERSION;

static const abbe_verb commands[] = {
#define ABBE_COMMAND_ROW(name, summary) {#name, summary, abbe_command_##name},
    ABBE_COMMANDS(ABBE_COMMAND_ROW)
#undef ABBE_COMMAND_ROW
};

enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

#define ABBE_NAME_OF(name, summary) #name,
static const char *const python_commands[] = {ABBE_PYTHON_COMMANDS(ABBE_NAME_OF)};
enum { PYTHON_COUNT = sizeof python_commands / sizeof python_commands[0] };

static void help(FILE *out) {
#define ROW(name, summary) fprintf(out, "  %-12s %s\n", #name, summary);
  fprintf(out,
          "abbe %s: spectral dispersion caustics\n\n"
          "usage: abbe COMMAND [OPTION…] [FILE…]\n\n"
          "First steps:\n" ABBE_FIRST_STEPS "\nStones and scenes:\n",
          ABBE_VERSION);
  ABBE_SCENE_COMMANDS(ROW)
  fprintf(out, "\nPictures:\n");
  ABBE_PICTURE_COMMANDS(ROW)
  fprintf(out, "\nMaterials, colours and measurements:\n");
  ABBE_DATA_COMMANDS(ROW)
#define SENTENCE(name, summary) fprintf(out, "'abbe %s' %s.\n", #name, summary);
  fprintf(out, "\nIn Python, with numpy and for plots matplotlib:\n");
  ABBE_PYTHON_COMMANDS(SENTENCE)
#undef SENTENCE
  fprintf(out, "\n'abbe help COMMAND' or 'abbe COMMAND --help' shows a command's options.\n"
               "Exit codes: 0 done, 1 failed, 2 used wrongly, 3 out of tolerance.\n");
#undef ROW
}

/* What a page of help or a version says goes to stdout too, past all commands. */
static void check_output(void) {
  if (abbe_command_output_failed()) _exit(ABBE_EXIT_FAILED);
}

/* A file that is opened later must not become the output of a program that was given none. */
static void hold_streams(void) {
  static const int flags[] = {O_RDONLY, O_RDONLY, O_WRONLY}; /* writing to stdout fails */
  for (int fd = 0; fd < 3; fd++)
    if (fcntl(fd, F_GETFD) < 0) (void)!open("/dev/null", flags[fd]);
}

static void say(const char *message) {
  fputs(message, stderr);
}

int main(int argc, char **argv) {
  hold_streams();
  abbe_output_begin();
  abbe_display_set_log(say);
  atexit(check_output);
  argp_err_exit_status = ABBE_EXIT_USAGE;
  /* A closed pipe or a file-size limit is a write error, not a sudden end. */
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);

  if (argc < 2) {
    help(stderr);
    return ABBE_EXIT_USAGE;
  }
  const char *word = argv[1];
  if (strcmp(word, "--version") == 0) return printf("%s\n", argp_program_version) < 0;
  bool wants_help = strcmp(word, "help") == 0 || strcmp(word, "--help") == 0 ||
                    strcmp(word, "-h") == 0 || strcmp(word, "-?") == 0;
  if (wants_help && argc == 2) {
    help(stdout);
    return ABBE_EXIT_DONE;
  }
  if (wants_help) word = argv[2];

  const char *names[COMMAND_COUNT + PYTHON_COUNT];
  for (int i = 0; i < PYTHON_COUNT; i++) {
    names[COMMAND_COUNT + i] = python_commands[i];
    if (strcmp(word, python_commands[i]) != 0) continue;
    char *help_argv[] = {(char[]){"--help"}};
    return wants_help ? abbe_python_command_run(word, 1, help_argv)
                      : abbe_python_command_run(word, argc - 2, argv + 2);
  }
  for (int i = 0; i < COMMAND_COUNT; i++) {
    names[i] = commands[i].name;
    if (strcmp(word, names[i]) != 0) continue;
    char program[64];
    snprintf(program, sizeof program, "abbe %s", names[i]);
    /* a command with verbs answers for one of them too: abbe help materials show */
    char *help_argv[] = {program, (char[]){"--help"}, argc > 3 ? argv[3] : NULL, NULL};
    if (wants_help) return commands[i].run(argc > 3 ? 3 : 2, help_argv);
    argv[1] = program;
    return commands[i].run(argc - 1, argv + 1);
  }
  const char *near = abbe_nearest_word(word, names, COMMAND_COUNT + PYTHON_COUNT);
  fprintf(stderr, "abbe: there is no command '%s'", word);
  if (near != NULL) fprintf(stderr, "; did you mean '%s'?", near);
  fprintf(stderr, "\nTry 'abbe help'.\n");
  return ABBE_EXIT_USAGE;
}
