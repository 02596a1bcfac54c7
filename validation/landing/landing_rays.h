/* landing_rays.h: rays on which light leaves a scene's refractors and mirrors, with the places
 * where they truly meet receivers, and what the light sees of the receivers, looked up as
 * estimators do it.
 *
 * One light, one wavelength. Light goes through two interfaces of the triangles, or off one mirror;
 * what is totally reflected inside, or meets the object again, is left out: how it goes on is not
 * what estimators are judged by. In double precision. Internal to validation/landing/.
 */
#ifndef ABBE_VALIDATION_LANDING_LANDING_RAYS_H
#define ABBE_VALIDATION_LANDING_LANDING_RAYS_H

#include "base/error.h"
#include "scenes/mesh/bvh.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_landing_ray {
  double origin[3], direction[3]; /* unit */
  double distance;                /* to where it meets a receiver, m */
  double at[3], normal[3];        /* there, m; unit, of the face */
  bool reflected;                 /* off a mirror */
} abbe_landing_ray;

typedef struct abbe_landing_rays {
  abbe_view view; /* view of the light, around all objects; as square as the texture of places */
  size_t side;
  double (*place)[3]; /* [side * side], rows upwards: what is seen at a texel's middle */
  bool *seen;         /* [side * side] whether anything is */
  abbe_bvh receivers;
  double (*triangle)[9]; /* triangles of the receivers */
  size_t count;
  abbe_landing_ray *ray; /* [count] those that land where the light sees the place */
  size_t hidden;         /* that land where it does not, for nobody to find */
} abbe_landing_rays;

/* Makes rays of light `light` of the scene, at lambda_nm: a texture of side x side places (1 to
 * 4096), a ray for each of grid x grid cells (1 to 4096) of what the light sees of refractors and
 * mirrors. ABBE_UNSUPPORTED for a light with a size, and without refractors and mirrors or
 * receivers; ABBE_INVALID_ARGUMENT, ABBE_OUT_OF_RANGE of a material, ABBE_NO_MEMORY. */
abbe_result abbe_landing_rays_make(const abbe_scene *scene, size_t light, double lambda_nm,
                                   size_t side, size_t grid, abbe_landing_rays *out,
                                   abbe_error *error);
void abbe_landing_rays_free(abbe_landing_rays *rays);

/* abbe_estimator_lookup by the texture, and by the triangles themselves; user: the rays. */
bool abbe_landing_rays_look(void *user, const double at[3], double seen[3]);
bool abbe_landing_rays_look_exactly(void *user, const double at[3], double seen[3]);

/* How far apart the light sees the two places, in texels; infinite where it does not see `at`. */
double abbe_landing_rays_texels(const abbe_landing_rays *rays, const double at[3],
                                const double truth[3]);

#endif
