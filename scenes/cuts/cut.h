/* cut.h: the design of a cut stone, as those who facet gems write it: planes in tiers.
 *
 * A tier is what is cut at one angle and distance, at several indices of a gear. A stone is what
 * lies behind all planes (cut_polyhedron.h). Lengths are in the design's own units; x points right,
 * y to the index at the gear's offset, z up through the table. Angles are cutters': above 0 of the
 * crown, below of the pavilion, 90 either way of the girdle, 0 of the table, -0 of a flat culet.
 */
#ifndef ABBE_SCENES_CUTS_CUT_H
#define ABBE_SCENES_CUTS_CUT_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_CUT_MAX_FACETS 4096
#define ABBE_CUT_MAX_GEAR 10000
/* Distances are between 1 over this and this. */
#define ABBE_CUT_FAR 1e6
/* A facet within so many degrees of upright is the girdle's. */
#define ABBE_CUT_GIRDLE_DEG 0.1
enum { ABBE_CUT_LINES = 4 }; /* headings, and footnotes */

typedef struct abbe_cut_facet {
  double n[3], d; /* n . x <= d, unit n, d above 0 */
  double index;   /* the gear's index, as it is read; it may have a fraction */
  size_t tier;
  char *name; /* or NULL: it shares that of another of its tier (abbe_cut_facet_name) */
} abbe_cut_facet;

typedef struct abbe_cut_tier {
  double angle_deg, distance;
  size_t first, count; /* range in facet[] */
  char *instruction;   /* or NULL */
} abbe_cut_tier;

/* Texts are malloc'd UTF-8, NULL where there is none. */
typedef struct abbe_cut {
  int gear;      /* teeth; below 0 where indices grow in the other direction */
  double offset; /* the index in the direction of y */
  int folds;     /* order of its symmetry, for people: every facet is listed; 0: not stated */
  bool mirror;
  double refractive_index; /* index that it was designed for; 0: not stated */
  char *heading[ABBE_CUT_LINES], *footnote[ABBE_CUT_LINES]; /* the first heading is its title */
  size_t tier_count, facet_count;
  abbe_cut_tier *tier;
  abbe_cut_facet *facet; /* tier by tier */
} abbe_cut;

/* Safe on a zeroed cut. */
void abbe_cut_free(abbe_cut *cut);

/* A cut with tiers and facets of its own, whose names and texts are the other's. ABBE_NO_MEMORY;
 * the caller frees it with abbe_cut_copy_free alone. */
abbe_result abbe_cut_copy(const abbe_cut *cut, abbe_cut *out, abbe_error *error);
/* Safe on a zeroed one. */
void abbe_cut_copy_free(abbe_cut *copy);

/* Begins a tier behind the others. ABBE_NO_MEMORY. */
abbe_result abbe_cut_add_tier(abbe_cut *cut, double angle_deg, double distance, abbe_error *error);
/* A facet of the last tier, of which only the index is set. ABBE_UNSUPPORTED beyond
 * ABBE_CUT_MAX_FACETS, ABBE_INVALID_ARGUMENT without a tier, ABBE_NO_MEMORY. */
abbe_result abbe_cut_add_facet(abbe_cut *cut, double index, abbe_error *error);

/* The facets' planes from their tiers' angles and distances and their own indices. */
void abbe_cut_place(abbe_cut *cut);

/* The angle of the unit normal in degrees, as cutters give it; -0 where it points straight down. */
double abbe_cut_angle(const double n[3]);
/* The index at the unit normal's azimuth, above 0 to the gear's teeth; the offset's where it points
 * up or down. Within 1e-6 of a whole number it is that. */
double abbe_cut_index(const abbe_cut *cut, const double n[3]);

/* Its own name, or the last before it in its tier, or the first behind it; "" where the tier has
 * none. */
const char *abbe_cut_facet_name(const abbe_cut *cut, size_t facet);
bool abbe_cut_facet_is_girdle(const abbe_cut_facet *facet);

/* Whether all is as this header says: ABBE_SCHEMA with a sentence where something is not, such as a
 * distance of 0 or fewer than 4 facets. */
abbe_result abbe_cut_check(const abbe_cut *cut, abbe_error *error);

/* UTF-8 to and from the Windows-1252 of GemCad's files. */

/* Writes at most size - 1 bytes and a zero; control characters become spaces, letters that the
 * encoding lacks '?'. Returns the bytes written. */
size_t abbe_cut_text_narrow(const char *utf8, char *out, size_t size);

/* size bytes of Windows-1252 as UTF-8, malloc'd; control characters become spaces, bytes without a
 * meaning U+FFFD. NULL without memory. */
char *abbe_cut_text_widen(const char *bytes, size_t size);

#endif
