/* rank_files.h: what ranks (tracer/ranked_run.h) keep beside one file until it is whole: FILE.0,
 * FILE.1 and so on, a rank's own each. It reads and writes none of them.
 */
#ifndef ABBE_VALIDATION_RANKS_RANK_FILES_H
#define ABBE_VALIDATION_RANKS_RANK_FILES_H

#include "base/error.h"

#include <stddef.h>

/* A rank's file, malloc'd. ABBE_NO_MEMORY. */
abbe_result abbe_rank_files_name(const char *path, size_t rank, char **out, abbe_error *error);

/* The ranks of which a file is there, whatever number of ranks there was, ascending, malloc'd; NULL
 * where there is none. ABBE_IO for a folder that cannot be read, ABBE_NO_MEMORY. */
abbe_result abbe_rank_files_find(const char *path, size_t **out_rank, size_t *out_count,
                                 abbe_error *error);

/* Removes them all, as far as that can be. */
void abbe_rank_files_remove(const char *path);

#endif
