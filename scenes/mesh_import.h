/* mesh_import.h: the triangles of a mesh file, read by assimp in a process of its own.
 *
 * assimp stops the program, or never returns, on some files that are not well formed. Here that
 * ends a child process, and the caller gets a sentence. Does not join vertices and computes no
 * normals: see mesh.h.
 */
#ifndef ABBE_SCENES_MESH_IMPORT_H
#define ABBE_SCENES_MESH_IMPORT_H

#include "scenes/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads path, of `bytes` bytes: all meshes in it as one, positions as in the file (its own unit),
 * uv where a mesh has them, normals zero. Forks, and waits for the child, which may use
 * ABBE_MESH_IMPORT_SECONDS of processor time and a second more for every quarter of a MiB, and
 * 256 MiB of memory and 64 times the file's size.
 * ABBE_PARSE with assimp's reason or where the child was stopped, ABBE_GEOMETRY for coordinates
 * that are not finite, faces that name vertices that are not there, or a file without triangles,
 * ABBE_IO where no process can be had, ABBE_NO_MEMORY. */
abbe_result abbe_mesh_import(const char *path, size_t bytes, abbe_mesh *out, abbe_error *error);

#define ABBE_MESH_IMPORT_SECONDS 2

#ifdef __cplusplus
}
#endif
#endif
