#include "library/lib_version.h"

#ifndef ABBE_VERSION
#error "the build defines ABBE_VERSION"
#endif

const char *abbe_lib_version(void) {
  return ABBE_VERSION;
}
