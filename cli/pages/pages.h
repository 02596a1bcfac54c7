/* pages.h: the files that are made from the option tables of all commands. */
#ifndef ABBE_CLI_PAGES_PAGES_H
#define ABBE_CLI_PAGES_PAGES_H

#include "base/error.h"

#include <stddef.h>

/* What the program's main file knows of a command. */
typedef struct abbe_pages_command {
  const char *name, *summary;
  int (*run)(int argc, char **argv);
} abbe_pages_command;

/* Writes abbe.1, abbe-render.1, …, abbe-mpi.1, abbe.bash and _abbe into a folder that is there. ABBE_IO,
 * ABBE_NO_MEMORY. */
abbe_result abbe_pages_write(const char *folder, const char *version,
                             const abbe_pages_command *command, size_t count, abbe_error *error);

#endif
