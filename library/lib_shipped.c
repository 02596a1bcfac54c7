#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* dladdr */
#endif
#include "library/lib_handles.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The folder of the file that this code is in, with its slash. */
static void own_folder(char out[PATH_MAX]) {
  Dl_info info;
  out[0] = '\0';
  if (dladdr(ABBE_LIB_SHARE, &info) == 0 || info.dli_fname == NULL) return;
  if (realpath(info.dli_fname, out) == NULL) out[0] = '\0';
  char *slash = strrchr(out, '/');
  if (slash != NULL) slash[1] = '\0';
}

const char *abbe_library_shipped_find(const char *path, char *text, size_t size) {
  static const char *const shares[] = {ABBE_LIB_SHARE_BESIDE, ABBE_LIB_SHARE};
  char own[PATH_MAX];
  if (path[0] == '/' || access(path, F_OK) == 0) return path;
  own_folder(own);
  for (int i = own[0] == '\0'; i < 2; i++) {
    int n = snprintf(text, size, "%s%s/%s", i == 0 ? own : "", shares[i], path);
    if (n > 0 && (size_t)n < size && access(text, F_OK) == 0) return text;
  }
  return path;
}
