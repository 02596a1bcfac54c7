/* lib_shipped.h: files that came with the library, found wherever it was installed.
 *
 * Internal to cli/library/.
 */
#ifndef ABBE_LIBRARY_LIB_SHIPPED_H
#define ABBE_LIBRARY_LIB_SHIPPED_H

#include <stddef.h>

/* path, where something is there; else that path in the share folder beside the file that this code
 * was loaded from, or where the build installs it, in text[size]; else path. */
const char *abbe_library_shipped_find(const char *path, char *text, size_t size);

#endif
