/* completion.h: what bash and zsh complete a command line with, from the commands' option tables.
 */
#ifndef ABBE_CLI_PAGES_COMPLETION_H
#define ABBE_CLI_PAGES_COMPLETION_H

#include "cli/base/option_tables.h"

#include <stdio.h>

/* A file in parts: names and summaries of all commands come first, count of them; then the verbs of
 * those that have any; then the options of each command and verb; then the end. */
typedef struct abbe_completion_word {
  const char *name, *summary;
} abbe_completion_word;

void abbe_completion_bash_begin(FILE *out, const abbe_completion_word *command, size_t count);
void abbe_completion_bash_verbs(FILE *out, const abbe_option_table *table);
void abbe_completion_bash_options_begin(FILE *out);
void abbe_completion_bash_options(FILE *out, const abbe_option_table *table);
void abbe_completion_bash_end(FILE *out);

void abbe_completion_zsh_begin(FILE *out, const abbe_completion_word *command, size_t count);
void abbe_completion_zsh_verbs(FILE *out, const abbe_option_table *table);
void abbe_completion_zsh_options_begin(FILE *out);
void abbe_completion_zsh_options(FILE *out, const abbe_option_table *table);
void abbe_completion_zsh_end(FILE *out);

#endif
