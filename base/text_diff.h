/* text_diff.h: the change from one text to another, as a unified diff.
 *
 * Lines are compared byte by byte; three lines of context; what `patch` reads. A shortest script is
 * found where the changed parts are short (an edit's are), else the whole part is replaced.
 */
#ifndef ABBE_BASE_TEXT_DIFF_H
#define ABBE_BASE_TEXT_DIFF_H

#include "base/error.h"

#include <stddef.h>

/* The diff from before to after under the name `path`, into *out (malloc'd, ended by a zero byte;
 * the caller frees); "" where the texts are the same. ABBE_NO_MEMORY. */
abbe_result abbe_text_diff(const char *before, size_t before_size, const char *after,
                           size_t after_size, const char *path, char **out, abbe_error *error);

#endif
