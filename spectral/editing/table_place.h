/* table_place.h: where a record and a key of it stand in the text of a material table.
 * Internal to spectral/. */
#ifndef ABBE_SPECTRAL_EDITING_TABLE_PLACE_H
#define ABBE_SPECTRAL_EDITING_TABLE_PLACE_H

#include "base/error.h"
#include "base/yaml/yaml_edit.h"

#include <stdbool.h>
#include <stddef.h>

/* The index of the pair `materials` of the root, where it is a list or empty. */
abbe_result abbe_table_place_list(const abbe_yaml_edit *edit, size_t *index, abbe_error *error);
/* That list; absent where there is none. */
abbe_yaml_node abbe_table_place_records(const abbe_yaml_edit *edit);

/* The name of a record, or "". */
const char *abbe_table_place_name(const abbe_yaml *yaml, abbe_yaml_node record);
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

#endif
