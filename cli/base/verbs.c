#include "cli/base/command.h"

#include "base/text.h"
#include "cli/base/arguments.h"

#include <stdio.h>
#include <string.h>

enum { MOST = 64 };

static void help(const abbe_verbs *v, FILE *out, const char *program) {
  fprintf(out, "usage: %s VERB [OPTION…] [NAME…]\n\n", program);
  for (size_t i = 0; i < v->count; i++)
    fprintf(out, "  %-9s %s\n", v->verb[i].name, v->verb[i].summary);
  fprintf(out, "\nExamples:\n");
  for (size_t i = 0; i < v->examples; i++) fprintf(out, "  %s %s\n", program, v->example[i]);
  fprintf(out, "\n'%s VERB --help' shows a verb's options, with examples; %s\n", program, v->page);
}

static bool is_help(const char *word) {
  return strcmp(word, "--help") == 0 || strcmp(word, "-?") == 0 || strcmp(word, "-h") == 0 ||
         strcmp(word, "help") == 0;
}

static int run(const abbe_verb *verb, bool for_help, int argc, char **argv) {
  static char name[64];
  snprintf(name, sizeof name, "%s %s", argv[0], verb->name);
  char *help_argv[] = {name, (char[]){"--help"}, NULL};
  if (for_help) return verb->run(2, help_argv);
  argv[1] = name;
  return verb->run(argc - 1, argv + 1);
}

int abbe_verbs_run(const abbe_verbs *v, int argc, char **argv) {
  const char *program = argv[0], *names[MOST];
  if (argc < 2) {
    fprintf(stderr, "%s: a verb is wanted\n", program);
    help(v, stderr, program);
    return ABBE_EXIT_USAGE;
  }
  if (is_help(argv[1]) && argc == 2) {
    help(v, stdout, program);
    return ABBE_EXIT_DONE;
  }
  const char *word = is_help(argv[1]) ? argv[2] : argv[1];
  const size_t count = v->count < MOST ? v->count : MOST;
  for (size_t i = 0; i < count; i++) {
    names[i] = v->verb[i].name;
    if (strcmp(word, names[i]) == 0) return run(&v->verb[i], word != argv[1], argc, argv);
  }
  const char *near = abbe_nearest_word(word, names, count);
  fprintf(stderr, "%s: there is no verb '%s'", program, word);
  if (near != NULL) fprintf(stderr, "; did you mean '%s'?", near);
  fprintf(stderr, "\nTry '%s --help'.\n", program);
  return ABBE_EXIT_USAGE;
}
