/* Mesh files: the first byte picks the kind, the rest is the file. */
#include "tests/fuzz/memory_file.h"

#include "scenes/mesh/mesh.h"

#include <errno.h>
#include <string.h>

const char *const fuzz_words[] = {"v 0 0 1\n",
                                  "f 1 2 3\n",
                                  "f 1/1/1 2//2 -1\n",
                                  "vn 0 0 1\n",
                                  "vt 0 1\n",
                                  "usemtl x\n",
                                  "ply\nformat ascii 1.0\n",
                                  "format binary_little_endian 1.0\n",
                                  "element vertex 4\n",
                                  "element face 4\n",
                                  "format binary_big_endian 1.0\n",
                                  "element tristrips 1\n",
                                  "property double y\n",
                                  "property list int int vertex_indices\n",
                                  "element vertex 99999\n",
                                  "4 0 1 2 -1\n",
                                  "f 1 2 3 4 1 5 6 7 8 5\n",
                                  "property float x\n",
                                  "property list uchar int vertex_indices\n",
                                  "end_header\n",
                                  "solid x\n",
                                  "facet normal 0 0 1\n",
                                  "outer loop\nvertex 0 0 1\n",
                                  "endloop\nendfacet\n",
                                  "\"meshes\":[",
                                  "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}]",
                                  "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
                                  "\"count\":3,\"type\":\"VEC3\"}]",
                                  "\"sparse\":{\"count\":1,",
                                  "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{",
                                  "\"TRANSLATION\":0",
                                  "\"children\":[0]",
                                  "\"mode\":5,",
                                  "\"byteStride\":",
                                  NULL};

static const char *link_named(const char *target, const char *kind) {
  static char name[64];
  snprintf(name, sizeof name, "fuzz_mesh_file.%ld.%s", (long)getpid(), kind);
  FUZZ_PROMISE(symlink(target, name) == 0 || errno == EEXIST);
  return name;
}

int fuzz_input(const uint8_t *data, size_t size) {
  static const char *const kinds[] = {"obj", "ply", "stl", "gltf", "glb"};
  abbe_mesh mesh;
  abbe_error error = {0};
  if (size == 0) return 0;
  const char *path = link_named(memory_file(data + 1, size - 1), kinds[data[0] % 5]);
  if (FUZZED(abbe_mesh_load(path, data[0] & 64 ? ABBE_NORMALS_AUTO : ABBE_NORMALS_FLAT, &mesh, NULL,
                            &error),
             &error) != ABBE_OK)
    FUZZ_PROMISE(error.text[0] != '\0' && mesh.position == NULL && mesh.face == NULL);
  else
    fuzz_same(mesh.position, mesh.vertex_count * sizeof *mesh.position);
  for (size_t f = 0; f < mesh.face_count; f++)
    for (int k = 0; k < 3; k++) FUZZ_PROMISE(mesh.face[f][k] < mesh.vertex_count);
  abbe_mesh_free(&mesh);
  unlink(path);
  return 0;
}
