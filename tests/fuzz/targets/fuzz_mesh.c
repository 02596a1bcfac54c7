/* Any triangles at all through the mesh's checks, fixing, subdivision, planes and topology.
 *
 * Input: a byte of choices, a byte each for the numbers of vertices and faces, a byte that scales,
 * then positions and faces. Choices: 1 smooth, 2 positions as eight raw bytes a coordinate (else
 * one signed byte), 4 subdivide, 8 texture coordinates; the upper half picks the
 * transform.
 */
#include "tests/fuzz/fuzz.h"

#include "scenes/mesh/mesh.h"
#include "scenes/mesh/topology.h"
#include "scenes/shapes/convex.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

const char *const fuzz_words[] = {
    "\x01\x04\x04\x40", "\x02\x03\x01", "\x0d\x08\x0c\x7f", "\x40\x40\x40", "\x7f", "\xc0\xc0",
    "\xf0\x7f",         "\xf8\x7f",     "\xf0\x3f",         "\xef\x7f",     NULL};

typedef struct input {
  const uint8_t *at, *end;
} input;

static unsigned byte(input *in) {
  return in->at < in->end ? *in->at++ : 0;
}

static double coordinate(input *in, int raw, double scale) {
  if (!raw) return (double)(int8_t)byte(in) * scale;
  uint8_t bytes[8];
  double x;
  for (int i = 0; i < 8; i++) bytes[i] = (uint8_t)byte(in);
  memcpy(&x, bytes, sizeof x);
  return x;
}

static int read_mesh(input *in, unsigned choices, abbe_mesh *out) {
  const size_t vertices = byte(in), faces = byte(in);
  const double scale = ldexp(1.0, (int)(int8_t)byte(in));
  abbe_error error = {0};
  if (FUZZED(abbe_mesh_make(vertices, faces, (choices & 8) != 0, out, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && out->position == NULL);
    return 0;
  }
  for (size_t v = 0; v < vertices; v++)
    for (int k = 0; k < 3; k++) out->position[v][k] = coordinate(in, (choices & 2) != 0, scale);
  for (size_t f = 0; f < faces; f++)
    for (int k = 0; k < 3; k++) out->face[f][k] = byte(in);
  return 1;
}

static void copy_mesh(const abbe_mesh *from, abbe_mesh *to) {
  const size_t v = from->vertex_count, f = from->face_count;
  FUZZ_PROMISE(abbe_mesh_make(v, f, from->uv != NULL, to, NULL) == ABBE_OK);
  memcpy(to->position, from->position, v * sizeof *to->position);
  memcpy(to->normal, from->normal, v * sizeof *to->normal);
  if (from->uv != NULL) memcpy(to->uv, from->uv, v * sizeof *to->uv);
  memcpy(to->face, from->face, f * sizeof *to->face);
}

static int same_mesh(const abbe_mesh *a, const abbe_mesh *b) {
  return a->vertex_count == b->vertex_count && a->face_count == b->face_count &&
         (a->uv == NULL) == (b->uv == NULL) &&
         memcmp(a->position, b->position, a->vertex_count * sizeof *a->position) == 0 &&
         memcmp(a->face, b->face, a->face_count * sizeof *a->face) == 0;
}

static void usable(const abbe_mesh *mesh) {
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    const double *n = mesh->normal[v];
    FUZZ_PROMISE(fabs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-6);
    for (int k = 0; k < 3; k++) FUZZ_PROMISE(isfinite(mesh->position[v][k]));
  }
  for (size_t f = 0; f < mesh->face_count; f++)
    for (int k = 0; k < 3; k++) FUZZ_PROMISE(mesh->face[f][k] < mesh->vertex_count);
}

static void topology_holds(const abbe_mesh *mesh) {
  abbe_topology t;
  FUZZ_PROMISE(abbe_topology_make(mesh, &t, NULL) == ABBE_OK);
  FUZZ_PROMISE(t.point_count <= mesh->vertex_count && t.face_count == mesh->face_count);
  for (size_t e = 0; e < t.edge_count; e++)
    FUZZ_PROMISE(t.edge[e].a < t.edge[e].b && t.edge[e].b < t.point_count &&
                 t.edge[e].along + t.edge[e].against > 0);
  for (size_t f = 0; f < t.face_count; f++) {
    FUZZ_PROMISE(t.shell[f] < t.shell_count);
    for (int k = 0; k < 3; k++)
      FUZZ_PROMISE(t.face[f][k] < t.point_count &&
                   (t.face_edge[f][k] < t.edge_count || t.face_edge[f][k] == ABBE_TOPOLOGY_NONE));
  }
  abbe_topology_free(&t);
}

static void split(const abbe_mesh *mesh, size_t solids) {
  abbe_mesh *part = NULL;
  abbe_error error = {0};
  size_t count = 0, faces = 0;
  if (FUZZED(abbe_mesh_split(mesh, &part, &count, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && part == NULL);
    return;
  }
  FUZZ_PROMISE(count == solids && (part == NULL) == (count == 1));
  for (size_t i = 0; part != NULL && i < count; i++) {
    usable(&part[i]);
    faces += part[i].face_count;
    abbe_mesh_free(&part[i]);
  }
  FUZZ_PROMISE(part == NULL || faces == mesh->face_count);
  free(part);
}

static void fix(abbe_mesh *mesh, int smooth, size_t levels) {
  abbe_mesh before;
  abbe_error error = {0};
  char *what = NULL;
  copy_mesh(mesh, &before);
  size_t solids = 0;
  if (FUZZED(abbe_mesh_fix(mesh, smooth ? ABBE_NORMALS_SMOOTH : ABBE_NORMALS_AUTO, &solids, &what,
                           &error),
             &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && what == NULL && same_mesh(mesh, &before));
    abbe_mesh_free(&before);
    return;
  }
  abbe_mesh_report r;
  FUZZ_PROMISE(abbe_mesh_check(mesh, &r, &error) == ABBE_OK);
  fuzz_same(mesh->position, mesh->vertex_count * sizeof *mesh->position);
  FUZZ_PROMISE(r.open_edges == 0 && r.crowded_edges == 0 && r.flipped_edges == 0 && r.volume > 0);
  usable(mesh);
  split(mesh, solids);
  double plane[64][4];
  abbe_convex found;
  char text[128];
  FUZZ_PROMISE(abbe_convex_find(mesh, 64, plane, NULL, &found, &error) == ABBE_OK);
  FUZZ_PROMISE(found.verdict != ABBE_CONVEX_SOLID ||
               (found.planes >= 4 && found.planes <= 64 && isfinite(plane[0][3])));
  abbe_convex_reason(&found, text, sizeof text);
  abbe_mesh_contains(mesh, (const double[3]){0.1, 0.2, 0.3});
  abbe_mesh flat;
  double moved = 0;
  copy_mesh(mesh, &flat);
  if (FUZZED(abbe_convex_flatten(&flat, 0.02, 64, &moved, &error), &error) == ABBE_OK)
    FUZZ_PROMISE(isfinite(moved) && flat.face_count > 0);
  else
    FUZZ_PROMISE(error.text[0] != '\0' && same_mesh(&flat, mesh));
  abbe_mesh_free(&flat);
  if (levels > 0 && FUZZED(abbe_mesh_subdivide(mesh, levels, &error), &error) == ABBE_OK)
    usable(mesh);
  free(what);
  abbe_mesh_free(&before);
}

int fuzz_input(const uint8_t *data, size_t size) {
  input in = {data, data + size};
  const unsigned choices = byte(&in);
  abbe_mesh mesh;
  if (!read_mesh(&in, choices, &mesh)) return 0;
  abbe_mesh_report report;
  abbe_error error = {0};
  if (abbe_mesh_check(&mesh, &report, &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0');
    FUZZ_PROMISE(abbe_mesh_fix(&mesh, ABBE_NORMALS_AUTO, NULL, NULL, &error) != ABBE_OK);
  } else {
    topology_holds(&mesh);
    double matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    matrix[0] = (double)(int)(choices >> 4) - 7;
    FUZZ_PROMISE(abbe_mesh_compute_normals(&mesh, (abbe_mesh_normals)(choices % 3), &error) ==
                 ABBE_OK);
    usable(&mesh);
    FUZZ_PROMISE((abbe_mesh_transform(&mesh, matrix, &error) == ABBE_OK) == (matrix[0] != 0));
    fix(&mesh, choices & 1, (choices & 4) != 0);
  }
  abbe_mesh_free(&mesh);
  return 0;
}
