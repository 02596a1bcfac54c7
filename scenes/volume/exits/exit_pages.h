/* exit_pages.h: what the rays that leave an object (exit_light.h) bring to parallelograms, as maps
 * on them: for each of their sides one of the whole and a finer one of where most of it lands.
 *
 * A ray ends at the first parallelogram that it meets, and they hide the light from the object. It
 * knows no other receivers.
 */
#ifndef ABBE_SCENES_VOLUME_EXITS_EXIT_PAGES_H
#define ABBE_SCENES_VOLUME_EXITS_EXIT_PAGES_H

#include "colorimetry/observer.h"
#include "scenes/volume/caustic_volume.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/volume_body.h"

#include <stdbool.h>
#include <stddef.h>

/* The vector irradiance around an object in a light as it stands, summed up over the
 * rays that leave the object (light_exits.h): values as a vector volume has them, of one block.
 *
 * Nothing is traced: it needs only where the light and the object are. */

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

#define ABBE_EXIT_PAGES_MOST_SIDE 1024

typedef struct abbe_exit_pages {
  size_t side, count; /* texels; sides of parallelograms: 2 i is where the normal U x V of the i-th
                         points to, 2 i + 1 the other */
  float (*window)[4]; /* [count] the finer map's least u and v, 0 to 1, and 1 over its width in
                         each; widths of 0: nothing lands on that side */
  float (*value)[4]; /* [count][2][side][side] irradiance of X, Y, Z and 0, W/m2 of a light of power
                        1: of the whole without the window, and of the window */
  double flux;       /* flux of Y on all receivers, W */
} abbe_exit_pages;

/* parallelogram[parallelograms]: corner, U, V, in the world; the desc's sheets are not read.
 * ABBE_INVALID_ARGUMENT for a side beyond 1 to ABBE_EXIT_PAGES_MOST_SIDE and as
 * abbe_exit_light_colours, ABBE_NO_MEMORY. */
abbe_result abbe_exit_pages_make(const abbe_caustic_volume *volume,
                                 const abbe_exit_light_desc *desc, const double (*parallelogram)[9],
                                 size_t parallelograms, size_t side, abbe_exit_pages *out,
                                 abbe_error *error);
void abbe_exit_pages_free(abbe_exit_pages *pages);

/* A map of half as many texels a side, each the mean of 2 x 2; side is even, and `to` may not be
 * `from`. */
void abbe_exit_pages_halve(const float (*from)[4], size_t side, float (*to)[4]);

/* A map that light is laid on at places, and what it is of tents of one width in place of places.
 * Of light it knows four channels. */

/* Adds to the four texels around (x, y), texels from the map's corner; what would lie beyond its
 * ends is folded back. */
static inline void abbe_exit_map_add(float (*map)[4], int side, float x, float y,
                                     const float value[4]) {
  const float most = (float)side - 0.5f;
  x = (x < 0.5f ? 0.5f : x > most ? most : x) - 0.5f;
  y = (y < 0.5f ? 0.5f : y > most ? most : y) - 0.5f;
  const int left = (int)x, low = (int)y;
  const float across = x - (float)left, up = y - (float)low;
  float(*to)[4] = map + (size_t)low * (size_t)side + (size_t)left;
  const size_t right = left + 1 < side ? 1 : 0, above = low + 1 < side ? (size_t)side : 0;
  const float share[4] = {(1 - across) * (1 - up), across * (1 - up), (1 - across) * up,
                          across * up};
  for (int k = 0; k < 4; k++) to[0][k] += share[0] * value[k];
  for (int k = 0; k < 4; k++) to[right][k] += share[1] * value[k];
  for (int k = 0; k < 4; k++) to[above][k] += share[2] * value[k];
  for (int k = 0; k < 4; k++) to[above + right][k] += share[3] * value[k];
}

/* What was added as a sum of tents of that half width to either side, in texels; at the ends they
 * are folded back, so that the sum stays. Places are as wide as 1.2 already; of wider tents than a
 * map can hold it makes the widest. side: up to ABBE_EXIT_MAP_MOST_SIDE. */
#define ABBE_EXIT_MAP_MOST_SIDE 1024
void abbe_exit_map_smooth(const float (*from)[4], size_t side, const float wide[2], float (*to)[4]);

#endif
