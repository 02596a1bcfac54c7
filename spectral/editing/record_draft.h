/* record_draft.h: one record of a table's file under an editor's hands.
 *
 * Its values as fields of text, in the format's order; a change is made on a copy of the record
 * alone, so that it is quick however large the file, can be undone, and may leave the record for a
 * while in a state that is no material. Saving carries the fields that differ into the file through
 * table_edit.h, with all that it promises. It draws nothing and reads no keys.
 */
#ifndef ABBE_SPECTRAL_EDITING_RECORD_DRAFT_H
#define ABBE_SPECTRAL_EDITING_RECORD_DRAFT_H

#include "base/error.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_record_draft abbe_record_draft;

typedef struct abbe_draft_field {
  char key[32];  /* as abbe_table_edit_set has it, such as coefficients.0 */
  char *text;    /* "" where the record has no such key; a range as "from to" */
  bool number;   /* one number */
  bool required; /* cannot be emptied */
  bool changed;  /* not as in the file */
} abbe_draft_field;

/* Opens the record `name` of the table file. Errors as abbe_table_edit_open and _set. */
abbe_result abbe_record_draft_open(const char *path, const char *name, abbe_record_draft **out,
                                   abbe_error *error);
void abbe_record_draft_free(abbe_record_draft *draft);

/* The fields; their number changes with the coefficients'. Owned by the draft, until a change. */
size_t abbe_record_draft_count(const abbe_record_draft *draft);
const abbe_draft_field *abbe_record_draft_field(const abbe_record_draft *draft, size_t index);

/* Field `index` becomes text; an empty one takes an optional key out. ABBE_INVALID_ARGUMENT, and
 * nothing is changed, for a number that is none, or an empty required field. A change that leaves
 * no material is made: see abbe_record_draft_trouble. */
abbe_result abbe_record_draft_set(abbe_record_draft *draft, size_t index, const char *text,
                                  abbe_error *error);
/* The value of key (any of the record's, as abbe_table_edit_set has it) becomes this line of YAML:
 * a fix that a finding names. */
abbe_result abbe_record_draft_put(abbe_record_draft *draft, const char *key, const char *value,
                                  abbe_error *error);
/* One coefficient more (0, at the end) or one fewer. */
abbe_result abbe_record_draft_resize(abbe_record_draft *draft, bool more, abbe_error *error);
/* Back one change, or forth again; false where there is none. */
bool abbe_record_draft_undo(abbe_record_draft *draft);
bool abbe_record_draft_redo(abbe_record_draft *draft);

/* What the record would be with field `index` as text; the caller frees it. */
abbe_result abbe_record_draft_try(const abbe_record_draft *draft, size_t index, const char *text,
                                  abbe_material *out, abbe_error *error);
/* The record as a material, or NULL where it is none; then _trouble gives the reason, else "". */
const abbe_material *abbe_record_draft_material(const abbe_record_draft *draft);
const char *abbe_record_draft_trouble(const abbe_record_draft *draft);
/* The record as it was opened, or NULL where it was no material. */
const abbe_material *abbe_record_draft_original(const abbe_record_draft *draft);

/* Whether anything differs from the file. */
bool abbe_record_draft_is_changed(const abbe_record_draft *draft);
/* Writes the changes into the file. ABBE_SCHEMA where the record is no material; else as
 * abbe_table_edit_save. The draft goes on from what was saved; undo still leads back. */
abbe_result abbe_record_draft_save(abbe_record_draft *draft, abbe_error *error);

#endif
