/* Pictures that other programs send: which packets are taken, and what they make of what is shown.
 */
#include "tests/check.h"

#include "cli/view/inspect/inspect.h"

static abbe_display *display; /* Plain of sRGB: the encoding alone */

static void begin(void) {
  const abbe_display_desc desc = {.display = "sRGB", .view = "Plain", .source_space = "ACEScg"};
  OK(abbe_display_make(&desc, &display, &error));
}

static void end(void) {
  abbe_display_free(display);
}

GROUP(begin, end);

/* Shows the first entry of a picture, a pixel of the screen for each of its 2 x 1. */
static void see(abbe_inspect *s, size_t at, bool difference, unsigned char out[8]) {
  bool whole = false;
  OK(abbe_inspect_show(s, at, &(abbe_inspect_look){.display = display, .difference = difference},
                       &error));
  abbe_inspect_fit(s, 2, 1);
  s->zoom = 1;
  while (!whole) OK(abbe_inspect_draw(s, 2, 1, 0, out, &whole, &error));
}

#define TAKE(s, bytes)                                                                             \
  abbe_inspect_take_packet(s, (const unsigned char *)(bytes), sizeof(bytes) - 1, &focus, &error)

/* Each is right but for one thing. */
TEST(packets_that_are_none_are_refused) {
  static const struct {
    const char *bytes;
    size_t size;
    const char *says;
  } cases[] = {
      {"\7\0\0\0\2a", 6, "its length is another"},
      {"\6\0\0\0\2a", 6, "it has no name"},
      {"\6\0\0\0\2\0", 6, "it has no name"},
      {"\5\0\0\0\11", 5, "its kind is not known"},
      {"\26\0\0\0\4\1a\0\4\0\0\0\0\0\0\0\1\0\0\0R", 22, "its size is none"},
      {"\26\0\0\0\4\1a\0\4\0\0\0\1\0\1\0\1\0\0\0R", 22, "its size is none"},
      {"\26\0\0\0\4\1a\0\4\0\0\0\4\0\0\0\0\0\0\0R", 22, "its channels are none"},
      {"\25\0\0\0\4\1a\0\4\0\0\0\4\0\0\0\1\0\0\0R", 21, "its channels are none"},
      {"\35\0\0\0\3\0a\0R\0\0\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\0", 29, "too few numbers"},
      {"\36\0\0\0\3\0a\0R\0\0\0\0\0\0\0\0\0\377\0\0\0\1\0\0\0\0\0\0\0", 30, "too few numbers"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    REFUSED(ABBE_PARSE, cases[i].says,
            abbe_inspect_take_packet(NULL, (const unsigned char *)cases[i].bytes, cases[i].size,
                                     NULL, &error));
}

TEST(what_is_sent_is_bounded_and_said) {
  OWNED(abbe_inspect, s) = {.count = 0};
  size_t focus = 99;
  OK(abbe_inspect_await(&s, &error));
  REFUSED(ABBE_NOT_FOUND, "no picture of this name",
          TAKE(&s, "\36\0\0\0\3\1a\0R\0\0\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\0\0"));
  assert_int_equal(focus, 99);
  /* 32768 x 32768 of one channel are 4 GiB */
  REFUSED(ABBE_OUT_OF_RANGE, "4096 MiB; 1024 are the most",
          TAKE(&s, "\26\0\0\0\4\1a\0\0\200\0\0\0\200\0\0\1\0\0\0R\0"));
  assert_int_equal(s.count, 1);
  OK(TAKE(&s, "\26\0\0\0\4\1a\0\2\0\0\0\1\0\0\0\1\0\0\0R\0"));
  assert_true(s.count == 1 && focus == 0);
  assert_string_equal(s.picture[0].path, "a");
  unsigned char out[8];
  see(&s, 0, false, out);
  assert_int_equal(out[4], 0);
  REFUSED(ABBE_OUT_OF_RANGE, "1 x 1 pixels from 2, 0",
          TAKE(&s, "\36\0\0\0\3\1a\0R\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\200\77"));
  REFUSED(ABBE_NOT_FOUND, "no channel 'G'",
          TAKE(&s, "\36\0\0\0\3\1a\0G\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\200\77"));
  OK(TAKE(&s, "\36\0\0\0\3\1a\0R\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\200\77"));
  see(&s, 0, false, out);
  assert_int_equal(out[0], 0);
  assert_int_equal(out[4], 255);
  assert_near(s.picture[0].most_shown, 1, 0);
  OK(TAKE(&s, "\7\0\0\0\2a\0"));
  assert_int_equal(s.count, 0);
}

/* Packets that make a picture of one channel, 2 x 1 and 3 x 1, and that update its second pixel. */
#define CREATE(name, wide) "\26\0\0\0\4\0" name "\0" wide "\0\0\0\1\0\0\0\1\0\0\0R\0"
#define UPDATE(name) "\36\0\0\0\3\0" name "\0R\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\200\77"

TEST(a_picture_that_is_taken_off_another_may_be_closed) {
  OWNED(abbe_inspect, s) = {.count = 0};
  unsigned char out[8];
  size_t focus = 99;
  bool whole;
  OK(TAKE(&s, CREATE("a", "\2")));
  OK(TAKE(&s, CREATE("b", "\3")));
  OK(TAKE(&s, CREATE("c", "\2")));
  s.other = 2;
  see(&s, 0, true, out);
  OK(TAKE(&s, "\7\0\0\0\2c\0"));
  OK(TAKE(&s, UPDATE("a")));
  OK(abbe_inspect_draw(&s, 2, 1, 0, out, &whole, &error));
  assert_false(s.look.difference);
  assert_int_equal(focus, 99);
}

/* It stays where it is, also where it is what is shown or has another size. */
TEST(a_picture_that_is_made_again_keeps_its_place) {
  OWNED(abbe_inspect, s) = {.count = 0};
  unsigned char out[8];
  size_t focus = 99;
  for (const char *name = "abcdefghijklmno"; *name != '\0'; name++) {
    char packet[] = CREATE("?", "\2");
    packet[6] = *name;
    OK(TAKE(&s, packet));
  }
  OK(TAKE(&s, UPDATE("b")));
  see(&s, 1, false, out);
  assert_int_equal(out[4], 255);
  const size_t serial = s.picture[1].serial;
  OK(TAKE(&s, CREATE("b", "\3")));
  assert_true(s.at == 1 && s.count == 15);
  assert_string_equal(s.picture[1].path, "b");
  assert_int_equal(s.picture[1].width, 3);
  assert_int_not_equal(s.picture[1].serial, serial);
  see(&s, 1, false, out);
  assert_int_equal(out[4], 0);
  /* where there are as many as there may be it becomes the last one */
  OK(TAKE(&s, CREATE("p", "\2")));
  OK(TAKE(&s, CREATE("b", "\2")));
  assert_string_equal(s.picture[15].path, "b");
  REFUSED(ABBE_OUT_OF_RANGE, "at most 16", TAKE(&s, CREATE("q", "\2")));
  assert_int_equal(focus, 99);
}

/* w420nm and the like are kept as S0.420nm; they are still sent by their own names. */
TEST(bands_of_another_name_are_updated_by_it) {
  OWNED(abbe_inspect, s) = {.count = 0};
  size_t focus = 99;
  OK(TAKE(&s, "\42\0\0\0\4\1a\0\2\0\0\0\1\0\0\0\2\0\0\0w420nm\0w430nm\0"));
  assert_string_equal(s.picture[0].image.channel[1], "S0.430nm");
#define BAND(name) "\43\0\0\0\3\1a\0" name "\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0\0\200\77"
  OK(TAKE(&s, BAND("w430nm")));
  assert_near(s.picture[0].image.data[3], 1, 0);
  REFUSED(ABBE_NOT_FOUND, "no channel 'w440nm'", TAKE(&s, BAND("w440nm")));
}

/* What cannot be read again stays; what is there is shown, whatever stands behind its name. */
TEST(files_that_packets_name) {
  OWNED(abbe_inspect, s) = {.count = 0};
  static const char path[] = "p.hdr";
  static const unsigned char pixels[8] = {128, 128, 128, 129, 64, 64, 64, 129};
  size_t focus = 99;
  FILE *file = fopen(path, "wb");
  fputs("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n", file);
  assert_int_equal(fwrite(pixels, 1, sizeof pixels, file), sizeof pixels);
  fclose(file);
  OK(TAKE(&s, "\14\0\0\0\0\0p.hdr\0"));
  OK(TAKE(&s, CREATE("a", "\2")));
  OK(TAKE(&s, "\16\0\0\0\0\1p.hdr:R\0"));
  assert_true(s.count == 2 && focus == 0);
  assert_near(s.picture[0].image.data[3], 0.5, 0);
  file = fopen(path, "r+b");
  assert_int_equal(fseek(file, -4, SEEK_END), 0);
  assert_int_equal(fwrite(pixels, 1, 4, file), 4);
  fclose(file);
  OK(TAKE(&s, "\14\0\0\0\1\0p.hdr\0"));
  assert_string_equal(s.picture[0].path, path);
  assert_near(s.picture[0].image.data[3], 1, 0);
  remove(path);
  REFUSED(ABBE_IO, path, TAKE(&s, "\14\0\0\0\1\0p.hdr\0"));
  assert_string_equal(s.picture[0].path, path);
}
