/* compare_notes.h: what a reader of a comparison should know beside its numbers, in sentences. */
#ifndef ABBE_VALIDATION_COMPARE_COMPARE_NOTES_H
#define ABBE_VALIDATION_COMPARE_COMPARE_NOTES_H

#include "validation/compare/file_comparison.h"

#define ABBE_COMPARE_MAX_NOTES 16

typedef struct abbe_compare_notes {
  size_t count;
  char note[ABBE_COMPARE_MAX_NOTES][400];
} abbe_compare_notes;

/* What the files do not say or differ in, what the numbers are in, and what noise explains. */
void abbe_compare_notes_make(const abbe_file_comparison *comparison, abbe_compare_notes *out);

#endif
