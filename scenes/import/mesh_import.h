/* mesh_import.h: the triangles of a mesh file, read by assimp in a process of its own.
 *
 * assimp stops the program, or never returns, on some files that are not well formed. Here that
 * ends a child process, and the caller gets a sentence. Does not join vertices and computes no
 * normals: see mesh.h.
 */
#ifndef ABBE_SCENES_IMPORT_MESH_IMPORT_H
#define ABBE_SCENES_IMPORT_MESH_IMPORT_H

#include "scenes/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads path and the files that it names: all meshes in it as one, positions as in the file (its
 * own unit), uv where a mesh has them, normals where all have them (given_normals), else zero: of
 * any length, and zero where they are not finite. Forks, and waits for the child, which dies
 * with its caller and has the limits of mesh_files.h. ABBE_PARSE with assimp's reason or where
 * the child was stopped, ABBE_GEOMETRY for coordinates that are not finite, faces that name
 * vertices that are not there, or a file without triangles, ABBE_IO where no process can be had,
 * ABBE_NO_MEMORY. material: only triangles of the material of that name in the file; NULL: all.
 * *others is as in abbe_mesh_load. */
abbe_result abbe_mesh_import(const char *path, const char *material, abbe_mesh *out, char **others,
                             abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
