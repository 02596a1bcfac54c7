/* route.h: one ray followed through a scene by fixed choices, for known answers.
 *
 * At each interface the ray is transmitted or reflected as the list of choices says, so its
 * geometry is that of the tracer and nothing is random. Lengths in metres, world coordinates.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_ROUTE_H
#define ABBE_VALIDATION_TRACE_WALKS_ROUTE_H

#include "base/error.h"
#include "validation/trace/transport/geometry.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum abbe_route_event {
  ABBE_ROUTE_TRANSMITTED,
  ABBE_ROUTE_REFLECTED, /* chosen, or totally */
  ABBE_ROUTE_LANDED,    /* on a receiver: the end */
  ABBE_ROUTE_ESCAPED    /* met nothing: the end; position is where it started from */
} abbe_route_event;

typedef struct abbe_route_vertex {
  abbe_route_event event;
  size_t object; /* index in the scene; (size_t)-1: escaped */
  double position[3];
  double normal[3];    /* unit, outwards */
  double direction[3]; /* unit, after the event */
  double distance;     /* from the vertex before, m; infinite: escaped */
  double cos_in;       /* cosine of the angle of incidence, 0 to 1 */
  double reflectance;  /* unpolarised, of a film where there is one; 0 where nothing refracts */
  double inside_n;     /* index along the way to this vertex; in a crystal the ordinary one */
  double share;        /* share of the light that takes this path; 1 at the end */
  bool extraordinary;  /* it goes on as a crystal's extraordinary or slower wave */
} abbe_route_vertex;

/* Follows the ray from `from` along direction (unit) at lambda_nm, starting outside of all
 * refractors. choices: 't' or 'r' for each interface in turn; past its end 't'. An interface that
 * reflects totally is not a choice: it reflects, and uses none. At a crystal's face 'T' and 'R' are
 * its extraordinary wave, 't' and 'r' the ordinary one; each face uses a letter, and where there is
 * no such wave the strongest goes on. Writes at most room vertices and
 * their number to *count; the last one is LANDED or ESCAPED unless room ended first.
 * ABBE_INVALID_ARGUMENT for other letters, and what abbe_material_n says. */
abbe_result abbe_route_follow(const abbe_geometry *geometry, const double from[3],
                              const double direction[3], double lambda_nm, const char *choices,
                              abbe_route_vertex *vertex, size_t room, size_t *count,
                              abbe_error *error);

#endif
