/* exit_sheets.h: parallelograms as rays that leave an object meet them: where each of the parts
 * that a ray is spread into by the object's index comes to the first of them.
 *
 * It knows places and directions; what light rays carry it does not.
 * Internal to scenes/volume/exits/.
 */
#ifndef ABBE_SCENES_VOLUME_EXITS_EXIT_SHEETS_H
#define ABBE_SCENES_VOLUME_EXITS_EXIT_SHEETS_H

#include "scenes/volume/light_exits.h"
#include "scenes/volume/volume_body.h"

typedef struct abbe_exit_sheet {
  double corner[3], normal[3]; /* in the object's own coordinates; unit, along U x V */
  double du[3], dv[3];         /* u and v of a place are its products with these from the corner */
  double area;
} abbe_exit_sheet;

#define ABBE_EXIT_MOST_PARTS 16

/* parallelogram: corner, U, V, in the world. */
void abbe_exit_sheet_make(const double parallelogram[9], const abbe_volume_place *place,
                          abbe_exit_sheet *out);

/* A ray on the plane of a sheet, for all of its parts: values, and how they change with the index.
 */
typedef struct abbe_exit_track {
  float height[2], fall[2];                 /* above the plane, and how fast it changes */
  float u[2], v[2], u_along[2], v_along[2]; /* where it starts, and its direction */
} abbe_exit_track;
/* track: [sheets] */
void abbe_exit_sheets_track(const abbe_exit_sheet *sheet, size_t sheets, const abbe_exit_ray *ray,
                            abbe_exit_track *track);

/* Hits of a ray's parts: page[i] is twice the sheet's number, and 1 more where it is met from
 * behind, along its normal; -1: none is met. */
typedef struct abbe_exit_landing {
  float far[ABBE_EXIT_MOST_PARTS];
  float u[ABBE_EXIT_MOST_PARTS], v[ABBE_EXIT_MOST_PARTS]; /* 0 to 1 */
  int page[ABBE_EXIT_MOST_PARTS];
} abbe_exit_landing;
/* The first `parts` of them, whose index is so many steps off; of the others step is read only. */
void abbe_exit_sheets_meet(const abbe_exit_track *track, size_t sheets,
                           const float step[ABBE_EXIT_MOST_PARTS], size_t parts,
                           abbe_exit_landing *out);

/* Whether a sheet hides a place along a unit direction, up to a distance. */
bool abbe_exit_sheets_hide(const abbe_exit_sheet *sheet, size_t sheets, const double place[3],
                           const double way[3], double limit);

#endif
