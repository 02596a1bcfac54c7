/* Meshes from files through assimp's C interface. */
#include "scenes/mesh.h"
#include "scenes/topology.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define MAX_FILE_BYTES ((off_t)1 << 30)

/* assimp allocates what a PLY header announces, and looks for its end forever: each element must at
 * least have a byte in the file, and every line be one that the format knows. */
static abbe_result check_ply_line(const char *path, const char *line, int number, off_t size,
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
  if (sscanf(line, "element %63s %20llu", name, &count) == 2 && count > (unsigned long long)size)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: line %d announces %llu elements '%s', more than the %lld bytes "
                          "of the file can hold",
                          path, number, count, name, (long long)size);
  return ABBE_OK;
}

static abbe_result check_ply_header(const char *path, off_t size, abbe_error *error) {
  FILE *file = fopen(path, "rb");
  if (!file)
    return abbe_error_set(error, ABBE_IO, "%s: the mesh file cannot be opened: %s", path,
                          strerror(errno));
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
  fclose(file);
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
  struct stat status;
  if (stat(path, &status) != 0 || !S_ISREG(status.st_mode))
    return abbe_error_set(error, ABBE_IO, "%s: there is no such mesh file", path);
  if (status.st_size > MAX_FILE_BYTES)
    return abbe_error_set(error, ABBE_IO, "%s: the mesh file has %lld bytes, the limit is %lld",
                          path, (long long)status.st_size, (long long)MAX_FILE_BYTES);
  if (strcasecmp(dot, ".ply") == 0) return check_ply_header(path, status.st_size, error);
  return ABBE_OK;
}

static const struct aiScene *import(const char *path) {
  struct aiPropertyStore *store = aiCreatePropertyStore();
  if (!store) return NULL;
  aiSetImportPropertyInteger(store, AI_CONFIG_PP_SBP_REMOVE,
                             aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  aiSetImportPropertyInteger(store, AI_CONFIG_PP_RVC_FLAGS,
                             aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                 aiComponent_COLORS | aiComponent_BONEWEIGHTS |
                                 aiComponent_ANIMATIONS | aiComponent_TEXTURES |
                                 aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  /* assimp joins vertices nearer than 1e-5 units, too coarse for small stones; they are joined
   * here, relative to the mesh's size */
  const struct aiScene *scene = aiImportFileExWithProperties(
      path,
      aiProcess_ValidateDataStructure | aiProcess_RemoveComponent | aiProcess_Triangulate |
          aiProcess_PreTransformVertices | aiProcess_SortByPType,
      NULL, store);
  aiReleasePropertyStore(store);
  return scene;
}

static bool usable(const struct aiMesh *part) {
  return part && part->mVertices && part->mFaces &&
         (part->mPrimitiveTypes & (unsigned)aiPrimitiveType_TRIANGLE);
}

static abbe_result copy_part(const struct aiMesh *part, const char *path, size_t first_vertex,
                             size_t *face_count, abbe_mesh *out, abbe_error *error) {
  for (size_t v = 0; v < part->mNumVertices; v++) {
    const double p[3] = {part->mVertices[v].x, part->mVertices[v].y, part->mVertices[v].z};
    if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "%s: vertex %zu is at (%g, %g, %g); coordinates must be finite", path,
                            v, p[0], p[1], p[2]);
    memcpy(out->position[first_vertex + v], p, sizeof p);
    if (!out->uv || !part->mTextureCoords[0]) continue;
    const double uv[2] = {part->mTextureCoords[0][v].x, part->mTextureCoords[0][v].y};
    if (isfinite(uv[0]) && isfinite(uv[1])) memcpy(out->uv[first_vertex + v], uv, sizeof uv);
  }
  for (size_t f = 0; f < part->mNumFaces; f++) {
    const struct aiFace *face = &part->mFaces[f];
    if (face->mNumIndices != 3) continue;
    for (int k = 0; k < 3; k++) {
      if (face->mIndices[k] >= part->mNumVertices)
        return abbe_error_set(error, ABBE_GEOMETRY, "%s: face %zu names vertex %u of %u", path, f,
                              face->mIndices[k], part->mNumVertices);
      out->face[*face_count][k] = (uint32_t)(first_vertex + face->mIndices[k]);
    }
    ++*face_count;
  }
  return ABBE_OK;
}

static abbe_result copy_scene(const struct aiScene *scene, const char *path, abbe_mesh *out,
                              abbe_error *error) {
  size_t vertices = 0, faces = 0;
  bool with_uv = false;
  for (unsigned m = 0; m < scene->mNumMeshes; m++) {
    const struct aiMesh *part = scene->mMeshes[m];
    if (!usable(part)) continue;
    vertices += part->mNumVertices;
    with_uv = with_uv || part->mTextureCoords[0];
    for (unsigned f = 0; f < part->mNumFaces; f++) faces += part->mFaces[f].mNumIndices == 3;
  }
  if (vertices == 0 || faces == 0)
    return abbe_error_set(error, ABBE_GEOMETRY, "%s: the file has no triangles", path);
  abbe_result result = abbe_mesh_make(vertices, faces, with_uv, out, error);
  size_t first_vertex = 0, face_count = 0;
  for (unsigned m = 0; result == ABBE_OK && m < scene->mNumMeshes; m++) {
    const struct aiMesh *part = scene->mMeshes[m];
    if (!usable(part)) continue;
    result = copy_part(part, path, first_vertex, &face_count, out, error);
    first_vertex += part->mNumVertices;
  }
  if (result != ABBE_OK) abbe_mesh_free(out);
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
  if (result != ABBE_OK) return result;
  const struct aiScene *scene = import(path);
  if (!scene)
    return abbe_error_set(error, ABBE_PARSE, "%s: the mesh cannot be read: %s", path,
                          aiGetErrorString());
  result = copy_scene(scene, path, out, error);
  aiReleaseImport(scene);
  if (result == ABBE_OK) result = join_vertices(out, error);
  if (result == ABBE_OK) result = abbe_mesh_compute_normals(out, smooth, error);
  if (result != ABBE_OK) abbe_mesh_free(out);
  return result;
}
