/* PNGs as one that moves: its chunks by the standard, its first frame for whoever knows no more. */
#include "tests/check.h"

#include "base/file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/screen/screen_file.h"

#include <unistd.h>
#include <zlib.h>

static const char *const frames[] = {"animated_0.png", "animated_1.png", "animated_2.png"};
#define MOVES "animated.png"

static void write_frame(const char *path, size_t side, float grey) {
  static const char *const names[] = {"R", "G", "B"};
  MADE(abbe_image, image, abbe_image_make(side, side, 3, names, &image, &error));
  for (size_t i = 0; i < 3 * side * side; i++) image.data[i] = grey * (float)(i % 7) / 7;
  OK(abbe_png_write(path, &image, 8, &error));
}

static uint32_t u32_at(const char *at) {
  const unsigned char *b = (const unsigned char *)at;
  return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

/* Every chunk is whole, its sum right, and sequence numbers count up from 0. */
TEST(chunks_are_by_the_standard) {
  FREED char *data = NULL;
  size_t size;
  uint32_t sequence = 0, controls = 0, others = 0, first = 0;
  for (int i = 0; i < 3; i++) write_frame(frames[i], 16, 0.3f * (float)(i + 1));
  OK(abbe_screen_file_move(MOVES, frames, 3, 25, &error));
  OK(abbe_file_read(MOVES, 1 << 20, &data, &size, &error));
  assert_memory_equal(data + 12, "IHDR", 4);
  assert_memory_equal(data + 8 + 25 + 4, "acTL", 4);
  assert_int_equal(u32_at(data + 8 + 25 + 8), 3);
  for (size_t at = 8; at < size;) {
    const uint32_t length = u32_at(data + at);
    const char *type = data + at + 4;
    assert_true(length <= size - at - 12);
    assert_int_equal(crc32(0, (const unsigned char *)type, length + 4), u32_at(type + 4 + length));
    if (memcmp(type, "fcTL", 4) == 0 || memcmp(type, "fdAT", 4) == 0)
      assert_int_equal(u32_at(type + 4), sequence++);
    controls += memcmp(type, "fcTL", 4) == 0;
    others += memcmp(type, "fdAT", 4) == 0;
    first += memcmp(type, "IDAT", 4) == 0;
    if (memcmp(type, "fcTL", 4) == 0) {
      assert_int_equal(u32_at(type + 8), 16);
      assert_int_equal(type[4 + 20] * 256 + type[4 + 21], 40); /* thousandths */
    }
    at += length + 12;
  }
  assert_memory_equal(data + size - 8, "IEND", 4);
  assert_int_equal(controls, 3);
  assert_int_equal(others, 2);
  assert_int_equal(first, 1);
}

TEST(the_first_frame_is_what_others_see) {
  MADE(abbe_image, a, abbe_png_read(MOVES, &a, &error));
  MADE(abbe_image, b, abbe_png_read(frames[0], &b, &error));
  assert_int_equal(a.width, 16);
  assert_memory_equal(a.data, b.data, 3 * 16 * 16 * sizeof(float));
}

TEST(what_is_refused) {
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_screen_file_move("none.png", frames, 0, 25, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_screen_file_move("none.png", frames, 2, NAN, &error));
  write_frame(frames[1], 8, 0.5f);
  REFUSED(ABBE_INVALID_ARGUMENT, "another kind",
          abbe_screen_file_move("none.png", frames, 3, 25, &error));
  OK(abbe_file_write(frames[1], "\x89PNG, they say", 15, &error));
  REFUSED(ABBE_PARSE, "", abbe_screen_file_move("none.png", frames, 3, 25, &error));
  FREED char *data = NULL;
  size_t size;
  OK(abbe_file_read(frames[0], 1 << 20, &data, &size, &error));
  for (size_t cut = 0; cut < size; cut += 7) {
    OK(abbe_file_write(frames[1], data, cut, &error));
    REFUSED(ABBE_PARSE, "", abbe_screen_file_move("none.png", frames, 2, 25, &error));
  }
  assert_int_not_equal(access("none.png", F_OK), 0);
  for (int i = 0; i < 3; i++) unlink(frames[i]);
  unlink(MOVES);
}
