/* materials_change.h: what the verbs that change a table share: open, say, write. */
#ifndef ABBE_CLI_MATERIALS_MATERIALS_CHANGE_H
#define ABBE_CLI_MATERIALS_MATERIALS_CHANGE_H

#include "cli/materials/materials_options.h"
#include "spectral/editing/table_edit.h"

#include <stdbool.h>

/* The options that all of them have. */
enum { ABBE_CHANGE_KEY_DRY_RUN = ABBE_MATERIALS_KEY_OWN, ABBE_CHANGE_KEY_OWN };
#define ABBE_CHANGE_OPTIONS                                                                        \
  {"table", ABBE_MATERIALS_KEY_TABLE, "FILE", ABBE_ARGUMENT_READS, "the table file to change", 0}, \
  {                                                                                                \
    "dry-run", ABBE_CHANGE_KEY_DRY_RUN, NULL, 0,                                                   \
        "show the change as a unified diff, and write nothing", 0                                  \
  }

typedef struct abbe_change {
  const char *program, *table;
  bool dry_run;
  abbe_table_edit *edit;
} abbe_change;

/* Takes one of the two options; false for any other key. */
bool abbe_change_option(abbe_change *change, int key, const char *arg);
/* ABBE_UNSUPPORTED, with how to come by a copy, for a table that is compiled in. */
abbe_result abbe_change_check_table(const char *table, abbe_error *error);
/* Opens the table; ends the program with ABBE_EXIT_USAGE where --table was not given. */
abbe_result abbe_change_open(abbe_change *change, abbe_error *error);
/* Sets NAME's key as one argument "KEY=VALUE" says; a text key's value is taken as it stands, any
 * other's as YAML. */
abbe_result abbe_change_assign(abbe_table_edit *edit, const char *name, const char *assignment,
                               abbe_error *error);
/* Saves, and prints what (a sentence) and the numbers n_d and V_d of record `name` (or NULL) before
 * and after; or prints the diff. Says it on stderr where the file is still no table for an older
 * reason. Frees the edit. */
int abbe_change_end(abbe_change *change, abbe_result result, const char *what, const char *name,
                    abbe_error *error);

#endif
