#include "cli/materials/materials.h"

#include "base/nearest.h"
#include "cli/base/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name, *summary;
  int (*run)(int argc, char **argv);
} verbs[] = {
#define ABBE_MATERIALS_ROW(name, summary) {#name, summary, abbe_materials_##name},
    ABBE_MATERIALS_VERBS(ABBE_MATERIALS_ROW)
#undef ABBE_MATERIALS_ROW
};

enum { VERB_COUNT = sizeof verbs / sizeof verbs[0] };

static void help(FILE *out, const char *program) {
  fprintf(out, "usage: %s VERB [OPTION…] [NAME…]\n\n", program);
  for (int i = 0; i < VERB_COUNT; i++) fprintf(out, "  %-8s %s\n", verbs[i].name, verbs[i].summary);
  static const char *const examples[] = {
      "list",
      "show diamond --at 430.8 --at 686.7",
      "nearest --nd 1.728 --vd 28.4",
      "plot --map -o map.png",
      "import maker.agf -o glasses.yaml",
      "check --table glasses.yaml",
      "set sf10 coefficients.1=1.61625977 --table glasses.yaml --dry-run",
      "edit sf10 --table glasses.yaml"};
  fprintf(out, "\nExamples:\n");
  for (size_t i = 0; i < sizeof examples / sizeof examples[0]; i++)
    fprintf(out, "  %s %s\n", program, examples[i]);
  fprintf(out,
          "\n'%s VERB --help' shows a verb's options, with examples; docs/materials.md goes from\n"
          "a catalogue to a picture.\n",
          program);
}

static bool is_help(const char *word) {
  return strcmp(word, "--help") == 0 || strcmp(word, "-?") == 0 || strcmp(word, "-h") == 0 ||
         strcmp(word, "help") == 0;
}

int abbe_command_materials(int argc, char **argv) {
  const char *program = argv[0];
  if (argc < 2) {
    fprintf(stderr, "%s: a verb is wanted\n", program);
    help(stderr, program);
    return ABBE_EXIT_USAGE;
  }
  if (is_help(argv[1]) && argc == 2) {
    help(stdout, program);
    return ABBE_EXIT_DONE;
  }
  const char *word = is_help(argv[1]) ? argv[2] : argv[1], *names[VERB_COUNT];
  for (int i = 0; i < VERB_COUNT; i++) {
    names[i] = verbs[i].name;
    if (strcmp(word, names[i]) != 0) continue;
    static char name[64];
    snprintf(name, sizeof name, "%s %s", program, names[i]);
    char *help_argv[] = {name, (char[]){"--help"}, NULL};
    if (word != argv[1]) return verbs[i].run(2, help_argv);
    argv[1] = name;
    return verbs[i].run(argc - 1, argv + 1);
  }
  const char *near = abbe_nearest_word(word, names, VERB_COUNT);
  fprintf(stderr, "%s: there is no verb '%s'", program, word);
  if (near != NULL) fprintf(stderr, "; did you mean '%s'?", near);
  fprintf(stderr, "\nTry '%s --help'.\n", program);
  return ABBE_EXIT_USAGE;
}
