/* mesh_files.h: the files that assimp opens while it reads a mesh.
 *
 * Regular files alone, and what a process may take of memory and time grows with each, so that a
 * glTF is served by the size of its buffers and not of its own few lines. It serves the process
 * that mesh_import.h makes, whose limits it raises, and is no file system for anybody else.
 * Internal to scenes/.
 */
#ifndef ABBE_SCENES_IMPORT_MESH_FILES_H
#define ABBE_SCENES_IMPORT_MESH_FILES_H

#include "base/error.h"

#include <assimp/cfileio.h>
#include <stddef.h>
#include <sys/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of all files of a mesh together, bytes. */
#define ABBE_MESH_FILES_MOST ((size_t)1 << 30)
/* Processor time that the process may take, s, and a second more for so many bytes. */
#define ABBE_MESH_FILES_SECONDS 2
#define ABBE_MESH_FILES_BYTES_A_SECOND ((size_t)1 << 18)
/* Memory that it may grow by, bytes, and so many times the bytes of its files. */
#define ABBE_MESH_FILES_MEMORY ((size_t)1 << 28)
#define ABBE_MESH_FILES_MEMORY_A_BYTE 64
/* Time on the wall that it may take, s: of a hang, not of a machine that is busy. */
#define ABBE_MESH_FILES_WALL 60
#define ABBE_MESH_FILES_WALL_A_SECOND 20

enum { ABBE_MESH_FILES_KNOWN = 64, ABBE_MESH_FILES_NAMES = 8192 };

typedef struct abbe_mesh_files {
  struct aiFileIO io; /* for assimp; the rest is this file's own */
  size_t held, bytes; /* memory that the process had, and bytes of the files that it opened */
  size_t count;       /* files that are known, each counted once */
  struct {
    dev_t device;
    ino_t number;
  } known[ABBE_MESH_FILES_KNOWN];
  char others[ABBE_MESH_FILES_NAMES]; /* paths of all but the first, as far as there is room: each
                                         ends with a zero, an empty one is behind the last */
  size_t used;                        /* of them, bytes */
  abbe_error error; /* why a file that is there was refused last; an empty text: none was */
} abbe_mesh_files;

/* Sets the process's limits to those without any file. */
void abbe_mesh_files_begin(abbe_mesh_files *files);

#ifdef __cplusplus
}
#endif
#endif
