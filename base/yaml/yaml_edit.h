/* yaml_edit.h: changes to a YAML text that leave every other byte as it was.
 *
 * A value is replaced, a pair or an item is put in or taken out; comments, order, quotes, line ends
 * and layout of all the rest stay, in block style and in brackets. Each change is read again before
 * it holds: one that breaks the text, or that the text would understand otherwise (a value with a
 * comment sign, say), is refused and the text stays. It knows nothing of what the text is about,
 * and writes no files.
 */
#ifndef ABBE_BASE_YAML_YAML_EDIT_H
#define ABBE_BASE_YAML_YAML_EDIT_H

#include "base/error.h"
#include "base/yaml/yaml.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_YAML_EDIT_END SIZE_MAX

/* A text under change. All three are the edit's; after each change the document is a new one, and
 * nodes of the old one mean nothing. */
typedef struct abbe_yaml_edit {
  char *name; /* for messages */
  char *text; /* ended by a zero byte */
  size_t size;
  abbe_yaml *yaml;
} abbe_yaml_edit;

/* A copy of text[size], UTF-8. ABBE_PARSE where it is not well formed, ABBE_UNSUPPORTED for UTF-16.
 * Zeroed on failure. */
abbe_result abbe_yaml_edit_make(const char *text, size_t size, const char *name,
                                abbe_yaml_edit *out, abbe_error *error);
void abbe_yaml_edit_free(abbe_yaml_edit *edit);

/* Whether an alias (*name) stands as the value of pair or item `index` of parent: what it names is
 * shared with other places, so a change through it would change them too. */
bool abbe_yaml_edit_is_alias(const abbe_yaml_edit *edit, abbe_yaml_node parent, size_t index);

/* Puts `value`, one line of YAML (a scalar or brackets), in the place of the value of pair or item
 * `index` of parent. Lists too long for a line are wrapped where parent is in block style.
 * ABBE_UNSUPPORTED where an alias (*name) stands there; ABBE_INVALID_ARGUMENT for what is no value.
 */
abbe_result abbe_yaml_edit_replace(abbe_yaml_edit *edit, abbe_yaml_node parent, size_t index,
                                   const char *value, abbe_error *error);
/* A new pair of mapping, after its pair `after` (ABBE_YAML_EDIT_END: the last). */
abbe_result abbe_yaml_edit_insert_pair(abbe_yaml_edit *edit, abbe_yaml_node mapping, size_t after,
                                       const char *key, const char *value, abbe_error *error);
/* Takes out pair or item `index` of parent, with the comments inside it; comments before it and
 * after it stay, those after it that are indented as its own go. The last of a parent stays. */
abbe_result abbe_yaml_edit_remove(abbe_yaml_edit *edit, abbe_yaml_node parent, size_t index,
                                  abbe_error *error);
/* A new item at the end of the sequence that is (or, where it is empty, becomes) the value of pair
 * `index` of mapping. item is a whole YAML text, one mapping, in any style and indentation. */
abbe_result abbe_yaml_edit_append(abbe_yaml_edit *edit, abbe_yaml_node mapping, size_t index,
                                  const char *item, abbe_error *error);
/* The item's text as it stands, comments inside it too, moved to the left margin; *out is malloc'd.
 */
abbe_result abbe_yaml_edit_item(const abbe_yaml_edit *edit, abbe_yaml_node sequence, size_t index,
                                char **out, abbe_error *error);

/* count finite numbers as "[a, b, …]", each with the fewest digits that read back the same. */
abbe_result abbe_yaml_edit_list(const double *value, size_t count, char **out, abbe_error *error);

#endif
