#include "scenes/import/mesh_import.h"

#include "base/number.h"
#include "scenes/import/mesh_files.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* What the child sends first; positions, normals, texture coordinates and faces follow where it
 * read any. */
typedef struct header {
  char complaint[512]; /* empty: the file was read */
  size_t vertices, faces;
  bool with_uv, with_normals;
  bool no_memory; /* that is why it was not read */
  char others[ABBE_MESH_FILES_NAMES];
} header;

/* ---- the child: it allocates no copies of what was read, and writes as it goes ---- */

enum { BATCH = 256 };

static const struct aiScene *import(const char *path, bool materials, abbe_mesh_files *files) {
  struct aiPropertyStore *store = aiCreatePropertyStore();
  if (!store) return NULL;
  aiSetImportPropertyInteger(store, AI_CONFIG_PP_SBP_REMOVE,
                             aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  aiSetImportPropertyInteger(store, AI_CONFIG_PP_RVC_FLAGS,
                             aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                 aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                 aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS |
                                 (materials ? 0 : (int)aiComponent_MATERIALS));
  /* assimp joins vertices nearer than 1e-5 units, too coarse for small stones; they are joined
   * by the caller, relative to the mesh's size */
  const struct aiScene *scene = aiImportFileExWithProperties(
      path,
      aiProcess_ValidateDataStructure | aiProcess_RemoveComponent | aiProcess_Triangulate |
          aiProcess_PreTransformVertices | aiProcess_SortByPType,
      &files->io, store);
  aiReleasePropertyStore(store);
  return scene;
}

static bool is_of(const struct aiScene *scene, const struct aiMesh *mesh, const char *material) {
  struct aiString name;
  return material == NULL || (mesh->mMaterialIndex < scene->mNumMaterials &&
                              aiGetMaterialString(scene->mMaterials[mesh->mMaterialIndex],
                                                  AI_MATKEY_NAME, &name) == aiReturn_SUCCESS &&
                              strcmp(name.data, material) == 0);
}

static bool usable(const struct aiScene *scene, const struct aiMesh *part, const char *material) {
  return part && part->mVertices && part->mFaces &&
         (part->mPrimitiveTypes & (unsigned)aiPrimitiveType_TRIANGLE) &&
         is_of(scene, part, material);
}

static bool send(int fd, const void *data, size_t size) {
  for (const char *at = data; size > 0;) {
    const ssize_t sent = write(fd, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= (size_t)sent;
  }
  return true;
}

/* 3 (or, of texture coordinates, 2) numbers a vertex; zeros where the part has none. */
static bool send_vectors(int fd, const struct aiVector3D *from, size_t count, size_t width) {
  double batch[BATCH][3];
  bool ok = true;
  for (size_t v = 0; v < count && ok; v += BATCH) {
    const size_t n = count - v < BATCH ? count - v : BATCH;
    double *at = batch[0];
    for (size_t i = 0; i < n; i++, at += width) {
      at[0] = from ? from[v + i].x : 0;
      at[1] = from ? from[v + i].y : 0;
      if (width == 3) at[2] = from ? from[v + i].z : 0;
    }
    ok = send(fd, batch, n * width * sizeof(double));
  }
  return ok;
}

/* An index that the part has no vertex for is sent as UINT32_MAX, which no mesh has. */
static bool send_faces(int fd, const struct aiMesh *part, size_t first_vertex) {
  uint32_t batch[BATCH][3];
  size_t n = 0;
  bool ok = true;
  for (unsigned f = 0; f < part->mNumFaces && ok; f++) {
    const struct aiFace *face = &part->mFaces[f];
    if (face->mNumIndices != 3) continue;
    for (int k = 0; k < 3; k++)
      batch[n][k] = face->mIndices[k] < part->mNumVertices
                        ? (uint32_t)(first_vertex + face->mIndices[k])
                        : UINT32_MAX;
    if (++n < BATCH) continue;
    ok = send(fd, batch, n * sizeof *batch);
    n = 0;
  }
  return ok && send(fd, batch, n * sizeof *batch);
}

/* assimp's reason, and why a file was refused that it may have missed. */
static void complain(const abbe_mesh_files *files, header *h) {
  const char *reason = aiGetErrorString();
  snprintf(h->complaint, sizeof h->complaint, "%.250s%s%.250s",
           reason[0] != '\0' ? reason : "assimp gives no reason",
           files->error.text[0] != '\0' ? "; " : "", files->error.text);
  h->no_memory = files->error.code == ABBE_NO_MEMORY;
}

static bool send_scene(int fd, const char *path, const char *material) {
  header h;
  abbe_mesh_files files;
  memset(&h, 0, sizeof h); /* the gaps too: it is sent as it lies */
  abbe_mesh_files_begin(&files);
  const struct aiScene *scene = import(path, material != NULL, &files);
  if (!scene) complain(&files, &h);
  memcpy(h.others, files.others, sizeof h.others);
  h.with_normals = true;
  for (unsigned m = 0; scene && m < scene->mNumMeshes; m++) {
    const struct aiMesh *part = scene->mMeshes[m];
    if (!usable(scene, part, material)) continue;
    h.vertices += part->mNumVertices;
    h.with_uv = h.with_uv || part->mTextureCoords[0];
    h.with_normals = h.with_normals && part->mNormals;
    for (unsigned f = 0; f < part->mNumFaces; f++) h.faces += part->mFaces[f].mNumIndices == 3;
  }
  bool ok = send(fd, &h, sizeof h);
  for (int what = 0; what < 4 && scene; what++) {
    size_t first_vertex = 0;
    for (unsigned m = 0; ok && m < scene->mNumMeshes; m++) {
      const struct aiMesh *part = scene->mMeshes[m];
      if (!usable(scene, part, material)) continue;
      if (what == 0) ok = send_vectors(fd, part->mVertices, part->mNumVertices, 3);
      if (what == 1 && h.with_normals) ok = send_vectors(fd, part->mNormals, part->mNumVertices, 3);
      if (what == 2 && h.with_uv)
        ok = send_vectors(fd, part->mTextureCoords[0], part->mNumVertices, 2);
      if (what == 3) ok = send_faces(fd, part, first_vertex);
      first_vertex += part->mNumVertices;
    }
  }
  return ok;
}

/* Never returns. What assimp says as it stops belongs to nobody, nor do the caller's handlers. */
static void be_child(int fd, const char *path, const char *material, pid_t caller) {
  static const int signals[] = {SIGABRT, SIGSEGV, SIGBUS,  SIGFPE,
                                SIGILL,  SIGXCPU, SIGPIPE, SIGALRM};
  sigset_t all;
  sigfillset(&all);
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) signal(signals[i], SIG_DFL);
  sigprocmask(SIG_UNBLOCK, &all, NULL);
  /* nobody reads on for a caller that was killed; one that was before this was asked is no parent
   */
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != caller) _exit(1);
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
  /* a caller without standard streams may have got their numbers for the pipe */
  if (fd <= STDERR_FILENO) fd = fcntl(fd, F_DUPFD, STDERR_FILENO + 1);
  const int nothing = open("/dev/null", O_RDWR);
  if (nothing >= 0) {
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
  }
  abbe_number_enter(); /* some of assimp's readers go by the locale */
  _exit(send_scene(fd, path, material) ? 0 : 1);
}

/* ---- the caller ---- */

static bool receive(int fd, void *data, size_t size) {
  for (char *at = data; size > 0;) {
    const ssize_t got = read(fd, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= (size_t)got;
  }
  return true;
}

static abbe_result check(const abbe_mesh *mesh, const char *path, abbe_error *error) {
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    const double *p = mesh->position[v];
    if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "%s: vertex %zu is at (%g, %g, %g); coordinates must be finite", path,
                            v, p[0], p[1], p[2]);
    const double *n = mesh->normal[v];
    if (!isfinite(n[0]) || !isfinite(n[1]) || !isfinite(n[2]))
      memset(mesh->normal[v], 0, sizeof mesh->normal[v]);
    if (mesh->uv && !(isfinite(mesh->uv[v][0]) && isfinite(mesh->uv[v][1])))
      mesh->uv[v][0] = mesh->uv[v][1] = 0;
  }
  for (size_t f = 0; f < mesh->face_count; f++)
    for (int k = 0; k < 3; k++)
      if (mesh->face[f][k] >= mesh->vertex_count)
        return abbe_error_set(error, ABBE_GEOMETRY,
                              "%s: face %zu names a vertex that its part of the file does not have",
                              path, f);
  return ABBE_OK;
}

/* What assimp says where it read the file and found nothing that has a surface. */
static bool means_no_faces(const char *complaint) {
  static const char *const parts[] = {
      "contains no faces", "No meshes remaining",  "mNumMeshes is 0",
      "has no faces",      "contains no vertices", "no facets",
      "file is empty",     "File is empty",        "file is too small"};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
    if (strstr(complaint, parts[i]) != NULL) return true;
  return false;
}

/* The names up to the empty one. */
static abbe_result take_others(const char *names, char **out, abbe_error *error) {
  size_t used = 0;
  while (names[used] != '\0') used += strlen(names + used) + 1;
  if (!out || used == 0) return ABBE_OK;
  *out = malloc(used + 1);
  if (!*out) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the names of files");
  memcpy(*out, names, used + 1);
  return ABBE_OK;
}

/* *whole: whether all came that the child had to send. */
static abbe_result take(int fd, const char *path, const char *material, abbe_mesh *out,
                        char **others, bool *whole, abbe_error *error) {
  header h;
  *whole = receive(fd, &h, sizeof h);
  if (!*whole) return ABBE_OK;
  h.complaint[sizeof h.complaint - 1] = '\0';
  h.others[sizeof h.others - 2] = h.others[sizeof h.others - 1] = '\0';
  if (h.complaint[0] != '\0' && means_no_faces(h.complaint))
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "%s: no faces were read from it: points and lines alone have no surface "
                          "(assimp: %s)",
                          path, h.complaint);
  if (h.complaint[0] != '\0')
    return abbe_error_set(error, h.no_memory ? ABBE_NO_MEMORY : ABBE_PARSE,
                          "%s: the mesh cannot be read: %s", path, h.complaint);
  if ((h.vertices == 0 || h.faces == 0) && material != NULL)
    return abbe_error_set(error, ABBE_GEOMETRY, "%s: no triangle is of a material called '%.80s'",
                          path, material);
  if (h.vertices == 0 || h.faces == 0)
    return abbe_error_set(error, ABBE_GEOMETRY, "%s: the file has no triangles", path);
  abbe_result result = take_others(h.others, others, error);
  if (result == ABBE_OK) result = abbe_mesh_make(h.vertices, h.faces, h.with_uv, out, error);
  if (result != ABBE_OK) return result;
  out->given_normals = h.with_normals;
  *whole = receive(fd, out->position, h.vertices * sizeof *out->position) &&
           (!h.with_normals || receive(fd, out->normal, h.vertices * sizeof *out->normal)) &&
           (!h.with_uv || receive(fd, out->uv, h.vertices * sizeof *out->uv)) &&
           receive(fd, out->face, h.faces * sizeof *out->face);
  return *whole ? check(out, path, error) : ABBE_OK;
}

static abbe_result stopped(const char *path, int status, abbe_error *error) {
  const int ended_by = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (ended_by == SIGXCPU || ended_by == SIGALRM || ended_by == SIGKILL)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: the mesh cannot be read: assimp finds no end of it; the file is "
                          "probably damaged, or cut short",
                          path);
  return abbe_error_set(error, ABBE_PARSE,
                        "%s: the mesh cannot be read: assimp stops at it; the file is probably "
                        "damaged, or has faces of fewer than three vertices",
                        path);
}

abbe_result abbe_mesh_import(const char *path, const char *material, abbe_mesh *out, char **others,
                             abbe_error *error) {
  ABBE_REQUIRE(path && out, error);
  int end[2];
  memset(out, 0, sizeof *out);
  if (others) *others = NULL;
  if (pipe(end) != 0)
    return abbe_error_set(error, ABBE_IO, "%s: there is no pipe to read the mesh through: %s", path,
                          strerror(errno));
  const pid_t self = getpid(), child = fork();
  if (child == 0) {
    close(end[0]);
    be_child(end[1], path, material, self);
  }
  const int why = errno;
  close(end[1]);
  bool whole = false;
  int status = 0;
  abbe_result result =
      child > 0 ? take(end[0], path, material, out, others, &whole, error)
                : abbe_error_set(error, ABBE_IO, "%s: there is no process to read the mesh in: %s",
                                 path, strerror(why));
  close(end[0]);
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (result == ABBE_OK && !whole) result = stopped(path, status, error);
  if (result == ABBE_OK) return ABBE_OK;
  abbe_mesh_free(out);
  if (others) {
    free(*others);
    *others = NULL;
  }
  return result;
}
