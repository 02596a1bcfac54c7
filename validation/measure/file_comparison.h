/* file_comparison.h: two files held against each other: loaded, aligned, masked, compared, and
 * judged by tolerances.
 */
#ifndef ABBE_VALIDATION_MEASURE_FILE_COMPARISON_H
#define ABBE_VALIDATION_MEASURE_FILE_COMPARISON_H

#include "validation/measure/compare.h"
#include "validation/measure/field.h"

typedef struct abbe_file_comparison_desc {
  const char *path[2];          /* REF, TEST */
  const char *mask;             /* "caustic", a picture whose first channel is above 0.5; or NULL */
  double mask_share;            /* share of the caustic's light */
  abbe_compare_options options; /* its mask is not looked at */
} abbe_file_comparison_desc;

typedef struct abbe_file_comparison {
  const char *path[2]; /* the request's */
  abbe_field field[2];
  size_t size[2][2];     /* width and height as read */
  const char *mask_name; /* NULL: none */
  char mask_part[40];    /* part of the file that it was drawn in, as abbe_image names it */
  double mask_share;     /* share of the caustic's light; 0: the mask was drawn */
  abbe_mask mask;
  abbe_comparison comparison;
} abbe_file_comparison;

/* The texts of the request outlive it. On failure *out is empty. Errors of abbe_field_load,
 * abbe_field_align and abbe_compare; ABBE_INVALID_ARGUMENT for a mask of another size or place. */
abbe_result abbe_file_comparison_make(const abbe_file_comparison_desc *desc,
                                      abbe_file_comparison *out, abbe_error *error);
void abbe_file_comparison_free(abbe_file_comparison *comparison);

/* An attribute of a side's file, or NULL; a region's metrics; whether a side has standard errors.
 */
const char *abbe_file_comparison_attribute(const abbe_file_comparison *comparison, int side,
                                           const char *key);
const abbe_compare_region *abbe_file_comparison_region(const abbe_file_comparison *comparison,
                                                       bool mask);
bool abbe_file_comparison_has_errors(const abbe_file_comparison *comparison, int side);

/* The largest deviation (abbe_compare_deviation) that passes. */
typedef struct abbe_compare_tolerance {
  abbe_compare_metric metric;
  bool mask; /* over the masked region, else over the whole field */
  double tolerance;
} abbe_compare_tolerance;

/* ABBE_INVALID_ARGUMENT where a tolerance bounds what is not known of the two: it would be kept for
 * ever. */
abbe_result abbe_file_comparison_check(const abbe_file_comparison *comparison,
                                       const abbe_compare_tolerance *tolerance, size_t count,
                                       abbe_error *error);
/* Whether one is kept. A region with pixels of TEST that are not finite keeps none. */
bool abbe_file_comparison_keeps(const abbe_file_comparison *comparison,
                                const abbe_compare_tolerance *tolerance);
/* ABBE_TOLERANCE, with the first that is not kept, and how many more. */
abbe_result abbe_file_comparison_judge(const abbe_file_comparison *comparison,
                                       const abbe_compare_tolerance *tolerance, size_t count,
                                       abbe_error *error);

/* Where TEST is brighter or darker, in colours from -range to range (0: 99 % of what there is), as
 * a .png or .svg. */
abbe_result abbe_file_comparison_draw(const abbe_file_comparison *comparison, const char *path,
                                      double range, abbe_error *error);

/* What a reader of a comparison should know beside its numbers, in sentences. */

#define ABBE_COMPARE_MAX_NOTES 16

typedef struct abbe_compare_notes {
  size_t count;
  char note[ABBE_COMPARE_MAX_NOTES][400];
} abbe_compare_notes;

/* What the files do not say or differ in, what the numbers are in, and what noise explains. */
void abbe_compare_notes_make(const abbe_file_comparison *comparison, abbe_compare_notes *out);

/* Where a field is brighter or darker than a reference, in false colours.
 *
 * Each pixel's difference of Y (or of the sum of bands): blue where the test is darker, light
 * where both agree, red where it is brighter, green where a side is not finite; with a scale bar,
 * by colorimetry/plot/chart.h. Pixels are enlarged by a whole number, not smoothed. */

/* A field whose longer side is shorter than this is enlarged, to at most this. */
#define ABBE_DIFFERENCE_PICTURE_SIDE 512

/* The least of 1, 2 and 5 times a power of ten that is not below the magnitude that 99 % of the
 * finite differences stay under (of all, where those are 0); 0 where nothing differs. Fields as for
 * abbe_compare; `scale` multiplies the test. ABBE_INVALID_ARGUMENT for fields of two sizes;
 * ABBE_NO_MEMORY. */
abbe_result abbe_difference_picture_range(const abbe_field *reference, const abbe_field *test,
                                          double scale, double *range, abbe_error *error);

/* Writes the differences, from -range to range, to path, a .png or .svg, under a title (NULL:
 * none). ABBE_INVALID_ARGUMENT also for a range that is not above 0; errors of abbe_chart_write. */
abbe_result abbe_difference_picture_write(const char *path, const abbe_field *reference,
                                          const abbe_field *test, double scale, double range,
                                          const char *title, abbe_error *error);

#endif
