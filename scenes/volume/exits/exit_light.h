/* exit_light.h: the vector irradiance around an object in a light as it stands, summed up over the
 * rays that leave the object (light_exits.h): values as a vector volume has them, of one block.
 *
 * Nothing is traced: it needs only where the light and the object are. */
#ifndef ABBE_SCENES_VOLUME_EXITS_EXIT_LIGHT_H
#define ABBE_SCENES_VOLUME_EXITS_EXIT_LIGHT_H

#include "colorimetry/observer.h"
#include "scenes/volume/caustic_volume.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/volume_body.h"

/* Parallelograms as rays that leave an object meet them: where each of the parts
 * that a ray is spread into by the object's index comes to the first of them.
 *
 * It knows places and directions; what light rays carry it does not. */

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

typedef struct abbe_exit_light_desc {
  const abbe_light *light;        /* in the world, of any kind; with a size it is its centre */
  const abbe_object *object;      /* whose planes the rays leave, where it is convex */
  const abbe_volume_place *place; /* where it stands */
  const double (*sheet)[9]; /* [sheets] parallelograms of the world, corner, U, V, that may hide
                               the light from the object; nothing else does */
  size_t sheets;
  abbe_observer observer;
  double min_nm, max_nm; /* the light's power is that over this range */
} abbe_exit_light_desc;

/* value[cells][9]: F of X, Y and Z of the light with a power of 1 and a white of Y = 1, in the
 * object's own coordinates (ABBE_VOLUME_VECTOR). ABBE_INVALID_ARGUMENT for a volume without exits,
 * ABBE_NO_MEMORY. */
abbe_result abbe_exit_light_fill(const abbe_caustic_volume *volume,
                                 const abbe_exit_light_desc *desc, float *value, abbe_error *error);

/* A ray, the flux that it carries of light with a power of 1, W, and its bin of wavelengths. */
typedef void (*abbe_exit_light_take)(void *user, const abbe_exit_ray *ray, double flux, size_t bin);
/* The same rays one by one. ABBE_INVALID_ARGUMENT, ABBE_NO_MEMORY. */
abbe_result abbe_exit_light_rays(const abbe_caustic_volume *volume,
                                 const abbe_exit_light_desc *desc, abbe_exit_light_take take,
                                 void *user, abbe_error *error);
/* Those of the part-th of so many parts of the points, each spread over the whole object. */
abbe_result abbe_exit_light_part(const abbe_caustic_volume *volume,
                                 const abbe_exit_light_desc *desc, size_t part, size_t parts,
                                 abbe_exit_light_take take, void *user, abbe_error *error);

/* The colours of these rays. Those of a clear object stand for all wavelengths of the light, which
 * go on as parts of it; others have the wavelength of their bin alone. */
typedef struct abbe_exit_colours abbe_exit_colours;
abbe_result abbe_exit_colours_make(const abbe_caustic_volume *volume,
                                   const abbe_exit_light_desc *desc, abbe_exit_colours **out,
                                   abbe_error *error);
void abbe_exit_colours_free(abbe_exit_colours *colours);

/* How far the object's least and greatest index are from that of a bin; 0 for wavelengths alone. */
void abbe_exit_colours_ends(const abbe_exit_colours *colours, size_t bin, double end[2]);

/* A ray as so many parts of like chance, 1 to ABBE_EXIT_MOST_PARTS; returns how many: 1 for a
 * wavelength alone. turn: the ray's number, by which it has other wavelengths of each part. step:
 * of the index, from that of the ray's bin. xyz: [parts] the colours', XYZ and 0 of a watt of the
 * ray, of light whose white has Y = 1; they may be below 0 where a metal's ray has less of its
 * wavelength than the others. room: for one that no other ray has. */
size_t abbe_exit_colours_split(const abbe_exit_colours *colours, const abbe_exit_ray *ray,
                               size_t bin, size_t parts, uint32_t turn,
                               float step[ABBE_EXIT_MOST_PARTS], float room[1][4],
                               const float (**xyz)[4]);

#endif
