/* meshes.h: meshes from texts, for tests: read, measured, and the words of what is refused. */
#ifndef ABBE_TESTS_SCENES_IMPORT_MESH_MESHES_H
#define ABBE_TESTS_SCENES_IMPORT_MESH_MESHES_H

#include "tests/check.h"

#include "scenes/import/mesh/mesh_reading.h"

typedef abbe_result test_reader(abbe_mesh_reading *r, const char *data, size_t size,
                                abbe_error *error);

/* From a copy, so that a sanitizer sees what is read past its end. */
static inline abbe_result test_read(test_reader *read, const char *path, const char *material,
                                    const void *data, size_t size, abbe_mesh *out) {
  OWNED(abbe_mesh_reading, r) = {.path = path, .material = material};
  FREED char *whole = malloc(size + 1);
  assert_non_null(whole);
  memcpy(whole, data, size);
  whole[size] = '\0';
  memset(out, 0, sizeof *out);
  last_error.text[0] = '\0';
  abbe_result result = read(&r, whole, size, &last_error);
  if (result == ABBE_OK) result = abbe_mesh_reading_finish(&r, out, &last_error);
  return result;
}

/* The tetrahedron of (0, 0, 0), (1, 0, 0), (0, 2, 0) and (0, 0, 3), moved and scaled: closed,
 * outwards and of volume 1 where size is 1. Frees it. */
static inline void assert_tetrahedron(abbe_mesh *m, double size, double shift, double tolerance) {
  abbe_mesh_report r;
  assert_int_equal(m->face_count, 4);
  OK(abbe_mesh_check(m, &r, &error));
  assert_int_equal(r.open_edges + r.flipped_edges + r.crowded_edges, 0);
  assert_near(r.volume, size * size * size, tolerance);
  for (int k = 0; k < 3; k++) {
    assert_near(r.min[k], k == 0 ? shift : 0, tolerance);
    assert_near(r.max[k], size * (k + 1) + (k == 0 ? shift : 0), tolerance);
  }
  abbe_mesh_free(m);
}

static inline void assert_refused(test_reader *read, const char *path, const char *text,
                                  abbe_result code, const char *words) {
  abbe_mesh m;
  const abbe_result result = test_read(read, path, NULL, text, strlen(text), &m);
  if (result != code) fail_msg("%d (%s) for: %s", result, last_error.text, text);
  assert_contains(last_error.text, path);
  assert_contains(last_error.text, words);
  assert_null(m.position);
}

#endif
