/* Volumes as files: they come back bit for bit, and broken ones are told apart. */
#include "tests/scenes/volume/volumes.h"

#include "colorimetry/image/exr.h"
#include "scenes/volume/caustic_volume.h"

#include <unistd.h>

static const char path[] = "volume-file-test.exr";
static const abbe_region_desc regions[] = {
    {.kind = ABBE_REGION_GRID, .side = 6, .outer = 0.3},
    {.kind = ABBE_REGION_GEODESIC, .levels = 1, .shells = 5, .inner = 0.1, .outer = 0.7},
    {.kind = ABBE_REGION_OCTAHEDRAL, .side = 4, .shells = 3, .inner = 0.01, .outer = 0.1}};

TEST(files_give_volumes_back) {
  for (int i = 0; i < 12; i++) {
    OWNED(abbe_caustic_volume, v);
    const size_t nodes = i / 3 % 2 != 0 ? 12 : 1;
    make_volume(i < 6 ? ABBE_VOLUME_VECTOR : ABBE_VOLUME_PRINTED, regions[i % 3], nodes, i % 2 != 0,
                &v);
    OK(abbe_volume_file_write(path, &v, &error));
    MADE(abbe_caustic_volume, back, abbe_volume_file_read(path, &back, &error));
    assert_int_equal(back.kind, v.kind);
    const abbe_region_desc *a = &back.region.desc, *b = &v.region.desc;
    assert_true(a->kind == b->kind && a->side == b->side && a->levels == b->levels &&
                a->shells == b->shells && a->inner == b->inner && a->outer == b->outer);
    assert_int_equal(back.nodes.count, v.nodes.count);
    assert_memory_equal(back.nodes.direction, v.nodes.direction, v.nodes.count * 24);
    assert_string_equal(back.body.name, v.body.name);
    assert_string_equal(back.body.material, v.body.material);
    assert_int_equal(back.body.ball, v.body.ball);
    assert_near(back.body.radius, 1, 0);
    if (!v.body.ball) assert_memory_equal(back.body.anchor_at, v.body.anchor_at, 72);
    assert_memory_equal(back.white, v.white, sizeof v.white);
    assert_near(back.error, v.error, 0);
    if (v.kind == ABBE_VOLUME_PRINTED) assert_near(back.byte, v.byte, 0);
    assert_memory_equal(back.value, v.value,
                        v.nodes.count * v.region.cells * abbe_caustic_volume_channels(&v) * 2);
  }
  unlink(path);
}

/* Rays that leave a body, of made-up numbers. */
static void make_exits(abbe_caustic_volume *out) {
  enum { POINTS = 7 };
  abbe_exit_halves point[POINTS] = {0};
  make_volume(ABBE_VOLUME_VECTOR, regions[0], 12, false, out);
  free(out->value);
  out->value = NULL;
  out->kind = ABBE_VOLUME_EXITS;
  for (int i = 0; i < POINTS; i++) {
    point[i][ABBE_EXIT_NORMAL + i % 3] = abbe_half_of(i < 3 ? 1 : -1);
    point[i][ABBE_EXIT_BIN] = abbe_half_of(31 * i);
  }
  OK(abbe_light_exits_make(&out->nodes, POINTS, (const abbe_exit_halves *)point, NULL, 1, 0.75,
                           out->region.cells, &out->exits, &error));
  for (size_t i = 0; i < out->exits.count * ABBE_EXIT_HALVES; i++)
    out->exits.exit[i / ABBE_EXIT_HALVES][i % ABBE_EXIT_HALVES] = abbe_half_of((double)i / 64 - 3);
  for (size_t i = 0; i < out->exits.cells; i++) out->exits.space[i] = abbe_half_of((double)i / 512);
}

TEST(files_give_rays_back) {
  abbe_caustic_volume v, back;
  make_exits(&v);
  assert_true(v.exits.count > 20);
  OK(abbe_volume_file_write(path, &v, &error));
  OK(abbe_volume_file_read(path, &back, &error));
  assert_int_equal(back.kind, ABBE_VOLUME_EXITS);
  assert_int_equal(back.exits.points, v.exits.points);
  assert_int_equal(back.exits.count, v.exits.count);
  assert_near(back.exits.area, 0.75, 0);
  assert_near(back.exits.radius, 1, 0);
  assert_memory_equal(back.exits.point, v.exits.point, v.exits.points * sizeof *v.exits.point);
  assert_memory_equal(back.exits.exit, v.exits.exit, v.exits.count * sizeof *v.exits.exit);
  assert_memory_equal(back.exits.space, v.exits.space, v.exits.cells * sizeof *v.exits.space);
  abbe_caustic_volume_free(&back);
  /* and are told where they are broken */
  static const char *const broken[][2] = {{"abbe:volume_exits", "0 points of 1 m2, 40 exits"},
                                          {"abbe:volume_exits", "6 points of -1 m2, 40 exits"},
                                          {"abbe:volume_exits", "1e12 points of 1 m2, 40 exits"},
                                          {"abbe:volume_exits", "7 points of 1 m2, 40 exits"},
                                          {"abbe:volume_nodes", "42 of a geodesic sphere"},
                                          {"abbe:volume_nodes", "1 along 0 0 1"},
                                          {"abbe:volume", "vector"}};
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    OK(abbe_volume_file_write(path, &v, &error));
    MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
    OK(abbe_image_set_attribute(&image, broken[i][0], broken[i][1], &error));
    OK(abbe_exr_write_half(path, &image, &error));
    REFUSED(ABBE_PARSE, path, abbe_volume_file_read(path, &back, &error));
  }
  abbe_caustic_volume_free(&v);
  unlink(path);
}

/* A good file with one attribute changed. */
static abbe_result read_with(const char *name, const char *text, abbe_error *why) {
  abbe_caustic_volume v, back;
  make_volume(ABBE_VOLUME_PRINTED, regions[1], 12, false, &v);
  OK(abbe_volume_file_write(path, &v, &error));
  MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
  OK(abbe_image_set_attribute(&image, name, text, &error));
  OK(abbe_exr_write_half(path, &image, &error));
  const abbe_result result = abbe_volume_file_read(path, &back, why);
  if (result == ABBE_OK) abbe_caustic_volume_free(&back);
  abbe_caustic_volume_free(&v);
  unlink(path);
  return result;
}

TEST(broken_attributes_are_told) {
  static const char *const broken[][2] = {
      {"abbe:volume", "scalar"},
      {"abbe:volume_region", "5 shells of 81 triangles, 0.1 to 0.7 m"},
      {"abbe:volume_region", "5 shells of 80 triangles, 0.7 to 0.1 m"},
      {"abbe:volume_region", "6 shells of 80 triangles, 0.1 to 0.7 m"}, /* more than there are */
      {"abbe:volume_region", "1e9 shells of 80 triangles, 0.1 to 0.7 m"},
      {"abbe:volume_region", "grid of 4294967296 cells a side, 1 m wide"},
      {"abbe:volume_region", "grid of nan cells a side, 1 m wide"},
      {"abbe:volume_nodes", "13 of a geodesic sphere"},
      {"abbe:volume_nodes", "-12 of a geodesic sphere"},
      {"abbe:volume_nodes", "42 of a geodesic sphere"},
      {"abbe:volume_nodes", "1 along 0 0 0"},
      {"abbe:volume_body", "radius 0 m"},
      {"abbe:volume_body",
       "radius 1 m, 3 vertices, 1 faces; of them 0 at 1 0 0, 1 at 0 1 0, 9 at 0 0 1"},
      {"abbe:volume_body",
       "radius 1 m, 3 vertices, 1 faces; of them 0 at 1 0 0, 1 at 2 0 0, 2 at 0 0 1"},
      {"abbe:volume_light", "XYZ 1 1 1, 780 to 380 nm"},
      {"abbe:volume_error", ""},
      {"abbe:volume_byte", "-1"},
  };
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    REFUSED(ABBE_PARSE, path, read_with(broken[i][0], broken[i][1], &error));
  }
  OK(read_with("abbe:other", "", &error));
}

TEST(other_pictures_are_no_volumes) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_caustic_volume v;
  MADE(abbe_image, image, abbe_image_make(4, 4, 3, names, &image, &error));
  OK(abbe_exr_write(path, &image, &error));
  REFUSED(ABBE_NOT_FOUND, "abbe volume", abbe_volume_file_read(path, &v, &error));
  unlink(path);
  REFUSED(ABBE_IO, "No such file or directory", abbe_volume_file_read(path, &v, &error));
}

/* Values that a volume cannot have. */
TEST(broken_values_are_told) {
  static const float wrong[] = {NAN, INFINITY, 0.5f, 256, -1};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    abbe_caustic_volume back;
    FILLED(abbe_caustic_volume, v, make_volume(ABBE_VOLUME_PRINTED, regions[0], 1, true, &v));
    OK(abbe_volume_file_write(path, &v, &error));
    MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
    image.data[7] = wrong[i];
    OK(abbe_exr_write(path, &image, &error));
    REFUSED(ABBE_PARSE, "channel", abbe_volume_file_read(path, &back, &error));
  }
  unlink(path);
}
