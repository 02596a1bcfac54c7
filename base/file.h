/* file.h: whole files in, and files out that are never half written.
 *
 * A file is opened without waiting, and read only where it is a regular one: a pipe with a name, a
 * device or a socket may have no end, or nobody at its other end. Every reader of a file that a
 * user names opens it here. Reading checks the size against a limit before it allocates. Writing
 * goes to a temporary file beside the target which is renamed over it on commit: a kill at any
 * moment leaves the old file or the new one, and where the file system has files without names
 * (O_TMPFILE) nothing besides. It does not stream, lock or watch files.
 */
#ifndef ABBE_BASE_FILE_H
#define ABBE_BASE_FILE_H

#include "base/error.h"

#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What comes after the path's last slash. */
const char *abbe_file_name(const char *path);

/* Opens a regular file to be read (binary); the caller closes *stream. *size (may be NULL): its
 * bytes. ABBE_IO if it is missing, unreadable or of another kind, which is named, ABBE_NO_MEMORY.
 */
abbe_result abbe_file_open(const char *path, FILE **stream, size_t *size, abbe_error *error);

#define ABBE_FILE_PATIENCE_SECONDS 60

/* Reads the file at path whole into *data (malloc'd, one zero byte past its end that *size does
 * not count; the caller frees). A pipe without a name, such as a shell's <(…), is read as well, as
 * long as something comes every ABBE_FILE_PATIENCE_SECONDS. Fails with ABBE_IO if it is missing,
 * unreadable, of another kind, or longer than max_size bytes. */
abbe_result abbe_file_read(const char *path, size_t max_size, char **data, size_t *size,
                           abbe_error *error);

/* The same for text in whatever encoding (foreign_text.h): ABBE_PARSE for a file that is none, such
 * as a spreadsheet or an archive, before anything of it is quoted. */
abbe_result abbe_file_read_text(const char *path, size_t max_size, char **data, size_t *size,
                                abbe_error *error);

/* The same from standard input, of whatever kind, for which it waits. */
abbe_result abbe_file_read_input(size_t max_size, char **data, size_t *size, abbe_error *error);

/* A file being written. stream is open for writing and reading (binary); use it freely between
 * open and commit. Zero-initialise; after commit or discard it is zeroed again. */
typedef struct abbe_file_writer {
  FILE *stream;
  char *path;      /* the target */
  char *temporary; /* beside it; NULL while it has no name */
} abbe_file_writer;

/* Opens a temporary file in the target's folder. ABBE_IO where that cannot be. */
abbe_result abbe_file_writer_open(abbe_file_writer *writer, const char *path, abbe_error *error);

/* Flushes, syncs, closes and renames over the target; on failure (a full disk shows here) the
 * temporary file is removed, the target is as it was, and the result is ABBE_IO. */
abbe_result abbe_file_writer_commit(abbe_file_writer *writer, abbe_error *error);

/* Closes and removes the temporary file; the target is as it was. Safe on a zeroed writer. */
void abbe_file_writer_discard(abbe_file_writer *writer);

/* Commits what was written with `result`, which is returned; after an error the target is as it
 * was. Where the stream has failed that is what is said, by the target's name and the system's
 * reason. */
abbe_result abbe_file_writer_end(abbe_file_writer *writer, abbe_result result, abbe_error *error);

/* open + write + commit of size bytes. */
abbe_result abbe_file_write(const char *path, const void *data, size_t size, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
