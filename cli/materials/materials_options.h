/* materials_options.h: the options that several verbs of `abbe materials` have, and wrong use. */
#ifndef ABBE_CLI_MATERIALS_MATERIALS_OPTIONS_H
#define ABBE_CLI_MATERIALS_MATERIALS_OPTIONS_H

#include "cli/base/arguments.h"
#include "cli/base/command.h"

/* Rows of an argp_option list that several verbs have, and their keys; a verb's own keys begin at
 * ABBE_MATERIALS_KEY_OWN. */
enum { ABBE_MATERIALS_KEY_TABLE = 256, ABBE_MATERIALS_KEY_JSON, ABBE_MATERIALS_KEY_OWN };
#define ABBE_MATERIALS_TABLE_OPTION                                                                \
  {                                                                                                \
    "table", ABBE_MATERIALS_KEY_TABLE, "FILE", ABBE_ARGUMENT_READS,                                \
        "a table file, or default or thesis; without it, default", 0                               \
  }
#define ABBE_MATERIALS_JSON_OPTION                                                                 \
  { "json", ABBE_MATERIALS_KEY_JSON, NULL, 0, "as JSON, numbers in full", 0 }

struct argp;
/* abbe_arguments_parse for verbs whose arguments are no files. */
void abbe_materials_parse(const struct argp *parser, int argc, char **argv, void *request);
/* Prints "PROGRAM: sentence" and where help is, and ends the program with ABBE_EXIT_USAGE. */
_Noreturn void abbe_materials_wrong_use(const char *program, const char *sentence);

#endif
