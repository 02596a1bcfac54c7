/* yaml_quote.h: any text as one YAML scalar that reads back the same.
 *
 * Plain where no place in YAML takes it for anything else, else in double quotes, on one line
 * either way. Bytes that are no UTF-8 (a file's name may hold them) become U+FFFD, since they would
 * make the whole file unreadable.
 */
#ifndef ABBE_BASE_YAML_YAML_QUOTE_H
#define ABBE_BASE_YAML_YAML_QUOTE_H

#include "base/error.h"

#include <stdio.h>

/* Writes to the stream, whose own error state shows a failure. */
void abbe_yaml_quote_write(const char *text, FILE *to);
/* *out is malloc'd, NULL on failure. ABBE_NO_MEMORY. */
abbe_result abbe_yaml_quote_make(const char *text, char **out, abbe_error *error);

#endif
