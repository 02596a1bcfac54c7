#define _GNU_SOURCE /* O_TMPFILE */

#include "tests/faults/disk.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static bool on, unnamed = true;
static size_t seen, wanted;
static int why;
static const char *what = "";

void faults_disk_begin(size_t n, int number) {
  seen = 0;
  wanted = n;
  why = number;
  what = "";
  on = true;
}

size_t faults_disk_end(void) {
  on = false;
  return seen;
}

const char *faults_disk_what(void) {
  return what;
}

void faults_disk_unnamed(bool allowed) {
  unnamed = allowed;
}

static bool fails(const char *name) {
  if (!on || ++seen != wanted) return false;
  what = name;
  errno = why;
  return true;
}

#define WRAP(type, name, parameters, arguments, none)                                              \
  type __real_##name parameters;                                                                   \
  type __wrap_##name parameters;                                                                   \
  type __wrap_##name parameters {                                                                  \
    return fails(#name) ? (none) : __real_##name arguments;                                        \
  }

WRAP(int, linkat, (int a, const char *from, int b, const char *to, int flags),
     (a, from, b, to, flags), -1)
WRAP(FILE *, fdopen, (int fd, const char *mode), (fd, mode), NULL)
WRAP(int, fchmod, (int fd, mode_t mode), (fd, mode), -1)
WRAP(int, fsync, (int fd), (fd), -1)
WRAP(int, rename, (const char *from, const char *to), (from, to), -1)
WRAP(ssize_t, pwrite, (int fd, const void *data, size_t size, off_t at), (fd, data, size, at), -1)

/* A close that fails has closed. Streams in memory are no files. */
int __real_fclose(FILE *stream);
int __wrap_fclose(FILE *stream);
int __wrap_fclose(FILE *stream) {
  const bool failed = fileno(stream) >= 0 && fails("fclose");
  const int code = __real_fclose(stream);
  if (!failed) return code;
  errno = why;
  return EOF;
}

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE) {
    va_list list;
    va_start(list, flags);
    mode = va_arg(list, mode_t);
    va_end(list);
  }
  if ((flags & O_TMPFILE) == O_TMPFILE && !unnamed) {
    errno = EOPNOTSUPP;
    return -1;
  }
  return fails("open") ? -1 : __real_open(path, flags, mode);
}
