/* compare_report.h: a comparison for people and as JSON. */
#ifndef ABBE_CLI_COMPARE_REPORT_H
#define ABBE_CLI_COMPARE_REPORT_H

#include "validation/compare/compare.h"

enum { ABBE_COMPARE_MAX_TOLERANCES = 64, ABBE_COMPARE_MAX_NOTES = 16 };

/* One --tolerance. */
typedef struct abbe_compare_tolerance {
  abbe_compare_metric metric;
  bool mask; /* of the masked region, else of the whole field */
  double tolerance;
} abbe_compare_tolerance;

typedef struct abbe_compare_report {
  const char *path[2]; /* REF, TEST */
  const abbe_field *field[2];
  size_t size[2][2];     /* width and height as read */
  const char *mask_name; /* NULL: none */
  double mask_share;     /* of the caustic's light; 0: the mask was drawn */
  const abbe_mask *mask;
  const abbe_comparison *comparison;
  size_t tolerance_count;
  const abbe_compare_tolerance *tolerance;
  size_t note_count;
  char note[ABBE_COMPARE_MAX_NOTES][400];
} abbe_compare_report;

/* Adds what a reader should know beside the numbers. */
void abbe_compare_report_add_notes(abbe_compare_report *report);
/* Whether a tolerance is kept. A region with pixels of TEST that are not finite keeps none. */
bool abbe_compare_report_keeps(const abbe_compare_report *report, const abbe_compare_tolerance *t);

void abbe_compare_report_print(const abbe_compare_report *report);
abbe_result abbe_compare_report_print_json(const abbe_compare_report *report, abbe_error *error);

#endif
