/* Meshes from files. */
#include "base/file.h"
#include "scenes/geometry/vector.h"
#include "scenes/import/mesh_files.h"
#include "scenes/import/mesh_import.h"
#include "scenes/mesh/ply_strips.h"
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/topology.h"

#include <stdio.h>
#include <stdlib.h>
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

static abbe_result check_ply_header(const char *path, FILE *file, size_t size, bool *strips,
                                    abbe_error *error) {
  char line[512] = "";
  abbe_result result = ABBE_OK;
  bool ended = false;
  for (int i = 1; i <= 256 && result == ABBE_OK && !ended && fgets(line, sizeof line, file); i++) {
    result = check_ply_line(path, line, i, size, error);
    ended = strncmp(line, "end_header", 10) == 0;
    *strips = *strips || strncmp(line, "element tristrips", 17) == 0;
  }
  if (result == ABBE_OK && !ended)
    result = abbe_error_set(error, ABBE_PARSE,
                            "%s: the PLY header has no end_header in its first 256 lines", path);
  return result;
}

static abbe_result check_file(const char *path, bool *strips, abbe_error *error) {
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
  if (size > ABBE_MESH_FILES_MOST)
    result = abbe_error_set(error, ABBE_IO, "%s: the mesh file has %zu bytes, the limit is %zu",
                            path, size, ABBE_MESH_FILES_MOST);
  else if (strcasecmp(dot, ".ply") == 0)
    result = check_ply_header(path, file, size, strips, error);
  fclose(file);
  return result;
}

/* One vertex a point, in the file's order. */
static abbe_result join_points(abbe_mesh *mesh, const abbe_topology *t, abbe_error *error) {
  abbe_mesh joined;
  const abbe_result result = abbe_mesh_make(t->point_count, t->face_count, false, &joined, error);
  if (result != ABBE_OK) return result;
  memcpy(joined.position, t->position, t->point_count * sizeof *joined.position);
  memcpy(joined.face, t->face, t->face_count * sizeof *joined.face);
  abbe_mesh_free(mesh);
  *mesh = joined;
  return abbe_mesh_drop_unused(mesh, error);
}

/* One vertex for each point, normal and texture coordinate that corners have. */
static abbe_result join_vertices(abbe_mesh *mesh, bool keep_normals, abbe_error *error) {
  abbe_topology t;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  if (!keep_normals && !mesh->uv) {
    result = join_points(mesh, &t, error);
    abbe_topology_free(&t);
    return result;
  }
  double(*corner)[3] = calloc(3 * mesh->face_count + 1, sizeof *corner);
  if (!corner) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a mesh");
  for (size_t f = 0; result == ABBE_OK && keep_normals && f < mesh->face_count; f++) {
    double n[3];
    abbe_vector_triangle(t.position[t.face[f][0]], t.position[t.face[f][1]],
                         t.position[t.face[f][2]], n);
    for (int k = 0; k < 3; k++)
      abbe_mesh_fair_normal(mesh->normal[mesh->face[f][k]], n, corner[3 * f + (size_t)k]);
  }
  mesh->given_normals = keep_normals;
  /* vertices of one point stand at one place from here on */
  for (size_t v = 0; result == ABBE_OK && v < mesh->vertex_count; v++)
    memcpy(mesh->position[v], t.position[t.point[v]], sizeof mesh->position[v]);
  if (result == ABBE_OK)
    result = abbe_mesh_take_normals(mesh, t.point, (const double(*)[3])corner, error);
  free(corner);
  abbe_topology_free(&t);
  return result;
}

static abbe_result read_strips(const char *path, abbe_mesh *out, abbe_error *error) {
  char *data = NULL;
  size_t size = 0;
  abbe_result result = abbe_file_read(path, ABBE_MESH_FILES_MOST, &data, &size, error);
  if (result == ABBE_OK) result = abbe_ply_read_strips(data, size, path, out, error);
  free(data);
  return result;
}

abbe_result abbe_mesh_load(const char *path, abbe_mesh_normals normals, abbe_mesh *out,
                           char **others, abbe_error *error) {
  return abbe_mesh_load_part(path, NULL, normals, out, others, error);
}

abbe_result abbe_mesh_load_part(const char *path, const char *material, abbe_mesh_normals normals,
                                abbe_mesh *out, char **others, abbe_error *error) {
  ABBE_REQUIRE(path && out, error);
  bool strips = false;
  char *named = NULL;
  memset(out, 0, sizeof *out);
  abbe_result result = check_file(path, &strips, error);
  if (result == ABBE_OK)
    result = strips ? read_strips(path, out, error)
                    : abbe_mesh_import(path, material, out, &named, error);
  const bool facets = strcasecmp(strrchr(path, '.') ? strrchr(path, '.') : "", ".stl") == 0;
  const bool keep = normals == ABBE_NORMALS_AUTO && out->given_normals && !facets;
  if (result == ABBE_OK) result = join_vertices(out, keep, error);
  if (result == ABBE_OK && !keep) result = abbe_mesh_compute_normals(out, normals, error);
  if (result != ABBE_OK) abbe_mesh_free(out);
  if (result != ABBE_OK || !others) {
    free(named);
    named = NULL;
  }
  if (others) *others = named;
  return result;
}
