#define _GNU_SOURCE /* O_TMPFILE, realpath */

#include "base/file.h"

#include "base/foreign_text.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

const char *abbe_file_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash == NULL ? path : slash + 1;
}

static abbe_result fail_io(abbe_error *error, const char *path, const char *what, int number) {
  return abbe_error_set(error, ABBE_IO, "%s: %s: %s", path, what, strerror(number));
}

/* ---- opening ---- */

static const char *kind_of(mode_t mode) {
  return S_ISDIR(mode)    ? "a directory; name a file"
         : S_ISFIFO(mode) ? "a named pipe, which may never end; name a regular file"
         : S_ISSOCK(mode) ? "a socket; name a regular file"
                          : "a device; name a regular file";
}

/* Its inner end is only with those who were given it, so whoever writes there will close it. */
static bool is_nameless_pipe(int fd, mode_t mode) {
  struct statfs system;
  return S_ISFIFO(mode) && fstatfs(fd, &system) == 0 && system.f_type == PIPEFS_MAGIC;
}

/* The descriptor of a regular file, or of a pipe without a name where those will do; -1. */
static int open_to_read(const char *path, bool pipes, struct stat *status, abbe_error *error) {
  const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0 &&
      errno == ENXIO) /* what cannot be opened at all: a socket, a device with no driver */
    abbe_error_set(error, ABBE_IO, "%s: is no regular file", path);
  else if (fd < 0)
    fail_io(error, path, "cannot be opened", errno);
  if (fd < 0) return -1;
  if (fstat(fd, status) != 0)
    fail_io(error, path, "cannot be read", errno);
  else if (S_ISREG(status->st_mode) || (pipes && is_nameless_pipe(fd, status->st_mode)))
    return fd;
  else
    abbe_error_set(error, ABBE_IO, "%s: is %s", path, kind_of(status->st_mode));
  close(fd);
  return -1;
}

abbe_result abbe_file_open(const char *path, FILE **stream, size_t *size, abbe_error *error) {
  struct stat status;
  *stream = NULL;
  const int fd = open_to_read(path, false, &status, error);
  if (fd < 0) return ABBE_IO;
  *stream = fdopen(fd, "rb");
  if (*stream == NULL) {
    const int number = errno;
    close(fd);
    if (number == ENOMEM)
      return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to open it", path);
    return fail_io(error, path, "cannot be opened", number);
  }
  if (size != NULL) *size = (size_t)status.st_size;
  return ABBE_OK;
}

/* ---- reading ---- */

/* Whether something came, or the end, before the patience of a pipe's reader. */
static bool waited(int fd) {
  struct pollfd one = {.fd = fd, .events = POLLIN};
  int ready;
  do ready = poll(&one, 1, 1000 * ABBE_FILE_PATIENCE_SECONDS);
  while (ready < 0 && errno == EINTR);
  return ready > 0;
}

/* Grows the buffer as bytes arrive, so that pipes and files whose size lies are read too. */
static abbe_result read_all(int fd, const char *path, size_t max_size, size_t hint, char **data,
                            size_t *size, abbe_error *error) {
  size_t capacity = hint + 1, used = 0;
  char *bytes = malloc(capacity + 1);
  if (bytes == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to read it", path);
  for (;;) {
    ssize_t got = read(fd, bytes + used, capacity - used);
    if (got < 0 && (errno == EINTR || (errno == EAGAIN && waited(fd)))) continue;
    if (got < 0) {
      int number = errno;
      free(bytes);
      if (number == EAGAIN)
        return abbe_error_set(error, ABBE_IO, "%s: nothing has come through this pipe for %d s",
                              path, ABBE_FILE_PATIENCE_SECONDS);
      return fail_io(error, path, "cannot be read", number);
    }
    if (got == 0) break;
    used += (size_t)got;
    if (used > max_size) {
      free(bytes);
      return abbe_error_set(error, ABBE_IO, "%s: is longer than the %zu bytes allowed here", path,
                            max_size);
    }
    if (used < capacity) continue;
    capacity = capacity > max_size / 2 ? max_size + 1 : 2 * capacity;
    char *grown = realloc(bytes, capacity + 1);
    if (grown == NULL) {
      free(bytes);
      return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to read it", path);
    }
    bytes = grown;
  }
  bytes[used] = '\0';
  *data = bytes;
  *size = used;
  return ABBE_OK;
}

static const size_t largest = SIZE_MAX - 2;
static const size_t first_guess = 4096;

abbe_result abbe_file_read(const char *path, size_t max_size, char **data, size_t *size,
                           abbe_error *error) {
  if (max_size > largest) max_size = largest;
  struct stat status;
  const int fd = open_to_read(path, true, &status, error);
  if (fd < 0) return ABBE_IO;
  abbe_result result = ABBE_OK;
  if ((uintmax_t)status.st_size > max_size)
    result = abbe_error_set(error, ABBE_IO, "%s: is %ju bytes long; at most %zu are allowed here",
                            path, (uintmax_t)status.st_size, max_size);
  if (result == ABBE_OK) {
    size_t hint = S_ISREG(status.st_mode) ? (size_t)status.st_size : first_guess;
    if (hint > max_size) hint = max_size;
    result = read_all(fd, path, max_size, hint, data, size, error);
  }
  close(fd);
  return result;
}

abbe_result abbe_file_read_text(const char *path, size_t max_size, char **data, size_t *size,
                                abbe_error *error) {
  ABBE_TRY(abbe_file_read(path, max_size, data, size, error));
  if (!abbe_encoding_is_binary(*data, *size)) return ABBE_OK;
  free(*data);
  *data = NULL;
  *size = 0;
  return abbe_error_set(
      error, ABBE_PARSE,
      "%s: is not a text file; a spreadsheet can be saved as CSV, an archive must "
      "be unpacked first",
      path);
}

abbe_result abbe_file_read_input(size_t max_size, char **data, size_t *size, abbe_error *error) {
  if (max_size > largest) max_size = largest;
  return read_all(STDIN_FILENO, "standard input", max_size,
                  first_guess < max_size ? first_guess : max_size, data, size, error);
}

/* ---- writing ---- */

static char *copy_text(const char *text, size_t length) {
  char *copy = malloc(length + 1);
  if (copy == NULL) return NULL;
  memcpy(copy, text, length);
  copy[length] = '\0';
  return copy;
}

/* The file that is to be replaced: what a link points to, not the link. */
static abbe_result resolve(const char *path, char **target, struct stat *status, bool *exists,
                           abbe_error *error) {
  *exists = lstat(path, status) == 0;
  if (*exists && S_ISLNK(status->st_mode)) {
    *target = realpath(path, NULL);
    if (*target == NULL) return fail_io(error, path, "is a link that leads nowhere", errno);
    if (stat(*target, status) != 0) return fail_io(error, path, "cannot be written", errno);
  } else {
    *target = copy_text(path, strlen(path));
  }
  if (*target == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to write it", path);
  if (*exists && S_ISDIR(status->st_mode))
    return abbe_error_set(error, ABBE_IO, "%s: is a directory; name a file", path);
  if (*exists && !S_ISREG(status->st_mode))
    return abbe_error_set(error, ABBE_IO, "%s: is not a regular file, so it is not replaced", path);
  if (*exists && access(*target, W_OK) != 0)
    return fail_io(error, path, "cannot be written", errno);
  return ABBE_OK;
}

static size_t folder_length(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash == NULL ? 0 : (size_t)(slash - path) + 1;
}

/* A file without a name, of which a kill leaves nothing; -1 where the file system has none. A name
 * is given to it through /proc. */
static int open_unnamed(const char *target) {
  size_t length = folder_length(target);
  char *folder = length == 0 ? copy_text(".", 1) : copy_text(target, length), link[64];
  if (folder == NULL) return -1;
  int fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  free(folder);
  if (fd < 0) return -1;
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  if (access(link, F_OK) == 0) return fd;
  close(fd);
  return -1;
}

/* A name in the target's folder that no file has, made by `take`, which is -1 with EEXIST where one
 * has it. The name does not grow with the target's, which may be as long as names can be. */
static int name_beside(const char *target, char **temporary, int (*take)(const char *name, int fd),
                       int fd) {
  static atomic_uint counter;
  size_t folder = folder_length(target), size = folder + 64;
  *temporary = malloc(size);
  if (*temporary == NULL) return -1;
  memcpy(*temporary, target, folder);
  int taken = -1;
  for (int tries = 0; tries < 1000; tries++) {
    snprintf(*temporary + folder, size - folder, ".abbe-%ld-%u.part", (long)getpid(),
             atomic_fetch_add(&counter, 1));
    taken = take(*temporary, fd);
    if (taken >= 0 || errno != EEXIST) break;
  }
  if (taken >= 0) return taken;
  int number = errno;
  free(*temporary);
  *temporary = NULL;
  errno = number;
  return -1;
}

/* mkstemp would make it private to its owner, whatever the umask says. */
static int take_by_opening(const char *name, int fd) {
  (void)fd;
  return open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

static int take_by_linking(const char *name, int fd) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  return linkat(AT_FDCWD, link, AT_FDCWD, name, AT_SYMLINK_FOLLOW);
}

static void writer_clear(abbe_file_writer *writer) {
  free(writer->path);
  free(writer->temporary);
  *writer = (abbe_file_writer){0};
}

abbe_result abbe_file_writer_open(abbe_file_writer *writer, const char *path, abbe_error *error) {
  *writer = (abbe_file_writer){0};
  struct stat status;
  bool exists = false;
  abbe_result result = resolve(path, &writer->path, &status, &exists, error);
  if (result != ABBE_OK) {
    writer_clear(writer);
    return result;
  }
  int fd = open_unnamed(writer->path);
  if (fd < 0) fd = name_beside(writer->path, &writer->temporary, take_by_opening, -1);
  if (fd < 0) {
    int number = errno;
    writer_clear(writer);
    return fail_io(error, path,
                   number == ENOENT
                       ? "cannot be written, for its folder is not there; make it first"
                       : "cannot be written",
                   number);
  }
  if (exists) (void)!fchmod(fd, status.st_mode & 0777); /* refused by some file systems: no harm */
  writer->stream = fdopen(fd, "w+b");
  if (writer->stream == NULL) {
    int number = errno;
    close(fd);
    if (writer->temporary != NULL) unlink(writer->temporary);
    writer_clear(writer);
    return fail_io(error, path, "cannot be written", number);
  }
  return ABBE_OK;
}

/* The rename itself reaches the disk with its folder. A folder that cannot be synced (some
 * network file systems) still holds a whole file. */
static void sync_folder(const char *path) {
  size_t length = folder_length(path);
  char *folder = length == 0 ? copy_text(".", 1) : copy_text(path, length);
  if (folder == NULL) return;
  int fd = open(folder, O_RDONLY | O_CLOEXEC);
  if (fd >= 0) {
    fsync(fd);
    close(fd);
  }
  free(folder);
}

/* Why an earlier write failed: the stream knows only that one did, but the next one fails alike. */
static int write_trouble(FILE *stream) {
  int fd = fileno(stream);
  if (lseek(fd, 0, SEEK_END) >= 0 && write(fd, "", 1) < 0) return errno;
  return EIO;
}

/* 0, or the number of the error that kept the bytes from the disk or the file from its name. */
static int finish_stream(abbe_file_writer *writer) {
  FILE *stream = writer->stream;
  int number = 0;
  if (fflush(stream) != 0)
    number = errno;
  else if (ferror(stream))
    number = write_trouble(stream);
  else if (fsync(fileno(stream)) != 0 && errno != EINVAL && errno != EROFS)
    number = errno;
  else if (writer->temporary == NULL &&
           name_beside(writer->path, &writer->temporary, take_by_linking, fileno(stream)) < 0)
    number = errno;
  if (fclose(stream) != 0 && number == 0) number = errno;
  return number;
}

abbe_result abbe_file_writer_commit(abbe_file_writer *writer, abbe_error *error) {
  if (writer->stream == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no open file to commit");
  int number = finish_stream(writer);
  if (number == 0 && rename(writer->temporary, writer->path) != 0) number = errno;
  abbe_result result = ABBE_OK;
  if (number == 0) {
    sync_folder(writer->path);
  } else {
    if (writer->temporary != NULL) unlink(writer->temporary);
    result = fail_io(error, writer->path, "could not be written and is as it was", number);
  }
  writer_clear(writer);
  return result;
}

void abbe_file_writer_discard(abbe_file_writer *writer) {
  if (writer == NULL) return;
  if (writer->stream != NULL) {
    fclose(writer->stream);
    if (writer->temporary != NULL) unlink(writer->temporary);
  }
  writer_clear(writer);
}

abbe_result abbe_file_writer_end(abbe_file_writer *writer, abbe_result result, abbe_error *error) {
  if (result == ABBE_OK || (writer->stream != NULL && ferror(writer->stream)))
    return abbe_file_writer_commit(writer, error);
  abbe_file_writer_discard(writer);
  return result;
}

abbe_result abbe_file_write(const char *path, const void *data, size_t size, abbe_error *error) {
  abbe_file_writer writer;
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  if (size > 0) fwrite(data, 1, size, writer.stream); /* a short write shows in ferror */
  return abbe_file_writer_commit(&writer, error);
}
