/* pages.h: the files that are made from the option tables of all commands. Internal to cli/. */
#ifndef ABBE_CLI_PAGES_PAGES_H
#define ABBE_CLI_PAGES_PAGES_H

#include "base/error.h"
#include "cli/base/arguments.h"

#include <stddef.h>
#include <stdio.h>

/* What the program's main file knows of a command. */
typedef struct abbe_pages_command {
  const char *name, *summary;
  int (*run)(int argc, char **argv);
} abbe_pages_command;

/* Writes abbe.1, abbe-render.1, …, abbe.bash and _abbe into a folder that is there. ABBE_IO,
 * ABBE_NO_MEMORY. */
abbe_result abbe_pages_write(const char *folder, const char *version,
                             const abbe_pages_command *command, size_t count, abbe_error *error);

/* What bash and zsh complete a command line with, from the commands' option tables. */

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
