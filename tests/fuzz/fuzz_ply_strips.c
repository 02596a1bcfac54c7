/* PLY files of triangle strips, which are read without assimp and in this process. */
#include "tests/fuzz/fuzz.h"

#include "scenes/mesh/ply_strips.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const fuzz_words[] = {"ply\nformat ascii 1.0\n",
                                  "format binary_little_endian 1.0\n",
                                  "format binary_big_endian 1.0\n",
                                  "element vertex 4\n",
                                  "element vertex 18446744073709551615\n",
                                  "element tristrips 1\n",
                                  "element face 4\n",
                                  "property float x\n",
                                  "property double y\n",
                                  "property list uchar int vertex_indices\n",
                                  "property list int int vertex_indices\n",
                                  "end_header\n",
                                  "4 0 1 2 -1\n",
                                  NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  abbe_mesh mesh;
  abbe_error error = {0};
  char *text = malloc(size + 1); /* files are read with a zero byte at their end */
  FUZZ_PROMISE(text != NULL);
  if (size > 0) memcpy(text, data, size);
  text[size] = '\0';
  if (abbe_ply_read_strips(text, size, "f.ply", &mesh, &error) != ABBE_OK)
    FUZZ_PROMISE(error.text[0] != '\0' && mesh.position == NULL && mesh.face == NULL);
  for (size_t v = 0; v < mesh.vertex_count; v++)
    for (int k = 0; k < 3; k++) FUZZ_PROMISE(isfinite(mesh.position[v][k]));
  for (size_t f = 0; f < mesh.face_count; f++)
    for (int k = 0; k < 3; k++) FUZZ_PROMISE(mesh.face[f][k] < mesh.vertex_count);
  abbe_mesh_free(&mesh);
  free(text);
  return 0;
}
