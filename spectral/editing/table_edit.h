/* table_edit.h: changes to the file of a material table, a record at a time.
 *
 * An edit changes the record that it names and leaves every other byte of the file as it was,
 * comments and order included (base/yaml/yaml_edit.h). Several changes may follow one another; the
 * result must be a table before it is written. It is written beside and renamed, and not over a
 * file that has changed since it was read. It judges no values beyond what a table must be: for
 * that see the checks of materials.
 */
#ifndef ABBE_SPECTRAL_EDITING_TABLE_EDIT_H
#define ABBE_SPECTRAL_EDITING_TABLE_EDIT_H

#include "base/error.h"
#include "base/yaml/yaml_edit.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_table_edit abbe_table_edit;

/* Reads the file at path (at most 16 MiB). ABBE_UNSUPPORTED, with what to do instead, for NULL, the
 * tables that are compiled in, and stores; ABBE_PARSE where it is not YAML with a list 'materials'.
 * A file that is YAML but no table (a wrong record) can be edited: that is how it is fixed. */
abbe_result abbe_table_edit_open(const char *path, abbe_table_edit **out, abbe_error *error);
/* A table without a record yet, for a file that must not exist until it is saved. */
abbe_result abbe_table_edit_make(const char *path, abbe_table_edit **out, abbe_error *error);
/* From memory; it can be changed and read, not saved. */
abbe_result abbe_table_edit_parse(const char *text, size_t size, const char *name,
                                  abbe_table_edit **out, abbe_error *error);
void abbe_table_edit_free(abbe_table_edit *edit);
ABBE_HOLDS(abbe_table_edit)

/* The file's text with the changes, owned by the edit, until the next change. */
const char *abbe_table_edit_text(const abbe_table_edit *edit, size_t *size);

/* The text as it was read or last saved; "" for a new file. */
const char *abbe_table_edit_original(const abbe_table_edit *edit, size_t *size);

/* The changes. `name` is a record's, whatever the case: ABBE_NOT_FOUND names the nearest. `key` is
 * a key of a record or a path in it: "source", "absorption.distance_m", "coefficients.0". On
 * failure nothing is changed. */

/* The value of key becomes `value`, one line of YAML; a key that is not there is put where the
 * format has it, with the mapping that it stands in. */
abbe_result abbe_table_edit_set(abbe_table_edit *edit, const char *name, const char *key,
                                const char *value, abbe_error *error);
/* The same for a text, put in quotes where it must be. */
abbe_result abbe_table_edit_set_text(abbe_table_edit *edit, const char *name, const char *key,
                                     const char *text, abbe_error *error);
/* Takes key and its value out. */
abbe_result abbe_table_edit_unset(abbe_table_edit *edit, const char *name, const char *key,
                                  abbe_error *error);
/* A new record at the end; record is its YAML, one mapping, in any indentation. */
abbe_result abbe_table_edit_add(abbe_table_edit *edit, const char *record, abbe_error *error);
/* The last record of a table stays: ABBE_INVALID_ARGUMENT. */
abbe_result abbe_table_edit_remove(abbe_table_edit *edit, const char *name, abbe_error *error);
abbe_result abbe_table_edit_rename(abbe_table_edit *edit, const char *name, const char *new_name,
                                   abbe_error *error);

/* The record's own text, with the comments inside it, at the left margin; malloc'd. */
abbe_result abbe_table_edit_record(abbe_table_edit *edit, const char *name, char **out,
                                   abbe_error *error);

/* ABBE_OK where the changed text is a table, else abbe_material_table_parse's error about it. */
abbe_result abbe_table_edit_check(const abbe_table_edit *edit, abbe_error *error);
/* What abbe_table_edit_save would return, but for the disk: ABBE_SCHEMA where the text was a table
 * and would be none after the changes. */
abbe_result abbe_table_edit_allow(const abbe_table_edit *edit, abbe_error *error);
/* Writes the file. ABBE_SCHEMA as above; ABBE_IO where the file is not as it was read. Without
 * changes nothing is written. */
abbe_result abbe_table_edit_save(abbe_table_edit *edit, abbe_error *error);

/* Where a record and a key of it stand in the text of a material table. */

/* The index of the pair `materials` of the root, where it is a list or empty. */
abbe_result abbe_table_place_list(const abbe_yaml_edit *edit, size_t *index, abbe_error *error);
/* That list; absent where there is none. */
abbe_yaml_node abbe_table_place_records(const abbe_yaml_edit *edit);

/* The record of that name, whatever the case, and its index in the list. ABBE_NOT_FOUND names the
 * nearest; ABBE_INVALID_ARGUMENT where two have it; ABBE_UNSUPPORTED for an alias. */
abbe_result abbe_table_place_record(const abbe_yaml_edit *edit, const char *name, size_t *index,
                                    abbe_yaml_node *record, abbe_error *error);

/* How far a path leads: the last collection on it, the step in it, and what is left of the path
 * where that step is not there. */
typedef struct abbe_table_place {
  abbe_yaml_node parent;
  size_t index;
  bool found, in_record;
  char rest[128]; /* the steps that are not there, dotted */
} abbe_table_place;

abbe_result abbe_table_place_key(const abbe_yaml_edit *edit, const char *name, const char *key,
                                 abbe_table_place *out, abbe_error *error);
/* The pair of the record that a new key goes after: the last that ranks no later. */
size_t abbe_table_place_after(const abbe_yaml *yaml, abbe_yaml_node record, const char *key);
/* ABBE_NOT_FOUND: the record has no such key. */
abbe_result abbe_table_place_none(const abbe_yaml_edit *edit, const char *name, const char *key,
                                  abbe_error *error);

/* The fixes that a check is certain of, put into a table's text.
 *
 * Only what spectral/editing/check.h is certain of is changed, and only the bytes of the values
 * concerned. Nothing is written to a file here. */

typedef struct abbe_table_fix {
  size_t fixed;     /* values that were set */
  size_t refused;   /* that could not be, since a name stands twice or the text cannot carry it */
  char why[400];    /* the first that was refused; "" without */
  char warned[400]; /* names of fixed rows that have a warning, which may no longer hold: "a, b" */
} abbe_table_fix;

/* Fixes until nothing certain is left: one fix may bring out the next fault. ABBE_PARSE,
 * ABBE_SCHEMA, ABBE_NO_MEMORY as the table's reading has them; what is refused is not a failure. */
abbe_result abbe_table_fix_make(abbe_table_edit *edit, const abbe_material_table *known,
                                abbe_table_fix *out, abbe_error *error);

#endif
