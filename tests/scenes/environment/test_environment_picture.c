#include "tests/check.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/rgb_space.h"
#include "scenes/environment/environment_source.h"

#include <sys/stat.h>
#include <unistd.h>

static char path[128];
static const char *const rgb_names[] = {"R", "G", "B"};
static const char *const xyz_names[] = {"X", "Y", "Z"};

static abbe_image picture(size_t width, size_t height, const char *const *names) {
  abbe_image image;
  OK(abbe_image_make(width, height, 3, names, &image, &error));
  for (size_t i = 0; i < 3 * width * height; i++) image.data[i] = (float)(i * 7919 % 101 + 1) / 101;
  return image;
}

static abbe_result read_back(abbe_image *image, abbe_environment_layout layout,
                             abbe_radiance_map *map, abbe_error *why) {
  OK(abbe_exr_write(path, image, &error));
  abbe_image_free(image);
  return abbe_environment_picture_read(path, layout, map, why);
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe-test-environment-%d.exr", (int)getpid());
}

static void finish(void) {
  unlink(path);
}

GROUP(begin, finish);

TEST(latlong_pictures) {
  abbe_image image = picture(16, 8, rgb_names);
  OWNED(abbe_image, kept) = picture(16, 8, rgb_names);
  MADE(abbe_radiance_map, map, read_back(&image, ABBE_LAYOUT_BY_ASPECT, &map, &error));
  assert_true(map.width == 16 && map.height == 8);
  assert_memory_equal(map.rgb, kept.data, 3 * 16 * 8 * sizeof(float));
  abbe_radiance_map_free(&map);
  /* of Radiance: one pixel of 1, 0, 0, the rest black */
  char data[256] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 4\n";
  const size_t head = strlen(data);
  memcpy(data + head + 4, "\x80\0\0\x81", 4);
  OK(abbe_file_write(path, data, head + 32, &error));
  OK(abbe_environment_picture_read(path, ABBE_LAYOUT_LATLONG, &map, &error));
  assert_true(map.rgb[3] == 0.5f && map.rgb[4] == 0 && map.rgb[0] == 0);
}

/* The same light by other numbers: in ACEScg, in XYZ. */
TEST(colours_are_converted) {
  for (int space = 0; space < ABBE_RGB_SPACE_COUNT; space++) {
    abbe_image image = picture(16, 8, space == ABBE_RGB_SPACE_XYZ ? xyz_names : rgb_names);
    OWNED(abbe_image, kept) = picture(16, 8, rgb_names);
    double to_xyz[9], from_xyz[9];
    abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
    abbe_rgb_space_from_xyz((abbe_rgb_space)space, from_xyz);
    if (space != ABBE_RGB_SPACE_XYZ) abbe_rgb_space_chromaticities((abbe_rgb_space)space, image.xy);
    for (size_t i = 0; i < 16 * 8; i++) {
      double v[3] = {image.data[3 * i], image.data[3 * i + 1], image.data[3 * i + 2]};
      abbe_rgb_space_apply(to_xyz, v, v);
      abbe_rgb_space_apply(from_xyz, v, v);
      for (size_t k = 0; k < 3; k++) image.data[3 * i + k] = (float)v[k];
    }
    MADE(abbe_radiance_map, map, read_back(&image, ABBE_LAYOUT_BY_ASPECT, &map, &error));
    for (size_t i = 0; i < 3 * 16 * 8; i++) assert_near(map.rgb[i], kept.data[i], 1e-5);
  }
}

/* A green of ACEScg is no colour of Rec.709. */
TEST(what_rec709_cannot_hold_is_clipped) {
  abbe_image image = picture(4, 2, rgb_names);
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, image.xy);
  for (size_t i = 0; i < 24; i++) image.data[i] = i % 3 == 1;
  MADE(abbe_radiance_map, map, read_back(&image, ABBE_LAYOUT_BY_ASPECT, &map, &error));
  assert_true(map.rgb[0] == 0 && map.rgb[1] > 1 && map.rgb[2] == 0);
}

/* abbe:space is taken as every other reader takes it, before the chromaticities; a file that says
 * nothing is Rec.709, and is known to say nothing. */
TEST(the_space_that_a_file_says) {
  abbe_radiance_map map[3];
  for (int i = 0; i < 3; i++) {
    abbe_image image = picture(4, 2, rgb_names);
    for (size_t k = 0; k < 24; k++) image.data[k] = 0.25f + 0.25f * (k % 3 == 1);
    if (i == 0) abbe_image_set_attribute(&image, "abbe:space", "acescg", NULL);
    if (i == 1) abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, image.xy);
    OK(read_back(&image, ABBE_LAYOUT_BY_ASPECT, &map[i], &error));
  }
  for (int k = 0; k < 3; k++) assert_near(map[0].rgb[k], map[1].rgb[k], 1e-6);
  assert_true(map[2].rgb[0] == 0.25f && fabsf(map[0].rgb[0] - 0.25f) > 0.02f);
  assert_true(map[2].space_assumed && !map[0].space_assumed && !map[1].space_assumed);
  for (int i = 0; i < 3; i++) abbe_radiance_map_free(&map[i]);
  abbe_image image = picture(4, 2, rgb_names);
  for (size_t k = 0; k < 24; k++) image.data[k] = k < 6 ? INFINITY : 1;
  REFUSED(ABBE_SCHEMA, "2 are infinite and 0 not a number",
          read_back(&image, ABBE_LAYOUT_BY_ASPECT, &map[0], &error));
}

TEST(grey_pictures) {
  static const char *const names[] = {"Y"};
  abbe_image image;
  OK(abbe_image_make(4, 2, 1, names, &image, &error));
  for (size_t i = 0; i < 8; i++) image.data[i] = (float)i;
  MADE(abbe_radiance_map, map, read_back(&image, ABBE_LAYOUT_BY_ASPECT, &map, &error));
  for (size_t i = 0; i < 24; i++) assert_true(map.rgb[i] == (float)(i / 3));
}

/* Faces of one colour each, both crosses and OpenEXR's column: what looks along each axis, and that
 * all that is black beside the faces is not seen. A mark says how each is turned. */
TEST(cubes) {
  enum { SIDE = 16, LAYOUTS = 3 };
  static const size_t across[LAYOUTS] = {4, 3, 1}, down[LAYOUTS] = {3, 4, 6};
  static const struct {
    size_t at[LAYOUTS][2];
    double direction[3];
    int turned; /* the layout in which it is, or -1 */
  } faces[6] = {
      {{{1, 1}, {1, 1}, {0, 4}}, {1, 0, 0}, -1}, {{{3, 1}, {1, 3}, {0, 5}}, {-1, 0, 0}, 1},
      {{{0, 1}, {0, 1}, {0, 0}}, {0, 1, 0}, -1}, {{{2, 1}, {2, 1}, {0, 1}}, {0, -1, 0}, -1},
      {{{1, 0}, {1, 0}, {0, 2}}, {0, 0, 1}, 2},  {{{1, 2}, {1, 2}, {0, 3}}, {0, 0, -1}, 2}};
  for (int layout = 0; layout < LAYOUTS; layout++) {
    abbe_image image = picture(across[layout] * SIDE, down[layout] * SIDE, rgb_names);
    memset(image.data, 0, image.width * image.height * 3 * sizeof(float));
    for (int f = 0; f < 6; f++) {
      const size_t *at = faces[f].at[layout];
      for (size_t i = 0; i < SIDE * SIDE; i++) {
        const size_t x = at[0] * SIDE + i % SIDE, y = at[1] * SIDE + i / SIDE;
        float *pixel = image.data + 3 * (y * image.width + x);
        pixel[0] = 1;
        pixel[1] = (float)f;
        /* the side of each face that is at the left of who looks at it with +z up */
        const int turned = layout == faces[f].turned;
        pixel[2] = turned ? i % SIDE >= SIDE / 2 : i % SIDE < SIDE / 2;
      }
    }
    double rgb[3];
    MADE(abbe_radiance_map, map, read_back(&image, ABBE_LAYOUT_BY_ASPECT, &map, &error));
    assert_true(map.width == 4 * SIDE);
    for (int f = 0; f < 6; f++) {
      const double *d = faces[f].direction;
      abbe_radiance_map_at(&map, d, rgb);
      assert_near(rgb[0], 1, 1e-6);
      assert_near(rgb[1], f, 1e-6);
      if (f > 3) continue;
      const double left[3] = {d[0] - 0.4 * d[1], d[1] + 0.4 * d[0], 0.1};
      abbe_radiance_map_at(&map, left, rgb);
      assert_near(rgb[2], 1, 1e-6);
    }
    /* of the top and the bottom the side towards +y */
    abbe_radiance_map_at(&map, (const double[3]){0, 0.4, 1}, rgb);
    assert_near(rgb[2], 1, 1e-6);
    abbe_radiance_map_at(&map, (const double[3]){0, 0.4, -1}, rgb);
    assert_near(rgb[2], 1, 1e-6);
    for (size_t i = 0; i < map.width * map.height; i++) assert_near(map.rgb[3 * i], 1, 1e-6);
  }
}

static void check_refused(abbe_environment_layout layout, abbe_result code, const char *part) {
  abbe_radiance_map map;
  REFUSED(code, part, abbe_environment_picture_read(path, layout, &map, &error));
  assert_null(map.rgb);
}

TEST(what_is_refused) {
  static const float bad[] = {-0.25f, NAN, INFINITY};
  static const char *const parts[] = {"is -0.25 in the channel G", "nan", "inf"};
  OWNED(abbe_image, image) = {0};
  for (int i = 0; i < 3; i++) {
    image = picture(8, 4, rgb_names);
    image.data[3 * (8 + 2) + 1] = bad[i];
    OK(abbe_exr_write(path, &image, &error));
    abbe_image_free(&image);
    check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_SCHEMA, parts[i]);
    check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_SCHEMA, "column 2, row 1");
  }
  static const size_t sizes[][2] = {{8, 8}, {9, 4}, {2, 1}, {3, 4}, {4, 3}};
  for (int i = 0; i < 5; i++) {
    image = picture(sizes[i][0], sizes[i][1], rgb_names);
    OK(abbe_exr_write(path, &image, &error));
    abbe_image_free(&image);
    check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_SCHEMA, "pixels");
  }
  image = picture(8, 4, rgb_names);
  OK(abbe_exr_write(path, &image, &error));
  abbe_image_free(&image);
  check_refused(ABBE_LAYOUT_CUBE, ABBE_SCHEMA, "8 x 4");
  image = picture(8, 4, (const char *const[3]){"A", "B", "C"});
  OK(abbe_exr_write(path, &image, &error));
  abbe_image_free(&image);
  check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_NOT_FOUND, "no channels");
  OK(abbe_image_make(8194, 4097, 1, (const char *const[1]){"Y"}, &image, &error));
  OK(abbe_exr_write(path, &image, &error));
  check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_UNSUPPORTED, "8192");
  OK(abbe_file_write(path, "\x76\x2f\x31\x01 cut", 8, &error));
  check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_PARSE, path);
  OK(abbe_file_write(path, "\x89PNG", 4, &error));
  check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_UNSUPPORTED, "neither");
  OK(abbe_file_write(path, "", 0, &error));
  check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_UNSUPPORTED, "neither");
  unlink(path);
  check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_IO, path);
  assert_int_equal(mkfifo(path, 0600), 0);
  check_refused(ABBE_LAYOUT_BY_ASPECT, ABBE_IO, path);
}
