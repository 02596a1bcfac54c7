#include "cli/base/shipped.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

const char *abbe_shipped_find(const char *path, char *text, size_t size) {
  static const char *const shares[] = {ABBE_SHARE_BESIDE, ABBE_SHARE};
  char own[PATH_MAX];
  if (path[0] == '/' || access(path, F_OK) == 0) return path;
  ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
  own[length > 0 ? length : 0] = '\0';
  char *slash = strrchr(own, '/');
  if (slash != NULL) slash[1] = '\0';
  for (int i = slash == NULL; i < 2; i++) {
    int n = snprintf(text, size, "%s%s/%s", i == 0 ? own : "", shares[i], path);
    if (n > 0 && (size_t)n < size && access(text, F_OK) == 0) return text;
  }
  return path;
}
