/* gem.h: the verbs of `abbe gem`, a file each.
 *
 * A verb is one line of ABBE_GEM_VERBS and one function in cli/gem/gem_NAME.c. The program lists it
 * with its summary in `abbe gem --help`, and hands it its arguments with argv[0] "abbe gem NAME".
 * No verb holds logic that a library could use.
 */
#ifndef ABBE_CLI_GEM_GEM_H
#define ABBE_CLI_GEM_GEM_H

#include "cli/base/rank_job.h"

/* X(name, summary): every verb NAME is `int abbe_gem_NAME(int argc, char **argv)`. */
#define ABBE_GEM_VERBS(X)                                                                          \
  X(info, "what a design holds: facets, proportions, carats, critical angle, tiers")               \
  X(diagram, "a sheet to cut from: crown, pavilion, profiles, indices, as PDF, SVG or PNG")        \
  X(retarget, "the design at the angles of another stone, its meets kept")                         \
  X(report, "judge the cut in a stone: brightness, leakage, fire, by tilt, with errors")           \
  X(optimise, "the crown and pavilion angles that do best in a stone, meets kept")                 \
  X(convert, "a design as .asc or .gem, or as a solid: STL, OBJ, glTF")

/* The pairs of one search by several processes (validation/gem/ranked_optimum.h); rank 0 writes and
 * says what came of it. Gives the exit code. */
int abbe_gem_optimise_by_ranks(int argc, char **argv, abbe_rank_job *job);

#define ABBE_GEM_DECLARE(name, summary) int abbe_gem_##name(int argc, char **argv);
ABBE_GEM_VERBS(ABBE_GEM_DECLARE)
#undef ABBE_GEM_DECLARE

#endif
