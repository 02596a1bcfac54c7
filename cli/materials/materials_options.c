#include "cli/materials/materials.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>

void abbe_materials_parse(const struct argp *parser, int argc, char **argv, void *request) {
  abbe_arguments_parse(parser, 0, argc, argv, request);
}

_Noreturn void abbe_materials_wrong_use(const char *program, const char *sentence) {
  fprintf(stderr, "%s: %s\nTry '%s --help'.\n", program, sentence, program);
  exit(ABBE_EXIT_USAGE);
}
