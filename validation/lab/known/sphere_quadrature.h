/* sphere_quadrature.h: the light that a sphere throws onto a plane below it, by quadrature.
 *
 * Sphere, light and plane share one axis, so that a ray is one number, its angle at the surface,
 * and what falls inside a circle is a sum of one-dimensional integrals: no random numbers, no
 * rays cast, no meshes. Light comes down the axis, as a beam or from a point; the plane lies
 * across the axis below the sphere and is black. Unpolarised Fresnel shares at every crossing,
 * Beer-Lambert inside. The irradiance diverges where the rays fold over (and at a focus), so the
 * answers are flux inside a circle and mean irradiance of a ring, which do not.
 *
 * It knows nothing of scenes, the tracer or the renderer: it is what they are held against.
 * Internal to validation/lab/known/.
 */
#ifndef ABBE_VALIDATION_LAB_KNOWN_SPHERE_QUADRATURE_H
#define ABBE_VALIDATION_LAB_KNOWN_SPHERE_QUADRATURE_H

#include "base/error.h"
#include "colorimetry/illuminant.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_SPHERE_MAX_ORDERS 64

/* All zero but radius, index, plane_distance and power: a beam straight through. */
typedef struct abbe_sphere_setup {
  double radius;             /* m, > 0 */
  double index;              /* index of the sphere relative to what surrounds it, 0.1 to 10 */
  double light_distance;     /* m from the centre up to the point light, > radius; 0: a beam */
  double plane_distance;     /* m from the centre down to the plane, > radius */
  double power;              /* power of the beam, W/m2 across it; of the point, W/sr; >= 0 */
  double attenuation_per_m;  /* inside the sphere, natural, 1/m, >= 0 */
  size_t inner_orders;       /* light after 1, 2, ... this many reflections inside counts as well */
  bool without_direct_order; /* leave out what passes without a reflection inside */
  bool outside;              /* light that the sphere reflects on its outside counts as well */
  bool past;                 /* so does what reaches the plane past the sphere */
} abbe_sphere_setup;

typedef struct abbe_sphere_quadrature abbe_sphere_quadrature;

/* Finds the monotone pieces of every order's map from the sphere to the plane.
 * ABBE_INVALID_ARGUMENT names the member that is outside the range above. */
abbe_result abbe_sphere_quadrature_make(const abbe_sphere_setup *setup,
                                        abbe_sphere_quadrature **out, abbe_error *error);
void abbe_sphere_quadrature_free(abbe_sphere_quadrature *quadrature);

/* Flux in W on the plane within radius_m of the axis; infinity: on the whole plane
 * (infinite itself where `past` counts a beam). Relative error below 1e-9 of what falls on the
 * sphere. Not thread-safe for one quadrature. */
abbe_result abbe_sphere_quadrature_enclosed(const abbe_sphere_quadrature *quadrature,
                                            double radius_m, double *flux_w, abbe_error *error);

/* Radii in m, in no order, at which the light folds over: the caustic's edges, where the irradiance
 * is infinite. Owned by the quadrature. */
size_t abbe_sphere_quadrature_folds(const abbe_sphere_quadrature *quadrature,
                                    const double **radius_m);

/* A white light through a dispersive, absorbing sphere: setup's index and attenuation are the
 * material's (setup->index is not read), the range is cut into `bands` (1 to 4096) of equal width,
 * each with the rays of its middle. Enclosed flux at each of count radii as XYZ, such that the
 * light's whole power over the range has Y = power, as everywhere in Abbe. */
abbe_result abbe_sphere_quadrature_xyz(const abbe_sphere_setup *setup,
                                       const abbe_material *material,
                                       const abbe_illuminant *illuminant, double min_nm,
                                       double max_nm, size_t bands, const double *radius_m,
                                       size_t count, double (*xyz)[3], abbe_error *error);

#endif
