/* line.h: how what is seen along a line changes with numbers of the scene, between its jumps and by
 * them.
 *
 * A line runs across a light's window, or across the camera's film. What is seen at a place is a
 * tree of paths. Where nothing jumps, its paths are followed once more over the same surfaces in
 * scenes in which a key is moved. A jump lies where two surfaces change places on a path: there
 * a function of the place is 0, such as the difference of the two ways to both faces, and how fast
 * the jump moves is the quotient of its slopes by the key and by the place. Internal to
 * validation/measure/derive/.
 */
#ifndef ABBE_VALIDATION_MEASURE_DERIVE_LINE_H
#define ABBE_VALIDATION_MEASURE_DERIVE_LINE_H

#include "validation/measure/derive/specular.h"

#include <stdbool.h>
#include <stddef.h>

/* What lines add to. */
typedef struct abbe_line_sums {
  bool *felt;           /* [keys] */
  double light, left;   /* of what is seen, and what paths that are too long had */
  double jumps, lost;   /* of what jumps, and of jumps whose motion was not found */
  double shown, places; /* of the film: what is seen; at so many points */
  double looks, bright; /* between points; of the light: what jumps with more is always followed */
} abbe_line_sums;

enum { ABBE_LINE_DEPTH = 40, ABBE_LINE_TREES = 5 + 2 * ABBE_LINE_DEPTH };

typedef struct abbe_line abbe_line;
struct abbe_line {
  size_t keys, points;
  const abbe_specular *base;
  const abbe_specular *const *moved; /* [2 keys] each key's, down and up */
  const double *step;                /* [keys] */
  abbe_line_sums *to;
  double at[2]; /* the place: at[axis] runs from 0 to 1 */
  int axis;
  double weight;
  bool film;                /* the camera's: of a tree counts what it shows, else its hits */
  abbe_specular_tree *tree; /* [ABBE_LINE_TREES] to work on */
  /* In the base's scene, 0, or in moved ones from 1 on: NULL for known, or a whole tree. */
  void (*look)(const abbe_line *line, size_t scene, const double at[2],
               const abbe_specular_tree *known, abbe_specular_tree *out);
  /* Adds a tree's light to the base's sums (row 0) or to a key's. */
  void (*deposit)(const abbe_line *line, size_t row, const abbe_specular_tree *tree, double factor);
  /* How much of a tree the other has no like of. */
  double (*only_in)(const abbe_line *line, const abbe_specular_tree *tree,
                    const abbe_specular_tree *other);
};

/* first: where between two of its points the first one is, 0 to 1. */
void abbe_line_run(const abbe_line *line, double first);

/* Where the two surfaces change places. */
typedef struct abbe_edge {
  enum {
    ABBE_EDGE_NONE,
    ABBE_EDGE_CROSSING, /* as far away are both faces */
    ABBE_EDGE_OUTLINE,  /* of a sphere */
    ABBE_EDGE_SIDE,     /* of a triangle */
    ABBE_EDGE_LAMP,
    ABBE_EDGE_FAINT /* paths end that are too faint: no light jumps but behind them */
  } kind;
  bool shadow;  /* of a ray to what may be hidden, not of a path's step */
  size_t index; /* of the step or the shadow */
  uint32_t object[2], face[2];
  int side;    /* of a triangle or a light */
  double flux; /* on all paths that differ; infinite where that is not known */
} abbe_edge;

/* Of the brightest path that differs, by steps of `below`. kind ABBE_EDGE_NONE: it is not known
 * what jumps. */
abbe_edge abbe_edge_between(const abbe_specular *s, const abbe_specular_tree *below,
                            const abbe_specular_tree *above);
/* The function that is 0 there, of a tree that has met what `below` met in that scene; NAN where it
 * has none. */
double abbe_edge_value(const abbe_specular *s, const abbe_edge *e, const abbe_specular_tree *tree);

#endif
