/* known_light.h: what the groups of known answers share: adding rows, small scenes written as text,
 * rays followed in them. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_LAB_KNOWN_KNOWN_LIGHT_H
#define ABBE_VALIDATION_LAB_KNOWN_KNOWN_LIGHT_H

#include "base/error.h"
#include "base/maths.h"
#include "colorimetry/illuminant.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"
#include "spectral/materials/material.h"
#include "validation/lab/known/known_answers.h"
#include "validation/trace/tracer/tracer.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/walks/route.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

/* Derivatives of pixels, the last part of the group `derive`. */
abbe_result abbe_known_pixels(abbe_known_run *run, abbe_error *error);

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

/* What the groups of known answers share that trace whole runs:
 * scenes as text, a run's receiver map ring by ring and pass by pass, and the tolerance of a mean.
 */

/* The light that a sphere throws onto a plane below it, by quadrature.
 *
 * Sphere, light and plane share one axis, so that a ray is one number, its angle at the surface,
 * and what falls inside a circle is a sum of one-dimensional integrals: no random numbers, no
 * rays cast, no meshes. Light comes down the axis, as a beam or from a point; the plane lies
 * across the axis below the sphere and is black. Unpolarised Fresnel shares at every crossing,
 * Beer-Lambert inside. The irradiance diverges where the rays fold over (and at a focus), so the
 * answers are flux inside a circle and mean irradiance of a ring, which do not.
 *
 * It knows nothing of scenes, the tracer or the renderer: it is what they are held against. */

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
ABBE_HOLDS(abbe_sphere_quadrature)

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

/* The texels of a receiver map as rings around a point, and what a round profile puts
 * into them.
 *
 * A texel belongs to the ring that its middle lies in, so the rings of a map have ragged edges and
 * a circle's flux is not theirs. Both halves of a comparison go over the same texels here: the
 * map's are summed, and the profile's flux is shared out between the rings wherever a circle
 * passes texels of both. It knows nothing of how either came about. */

#define ABBE_RINGS_MAX 64
#define ABBE_RINGS_STEPS 24 /* circles across a ragged edge */

typedef struct abbe_rings {
  abbe_map_layout layout;
  size_t width, height;            /* texels */
  double centre[3];                /* on the receiver: a level plane */
  size_t count;                    /* rings */
  double edge[ABBE_RINGS_MAX + 1]; /* m, ascending from 0 or more */
  double ragged;                   /* m: no texel reaches further over the edge of its ring */
  uint8_t *ring;                   /* [width * height], row 0 at the top; count: in none */
} abbe_rings;

/* Rings around centre on the level plane through it, between edge[0], edge[1], ... edge[count].
 * ABBE_INVALID_ARGUMENT for edges that do not ascend or more than ABBE_RINGS_MAX rings. */
abbe_result abbe_rings_make(const abbe_map_layout *layout, size_t width, size_t height,
                            const double centre[3], const double *edge, size_t count,
                            abbe_rings *out, abbe_error *error);
void abbe_rings_free(abbe_rings *rings);

/* Sums of a map's channel (samples `stride` apart, row 0 at the top) over each ring into
 * sum[count]; squared: sums of the squared samples, for variances. */
void abbe_rings_sum(const abbe_rings *rings, const float *sample, size_t stride, bool squared,
                    double *sum);

/* Radii in m, ascending within an edge, at which the profile must be known: for each edge
 * ABBE_RINGS_STEPS + 1 of them; radius[(count + 1) * (ABBE_RINGS_STEPS + 1)]. */
void abbe_rings_radii(const abbe_rings *rings, double *radius);

/* What a profile with these enclosed fluxes (W at those radii; `stride` apart) puts into each
 * ring's texels: flux[count]. */
void abbe_rings_expect(const abbe_rings *rings, const double *enclosed, size_t stride,
                       double *flux);

/* A run for known answers: passes enough for their spread, and photons a pass such that all of
 * them are the options' samples, or the group's own number. Fills seed, threads and photons. */
size_t abbe_known_passes(const abbe_known_run *run, uint64_t samples, abbe_trace_desc *desc);

/* A narrow band around lambda_nm: one wavelength for every purpose here. */
void abbe_known_narrow(double lambda_nm, abbe_trace_desc *desc);

/* XYZ of every ring in every pass: sum[passes * rings->count], W, pass by pass. The map's size and
 * layout are the rings'. Progress runs from `from` to `to` of the group. */
abbe_result abbe_known_measure(const abbe_known_run *run, double from, double to,
                               const abbe_scene *scene, const abbe_trace_desc *desc, size_t passes,
                               const abbe_rings *rings, double (*sum)[3], abbe_error *error);

/* Mean over passes of channel `channel` summed over rings [first, end), and its standard error. */
void abbe_known_mean(double (*sum)[3], size_t passes, size_t rings, size_t first, size_t end,
                     int channel, double *mean, double *standard_error);

/* Student's factor: a mean over so many passes is as seldom this many of its standard errors off
 * as a normal one is ABBE_KNOWN_SIGMAS.  */
double abbe_known_sigmas(size_t passes);

/* A whole run of which one number is known: a weighted mean over its picture, or what its ledger
 * has. */
typedef struct abbe_known_setting {
  const char *what, *unit, *reason; /* as in abbe_known_answer */
  double exact;
  double slack;  /* that the value may be off beside noise */
  double useful; /* as in abbe_known_answer */
  uint64_t samples;
  double lambda_nm;      /* narrow around it; 0: the whole range */
  double min_nm, max_nm; /* the range; 0, 0: the usual one */
  bool polarised;        /* paths carry the light's polarisation also without polarisers */
  size_t side;           /* pixels of the picture */
  bool once;             /* a medium scatters light once (physics.h) */
  const char *channel;   /* whose mean over the picture is known; NULL: the flux that was met, W;
                            "turned": the share of it that refractors' haze has scattered; "yield":
                            photons emitted by photon taken; "deposited": the share of it that
                            receivers met; "closed": what came out of all that came
                            in and glowed */
  double (*weight)(double x, double y); /* weight of a pixel whose middle lies there, the picture
                                           reaching from -1 to 1 both ways, y up; NULL: 1 */
} abbe_known_setting;

/* Traces the scene pass by pass and adds a row: the tolerance is the setting's slack and four
 * standard errors, by the spread of the passes. Progress runs from `from` to `to` of the group. */
abbe_result abbe_known_add_setting(abbe_known_run *run, const abbe_known_setting *setting,
                                   const abbe_scene *scene, double from, double to,
                                   abbe_error *error);

/* The rows of one sphere, light and plane of the groups `sphere` and (white) `white`.
 * ABBE_INVALID_ARGUMENT beyond the last. */
abbe_result abbe_known_sphere_setting(abbe_known_run *run, size_t index, bool white,
                                      abbe_error *error);
/* The row of one pane of the groups `pane` and (absorbs) `absorption`; likewise. */
abbe_result abbe_known_pane_setting(abbe_known_run *run, size_t index, bool absorbs,
                                    abbe_error *error);
/* Panes in light that is followed as polarised, the first part of the group `polarised`, up to the
 * share `to` of its work. */
abbe_result abbe_known_sheets(abbe_known_run *run, double to, abbe_error *error);
/* The rows of one picture of the group `picture` (0: under a beam, 1: under a point light, 2:
 * under a beam, through a pane). */
abbe_result abbe_known_picture_setting(abbe_known_run *run, size_t index, abbe_error *error);

#endif
