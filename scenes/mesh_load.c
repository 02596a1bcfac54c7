/* Meshes from files. */
#include "scenes/import_files.h"
#include "scenes/mesh.h"
#include "scenes/mesh_import.h"
#include "scenes/topology.h"
#include "spectral/file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* assimp allocates what a PLY header announces, and looks for its end forever: each element must at
 * least have a byte in the file, and every line be one that the format knows. */
static abbe_result check_ply_line(const char *path, const char *line, int number, size_t size,
                                  abbe_error *error) {
  static const char *const known[] = {"ply",      "format ",   "comment",   "obj_info",
                                      "element ", "property ", "end_header"};
  char name[64];
  unsigned long long count = 0;
  bool ok = false;
  for (size_t i = number == 1 ? 0 : 1; i < (number == 1 ? 1 : sizeof known / sizeof *known); i++)
    ok = ok || strncmp(line, known[i], strlen(known[i])) == 0;
  if (!ok)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: line %d is none of a PLY header; it begins with 'ply', then lines "
                          "of format, comment, obj_info, element or property, and end_header",
                          path, number);
  if (sscanf(line, "element %63s %20llu", name, &count) == 2 && count > size)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: line %d announces %llu elements '%s', more than the %zu bytes "
                          "of the file can hold",
                          path, number, count, name, size);
  return ABBE_OK;
}

static abbe_result check_ply_header(const char *path, FILE *file, size_t size, abbe_error *error) {
  char line[512] = "";
  abbe_result result = ABBE_OK;
  bool ended = false;
  for (int i = 1; i <= 256 && result == ABBE_OK && !ended && fgets(line, sizeof line, file); i++) {
    result = check_ply_line(path, line, i, size, error);
    ended = strncmp(line, "end_header", 10) == 0;
  }
  if (result == ABBE_OK && !ended)
    result = abbe_error_set(error, ABBE_PARSE,
                            "%s: the PLY header has no end_header in its first 256 lines", path);
  return result;
}

static abbe_result check_file(const char *path, abbe_error *error) {
  static const char *const known[] = {".obj", ".ply", ".stl", ".gltf", ".glb"};
  const char *dot = strrchr(path, '.');
  bool ok = false;
  for (size_t i = 0; dot && i < sizeof known / sizeof *known; i++)
    ok = ok || strcasecmp(dot, known[i]) == 0;
  if (!ok)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: meshes are read from .obj, .ply, .stl, .gltf and .glb files", path);
  FILE *file;
  size_t size = 0;
  abbe_result result = abbe_file_open(path, &file, &size, error);
  if (result != ABBE_OK) return result;
  if (size > ABBE_IMPORT_FILES_MOST)
    result = abbe_error_set(error, ABBE_IO, "%s: the mesh file has %zu bytes, the limit is %zu",
                            path, size, ABBE_IMPORT_FILES_MOST);
  else if (strcasecmp(dot, ".ply") == 0)
    result = check_ply_header(path, file, size, error);
  fclose(file);
  return result;
}

/* One vertex a point, where no texture coordinates keep them apart. */
static abbe_result join_vertices(abbe_mesh *mesh, abbe_error *error) {
  if (mesh->uv) return ABBE_OK;
  abbe_topology t;
  abbe_mesh joined;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  result = abbe_mesh_make(t.point_count, t.face_count, false, &joined, error);
  if (result == ABBE_OK) {
    memcpy(joined.position, t.position, t.point_count * sizeof *joined.position);
    memcpy(joined.face, t.face, t.face_count * sizeof *joined.face);
    abbe_mesh_free(mesh);
    *mesh = joined;
  }
  abbe_topology_free(&t);
  return result;
}

abbe_result abbe_mesh_load(const char *path, bool smooth, abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  abbe_result result = check_file(path, error);
  if (result == ABBE_OK) result = abbe_mesh_import(path, out, error);
  if (result == ABBE_OK) result = join_vertices(out, error);
  if (result == ABBE_OK) result = abbe_mesh_compute_normals(out, smooth, error);
  if (result != ABBE_OK) abbe_mesh_free(out);
  return result;
}
