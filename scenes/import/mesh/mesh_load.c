/* Meshes from files. */
#include "base/file.h"
#include "base/maths.h"
#include "scenes/import/mesh/gltf_data.h"
#include "scenes/import/mesh/mesh_reading.h"
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/topology.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* One vertex a point, in the file's order. */
static abbe_result join_points(abbe_mesh *mesh, const abbe_topology *t, abbe_error *error) {
  abbe_mesh joined;
  ABBE_TRY(abbe_mesh_make(t->point_count, t->face_count, false, &joined, error));
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

typedef abbe_result reader(abbe_mesh_reading *r, const char *data, size_t size, abbe_error *error);

static reader *reader_of(const char *path) {
  static const struct {
    const char *ending;
    reader *read;
  } known[] = {{".obj", abbe_obj_read},
               {".ply", abbe_ply_read},
               {".stl", abbe_stl_read},
               {".gltf", abbe_gltf_read},
               {".glb", abbe_gltf_read}};
  const char *dot = strrchr(path, '.');
  for (size_t i = 0; dot && i < sizeof known / sizeof *known; i++)
    if (strcasecmp(dot, known[i].ending) == 0) return known[i].read;
  return NULL;
}

/* *others: the reading's, ended by an empty one. */
static abbe_result take_others(abbe_mesh_reading *r, char **others, abbe_error *error) {
  if (others == NULL || r->others.count == 0) return ABBE_OK;
  if (!abbe_mesh_list_add(&r->others, 1, 1, "")) return abbe_mesh_reading_no_memory(r, error);
  *others = r->others.item;
  r->others = (abbe_mesh_list){0};
  return ABBE_OK;
}

static abbe_result read_file(const char *path, const char *material, abbe_mesh *out, char **others,
                             abbe_error *error) {
  ABBE_OWNED(abbe_mesh_reading, r) = {.path = path, .material = material};
  reader *read = reader_of(path);
  ABBE_FREED char *data = NULL;
  size_t size = 0;
  if (read == NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: meshes are read from .obj, .ply, .stl, .gltf and .glb files", path);
  ABBE_TRY(abbe_file_read(path, ABBE_MESH_FILES_MOST, &data, &size, error));
  ABBE_TRY(read(&r, data, size, error));
  ABBE_TRY(abbe_mesh_reading_finish(&r, out, error));
  return take_others(&r, others, error);
}

abbe_result abbe_mesh_load(const char *path, abbe_mesh_normals normals, abbe_mesh *out,
                           char **others, abbe_error *error) {
  return abbe_mesh_load_part(path, NULL, normals, out, others, error);
}

abbe_result abbe_mesh_load_part(const char *path, const char *material, abbe_mesh_normals normals,
                                abbe_mesh *out, char **others, abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (others) *others = NULL;
  abbe_result result = read_file(path, material, out, others, error);
  const bool keep = normals == ABBE_NORMALS_AUTO && out->given_normals;
  if (result == ABBE_OK) result = join_vertices(out, keep, error);
  if (result == ABBE_OK && !keep) result = abbe_mesh_compute_normals(out, normals, error);
  if (result == ABBE_OK) return ABBE_OK;
  abbe_mesh_free(out);
  if (others) {
    free(*others);
    *others = NULL;
  }
  return result;
}
