/* memory_file.h: bytes as a file that has a path and is on no disk, for readers that want a path.
 */
#ifndef ABBE_TESTS_FUZZ_MEMORY_FILE_H
#define ABBE_TESTS_FUZZ_MEMORY_FILE_H

#include "tests/fuzz/fuzz.h"

#include <fcntl.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

long syscall(long number, ...);

/* One file a program; its path stays the same. */
static inline const char *memory_file(const uint8_t *data, size_t size) {
  static char path[64];
  static int fd = -1;
  if (fd < 0) {
    fd = (int)syscall(SYS_memfd_create, "fuzz", 0u);
    FUZZ_PROMISE(fd >= 0);
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
  }
  FUZZ_PROMISE(ftruncate(fd, (off_t)size) == 0);
  FUZZ_PROMISE(pwrite(fd, data, size, 0) == (ssize_t)size);
  return path;
}

#endif
