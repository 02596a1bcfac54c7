/* shipped.h: files that came with the program, found wherever it was installed. */
#ifndef ABBE_CLI_BASE_SHIPPED_H
#define ABBE_CLI_BASE_SHIPPED_H

#include <stddef.h>

/* path, where something is there; else that path in the share folder beside the program's own, or
 * where the build installs it, in text[size]; else path. */
const char *abbe_shipped_find(const char *path, char *text, size_t size);

#endif
