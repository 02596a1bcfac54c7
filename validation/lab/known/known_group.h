/* known_group.h: what the groups of known answers share: adding rows, small scenes written as text,
 * rays followed in them. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_LAB_KNOWN_KNOWN_GROUP_H
#define ABBE_VALIDATION_LAB_KNOWN_KNOWN_GROUP_H

#include "base/maths.h"
#include "scenes/scene.h"
#include "validation/lab/known/known_answers.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/walks/route.h"

#define ABBE_KNOWN_DEGREES (180 / ABBE_PI)

typedef struct abbe_known_run {
  const abbe_known_options *options;
  abbe_known_answers *out;
  const char *group;
  double from, to; /* the group's part of the whole work */
} abbe_known_run;

#define ABBE_KNOWN_DECLARE(name, what)                                                             \
  abbe_result abbe_known_##name(abbe_known_run *run, abbe_error *error);
ABBE_KNOWN_GROUPS(ABBE_KNOWN_DECLARE)
#undef ABBE_KNOWN_DECLARE

/* Adds a row: the caller gives quantity, unit, exact, traced, standard error, tolerance, what of it
 * is useful, and reason; error and verdict are computed (a traced value that is not finite fails).
 */
abbe_result abbe_known_add(abbe_known_run *run, abbe_known_answer row, abbe_error *error);

/* Says how much of the group is done, 0 to 1; ABBE_CANCELLED where the caller asked to stop. */
abbe_result abbe_known_progress(const abbe_known_run *run, double done, abbe_error *error);

/* A scene from text, printf-style. Materials are the default table's unless the text says else. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
abbe_result
abbe_known_scene(abbe_scene *out, abbe_error *error, const char *text, ...);

#define ABBE_KNOWN_ROOM 12 /* vertices of a ray */

/* A scene for single rays: its objects, and a camera and a light that play no part. */
typedef struct abbe_known_stage {
  abbe_scene scene;
  abbe_geometry geometry;
  abbe_route_vertex vertex[ABBE_KNOWN_ROOM]; /* [count]: of the ray followed last */
  size_t count;
} abbe_known_stage;

/* objects: entries of a scene file's list, printf-style; a receiver far below is added. Materials
 * are the default table's. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
abbe_result
abbe_known_stage_make(abbe_known_stage *stage, abbe_error *error, const char *objects, ...);
void abbe_known_stage_free(abbe_known_stage *stage);

/* Index of the stage's first object at lambda_nm. */
abbe_result abbe_known_stage_n(const abbe_known_stage *stage, double lambda_nm, double *n,
                               abbe_error *error);

/* Follows a ray; its vertices are in the stage. direction is scaled to length 1. */
abbe_result abbe_known_follow(abbe_known_stage *stage, const double from[3],
                              const double direction[3], double lambda_nm, const char *choices,
                              abbe_error *error);

/* Angle between two directions of any length, radians, exact for small ones. */
double abbe_known_angle(const double a[3], const double b[3]);

/* Where f(x, user) is least in [low, high], f with one minimum there; NaN from f ends the search
 * with NaN. */
typedef double (*abbe_known_function)(double x, void *user);
double abbe_known_least(abbe_known_function f, void *user, double low, double high);

#endif
