/* microfacets.h: how a rough surface spreads light: GGX's facets, of unlike width along two
 * directions at right angles [Walter2007] [Heitz2014].
 *
 * Geometry alone: what a facet reflects is Fresnel's. Off a mirror light meets one facet, and what
 * that sends into another is lost; through a refractor's face it is followed from facet to facet
 * [Heitz2016]. Directions are
 * unit vectors away from the surface, in its own frame: x along the first direction, y along the
 * second, z its mean normal.
 */
#ifndef ABBE_SPECTRAL_MICROFACETS_H
#define ABBE_SPECTRAL_MICROFACETS_H

#include <stdbool.h>

/* Roughness along x and y, 0.001 to 1: GGX's alpha, not a root of it. Where both are alike, half of
 * the surface is tilted by less than its arc tangent. */
typedef struct abbe_microfacets {
  double x, y;
} abbe_microfacets;

#define ABBE_MICROFACETS_LEAST 0.001

/* Facets of normal h by solid angle of normals and area of surface, 1/sr; times h[2] it integrates
 * to 1. */
double abbe_microfacets_density(const abbe_microfacets *m, const double h[3]);

/* Share of the facets of whatever normal that face w which w sees, 0 to 1; 0 below the surface. */
double abbe_microfacets_visible(const abbe_microfacets *m, const double w[3]);

/* Reflected radiance by irradiance, 1/sr, of facets that reflect all: from wi to wo and, the same,
 * from wo to wi; 0 below the surface. */
double abbe_microfacets_reflect(const abbe_microfacets *m, const double wi[3], const double wo[3]);

/* The facet that light along wo meets, drawn of u in [0, 1)^2 by how much of it wo sees
 * [Heitz2018]; wi, where it reflects that to. Returns the share that no other facet takes, 0 to 1;
 * 0 where wi is below the surface. Below the surface wo sees what faces down to it; then h alone
 * holds. */
double abbe_microfacets_sample(const abbe_microfacets *m, const double wo[3], const double u[2],
                               double h[3], double wi[3]);

/* Density of abbe_microfacets_sample's wi, 1/sr; it integrates to 1 over all directions, those
 * below the surface with it. */
double abbe_microfacets_pdf(const abbe_microfacets *m, const double wo[3], const double wi[3]);

/* Density of the facets' normals that abbe_microfacets_sample draws, 1/sr; wo anywhere. */
double abbe_microfacets_normals(const abbe_microfacets *m, const double wo[3], const double h[3]);

/* Chance that light along w, at the height that the share `height` of the surface is below, 0 to 1,
 * leaves it and meets no facet more; 0 where it goes down. */
double abbe_microfacets_escape(const abbe_microfacets *m, const double w[3], double height);

/* Moves such light to the facet that it meets next, drawn of u in [0, 1); false: it leaves.
 * [Heitz2016] */
bool abbe_microfacets_travel(const abbe_microfacets *m, const double w[3], double u,
                             double *height);

#endif
