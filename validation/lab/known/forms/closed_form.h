/* closed_form.h: optics that is known in closed form, for the known answers.
 *
 * Plain formulas in double precision, written from their own sources and not through
 * spectral/optics.h, so that a mistake there does not agree with itself. Indices are relative to
 * the surroundings, angles in radians. What light throws onto a plane under a sphere is no closed
 * form: see sphere_quadrature.h. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_LAB_KNOWN_FORMS_CLOSED_FORM_H
#define ABBE_VALIDATION_LAB_KNOWN_FORMS_CLOSED_FORM_H

#include <stdbool.h>
#include <stddef.h>

/* Unpolarised Fresnel reflectance at incidence [0, pi/2] from outside into index n, by the sine
 * and tangent laws; 1 beyond the critical angle where n < 1. [BornWolf1999, 1.5.2] */
double abbe_closed_form_fresnel(double incidence, double n);

/* The same of a metal of index n + i k, by complex amplitudes. [BornWolf1999, 14.2] */
double abbe_closed_form_conductor(double incidence, double n, double k);

/* Form factor from a plane patch at p with the unit normal n to a polygon: its irradiance over pi
 * times the polygon's radiance, by Lambert's formula. The polygon lies above the patch's plane, its
 * corners in order, either way round. [Howell2021, appendix C] */
double abbe_closed_form_polygon(const double (*corner)[3], size_t count, const double p[3],
                                const double n[3]);

/* Form factor from a disk of radius `from` to a parallel coaxial one of radius `to` at the distance
 * h; from a patch on its axis where `from` is 0. [Howell2021, C-41] */
double abbe_closed_form_coaxial_disks(double from, double to, double h);

/* Share of a disk of radius 1 that lies beyond a straight edge at -at from its middle, 0 to 1 for
 * `at` from -1 to 1: what a place in its penumbra sees of it, from far off. */
double abbe_closed_form_penumbra(double at);

/* Shares of the light that a plane-parallel slab reflects and passes with all reflections inside,
 * incoherently: r of one face, tau what one crossing leaves. [BornWolf1999, 1.5.4] */
void abbe_closed_form_slab(double r, double tau, double *reflected, double *passed);

/* A film of index n + i k between clear media; `waves`: its thickness in vacuum wavelengths. */
typedef struct abbe_closed_film {
  double from, n, k, to, waves;
} abbe_closed_film;

/* Shares of s, or p, that it reflects and passes, by the sum of what goes to and fro in it.
 * [BornWolf1999, 1.6.4] */
void abbe_closed_form_film(const abbe_closed_film *film, double incidence, bool p,
                           double *reflected, double *passed);

/* How far a slab of that thickness moves a ray sideways, at right angles to it. [BornWolf1999] */
double abbe_closed_form_slab_shift(double thickness, double incidence, double n);

/* Paraxial focal length of a ball, from its centre: n R / (2 (n - 1)). [BornWolf1999, 4.4] */
double abbe_closed_form_ball_focus(double radius, double n);

/* Distance from the ball's centre at which a ray that comes parallel to the axis, `height` off
 * it, crosses it: the paraxial one less the spherical aberration. 0 < height < radius. */
double abbe_closed_form_ball_crossing(double radius, double n, double height);

/* Turning towards the axis of a ray that passes a ball of index n with a concentric core of index
 * core_n, coming parallel to the axis `height` off it: n r sin(angle) is the same at every shell
 * [BornWolf1999, 3.2.2]. A ray that misses the core turns as in a plain ball; one that the core
 * reflects totally turns away from it, by the negative of what it returns. 0 < height < radius. */
double abbe_closed_form_shell_turn(double radius, double n, double core, double core_n,
                                   double height);

/* Descartes's rainbow of `order` >= 1 inner reflections: the least deviation, in total turning
 * (more than pi for the secondary), and the incidence at which it stands. False for n <= 1 or
 * n >= order + 1, where there is none. [Adam2002] */
bool abbe_closed_form_rainbow(double n, size_t order, double *deviation, double *incidence);

/* Least deviation of a prism; false where no ray passes at all: n sin(apex / 2) > 1.
 * [BornWolf1999, 4.7] */
bool abbe_closed_form_prism_least(double apex, double n, double *deviation);

/* A ray that crosses a prism in its principal plane. The apex is the origin, the base is down, the
 * ray comes from the left, meets the left face `along` from the apex under `incidence` from the
 * base's side of its normal. */
typedef struct abbe_prism_ray {
  double deviation;    /* towards the base */
  double from[2];      /* where it enters */
  double came[2];      /* unit, its direction before */
  double exit[2];      /* where it leaves the right face */
  double direction[2]; /* unit, after */
} abbe_prism_ray;

/* False where it is totally reflected at the second face or misses it. */
bool abbe_closed_form_prism_ray(double apex, double n, double incidence, double along,
                                abbe_prism_ray *ray);

/* What a vertical mirror cylinder throws onto the floor that it stands on.
 *
 * In plan a ray's course does not depend on how steeply it falls, so the floor shows the planar
 * caustic of a circle by reflection: of parallel light a nephroid, of a light on the wall a
 * cardioid. Double precision, whole rays, any number of reflections; the wall reflects all. */

/* The cylinder's axis is z, its foot stands in z = 0. */
typedef struct abbe_catacaustic {
  double radius, height; /* m */
  double elevation; /* rad above the horizon, of a sun whose light travels along +x; 0: a light */
  double lamp[3];   /* m, inside in plan, above the floor */
} abbe_catacaustic;

/* Irradiance at the place p of the floor, inside the cylinder, by light that was reflected
 * `bounces` >= 1 times: for a sun of 1 W/m2 across the beam or a light of 1 W/sr. It is infinite at
 * folds. *branches (may be NULL): by how many rays. */
double abbe_catacaustic_irradiance(const abbe_catacaustic *c, const double p[2], size_t bounces,
                                   size_t *branches);

/* Its mean over the square of side 2 half around p, by steps x steps places, for 1 to `bounces`
 * reflections together, each of which leaves the share `reflectance`. *branches: at p. */
double abbe_catacaustic_mean(const abbe_catacaustic *c, const double p[2], double half,
                             size_t steps, double reflectance, size_t bounces, size_t *branches);

/* What light that falls straight onto a sinusoidal surface makes on a level plane in the water, by
 * Snell's and Fresnel's laws.
 *
 * The surface is z = amplitude cos(2 pi x / wavelength), light comes down along -z, and the plane
 * lies at z = -depth. A ray is one number, where it enters, so irradiance is a sum over branches
 * of T / |dX/dx|. Double precision; it knows nothing of scenes, the tracer or the renderer. */

typedef struct abbe_wave_caustic {
  double amplitude, wavelength, depth; /* m */
  double index;                        /* index of the water */
  double attenuation_per_m;            /* natural, along the slanting path */
} abbe_wave_caustic;

/* Where light that enters at x meets the bottom, m, and in *passed (may be NULL) which share of it
 * does. */
double abbe_wave_caustic_landing(const abbe_wave_caustic *w, double x, double *passed);

/* Depth below the crest at which the rays beside it meet: n / ((n - 1) a k^2). */
double abbe_wave_caustic_focus(const abbe_wave_caustic *w);

/* Mean irradiance from x = from to x = to on the plane, of 1 W/m2 above, by `rays` even steps of
 * where light enters. */
double abbe_wave_caustic_mean(const abbe_wave_caustic *w, double from, double to, size_t rays);

/* By how many rays the place x is lit, counted over `rays` even steps. */
size_t abbe_wave_caustic_branches(const abbe_wave_caustic *w, double x, size_t rays);

#endif
