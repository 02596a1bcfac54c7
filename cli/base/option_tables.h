/* option_tables.h: the options of every command and verb, for what is made of them: manual pages
 * and the shells' completion.
 *
 * A command hands its table to argp when it is run. It is run here with nobody's arguments, as far
 * as that and no further.
 */
#ifndef ABBE_CLI_BASE_OPTION_TABLES_H
#define ABBE_CLI_BASE_OPTION_TABLES_H

#include <argp.h>
#include <stddef.h>

struct abbe_verbs;

/* Of one command or verb: the table and the flags of its arguments (arguments.h); or, of a command
 * with verbs, those, which follow one by one. */
typedef struct abbe_option_table {
  const char *program, *summary; /* "abbe gem report" */
  const struct argp *argp;
  unsigned flags;
  const struct abbe_verbs *verbs;
} abbe_option_table;

/* What it points to holds until the call returns. */
typedef void (*abbe_option_table_take)(void *user, const abbe_option_table *table);

/* Calls `take` with the table of a command and those of its verbs. */
void abbe_option_tables_visit(const char *program, const char *summary,
                              int (*run)(int argc, char **argv), abbe_option_table_take take,
                              void *user);

/* For abbe_arguments_parse and abbe_verbs_run: does not return where somebody visits. */
void abbe_option_tables_offer(const struct argp *argp, unsigned flags);
void abbe_option_tables_offer_verbs(const struct abbe_verbs *verbs);

#endif
