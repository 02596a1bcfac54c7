#include "scenes/import/mesh_files.h"

#include "base/file.h"

#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* What the process holds now; 0: it is not known, and its memory is not limited. */
static size_t memory_held(void) {
  char text[32] = "";
  const int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (fd < 0) return 0;
  const ssize_t got = read(fd, text, sizeof text - 1);
  close(fd);
  return got > 0 ? strtoul(text, NULL, 10) * (size_t)sysconf(_SC_PAGESIZE) : 0;
}

static void set_limit(int which, rlim_t soft) {
  struct rlimit limit;
  if (getrlimit(which, &limit) != 0) return;
  limit.rlim_cur = soft < limit.rlim_max ? soft : limit.rlim_max;
  setrlimit(which, &limit);
}

static void set_limits(const abbe_mesh_files *files) {
  const rlim_t seconds = ABBE_MESH_FILES_SECONDS + files->bytes / ABBE_MESH_FILES_BYTES_A_SECOND;
  if (files->held > 0)
    set_limit(RLIMIT_AS,
              files->held + ABBE_MESH_FILES_MEMORY + ABBE_MESH_FILES_MEMORY_A_BYTE * files->bytes);
  set_limit(RLIMIT_CPU, seconds);
  alarm((unsigned)(ABBE_MESH_FILES_WALL + ABBE_MESH_FILES_WALL_A_SECOND * seconds));
}

static void note_other(abbe_mesh_files *files, const char *path) {
  const size_t size = strlen(path) + 1;
  if (size >= sizeof files->others - files->used) return;
  memcpy(files->others + files->used, path, size);
  files->used += size;
}

/* Counts a file that is new; false where there are too many bytes. What is opened after as many
 * files as are known brings no more room. */
static bool count(abbe_mesh_files *files, FILE *stream, const char *path, size_t size) {
  struct stat status;
  if (fstat(fileno(stream), &status) != 0) return false;
  for (size_t i = 0; i < files->count; i++)
    if (files->known[i].device == status.st_dev && files->known[i].number == status.st_ino)
      return true;
  if (files->count == ABBE_MESH_FILES_KNOWN) return true;
  if (size > ABBE_MESH_FILES_MOST - files->bytes) {
    abbe_error_set(&files->error, ABBE_IO,
                   "%s: the files of the mesh have %zu bytes with it, the limit is %zu", path,
                   files->bytes + size, ABBE_MESH_FILES_MOST);
    return false;
  }
  files->known[files->count].device = status.st_dev;
  files->known[files->count++].number = status.st_ino;
  if (files->count > 1) note_other(files, path);
  files->bytes += size;
  set_limits(files);
  return true;
}

/* ---- what assimp calls ---- */

static FILE *stream_of(struct aiFile *file) {
  return (FILE *)(void *)file->UserData;
}

static size_t read_stream(struct aiFile *file, char *to, size_t size, size_t number) {
  return fread(to, size, number, stream_of(file));
}

static size_t write_nothing(struct aiFile *file, const char *from, size_t size, size_t number) {
  (void)file, (void)from, (void)size, (void)number;
  return 0;
}

static size_t tell(struct aiFile *file) {
  const long at = ftell(stream_of(file));
  return at > 0 ? (size_t)at : 0;
}

static size_t size_of(struct aiFile *file) {
  struct stat status;
  return fstat(fileno(stream_of(file)), &status) == 0 ? (size_t)status.st_size : 0;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin from) {
  const int whence = from == aiOrigin_SET ? SEEK_SET : from == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
  return fseek(stream_of(file), (long)offset, whence) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static void flush(struct aiFile *file) {
  (void)file;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode) {
  abbe_mesh_files *files = (abbe_mesh_files *)(void *)io->UserData;
  FILE *stream = NULL;
  size_t size = 0;
  if (mode[0] != 'r' || access(path, F_OK) != 0) return NULL;
  if (abbe_file_open(path, &stream, &size, &files->error) != ABBE_OK) return NULL;
  struct aiFile *file = count(files, stream, path, size) ? malloc(sizeof *file) : NULL;
  if (file == NULL) {
    if (files->error.text[0] == '\0')
      abbe_error_set(&files->error, ABBE_NO_MEMORY, "%s: no memory to open it", path);
    fclose(stream);
    return NULL;
  }
  *file = (struct aiFile){.ReadProc = read_stream,
                          .WriteProc = write_nothing,
                          .TellProc = tell,
                          .FileSizeProc = size_of,
                          .SeekProc = seek,
                          .FlushProc = flush,
                          .UserData = (aiUserData)(void *)stream};
  return file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file) {
  (void)io;
  if (file == NULL) return;
  fclose(stream_of(file));
  free(file);
}

void abbe_mesh_files_begin(abbe_mesh_files *files) {
  memset(files, 0, sizeof *files);
  files->io = (struct aiFileIO){
      .OpenProc = open_file, .CloseProc = close_file, .UserData = (aiUserData)(void *)files};
  files->held = memory_held();
  set_limits(files);
}
