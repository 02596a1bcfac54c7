/* ranked_optimum.h: one search for a gem's angles (gem/gem_optimum.h) by several processes, "ranks"
 * (tracer/ranked_run.h): each judges pairs of its own and keeps them in a file of its own, so that
 * a rank that is killed costs no more than it had not written.
 */
#ifndef ABBE_VALIDATION_LAB_RANKED_OPTIMUM_H
#define ABBE_VALIDATION_LAB_RANKED_OPTIMUM_H

#include "base/error.h"
#include "validation/measure/gem/gem_optimum.h"
#include "validation/trace/tracer/ranked_run.h"

#include <stddef.h>

typedef struct abbe_ranked_optimum_desc {
  const abbe_cut *cut;
  const abbe_cut_polyhedron *polyhedron;
  const abbe_material *material;
  const abbe_wavelengths *wavelengths;
  const abbe_weights *weights;
  const abbe_gem_optimum_desc *search; /* without parts; progress is of this rank's pairs */
  const char *path;                    /* beside which ranks keep their files */
  double keep_s;                       /* seconds between two writings of them */
} abbe_ranked_optimum_desc;

/* Every rank calls it alike. Pairs of files that are there already are not judged again, whatever
 * number of ranks there was. out: all pairs, to the bit those of abbe_gem_optimum_find, at rank 0;
 * zeroed at the others. The files stay until the caller removes them. ABBE_CANCELLED, at all ranks
 * but those that failed, where one was stopped or failed; errors of abbe_gem_optimum_find,
 * abbe_gem_grid_file_read and abbe_gem_grid_file_write. */
abbe_result abbe_ranked_optimum_find(const abbe_ranks *ranks, const abbe_ranked_optimum_desc *desc,
                                     abbe_gem_optimum *out, abbe_error *error);

/* What ranks (tracer/ranked_run.h) keep beside one file until it is whole: FILE.0, FILE.1 and so
 * on, a rank's own each. It reads and writes none of them. */

/* A rank's file, malloc'd. ABBE_NO_MEMORY. */
abbe_result abbe_rank_files_name(const char *path, size_t rank, char **out, abbe_error *error);

/* The ranks of which a file is there, whatever number of ranks there was, ascending, malloc'd; NULL
 * where there is none. ABBE_IO for a folder that cannot be read, ABBE_NO_MEMORY. */
abbe_result abbe_rank_files_find(const char *path, size_t **out_rank, size_t *out_count,
                                 abbe_error *error);

/* Removes them all, as far as that can be. */
void abbe_rank_files_remove(const char *path);

#endif
