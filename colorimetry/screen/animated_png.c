#include "colorimetry/screen/screen_file.h"

#include "base/file.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { SIGNATURE = 8, HEAD = 8, TAIL = 4, IHDR = 13, MOST_BYTES = 1 << 30 };
static const unsigned char signature[SIGNATURE] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

typedef struct png_frame {
  const char *path;
  unsigned char *data;
  size_t size, at; /* size and place of the next chunk */
} png_frame;

typedef struct chunk {
  const unsigned char *type, *body;
  uint32_t length;
} chunk;

typedef struct writing {
  FILE *to;
  uint32_t sequence;
} writing;

static uint32_t u32_at(const unsigned char *data) {
  return (uint32_t)data[0] << 24 | (uint32_t)data[1] << 16 | (uint32_t)data[2] << 8 | data[3];
}

static void put_u32(unsigned char *out, uint32_t value) {
  for (int i = 0; i < 4; i++) out[i] = (unsigned char)(value >> (24 - 8 * i));
}

/* A chunk of the two bodies, one after another. */
static void put_chunk(FILE *to, const char *type, const unsigned char *a, uint32_t a_length,
                      const unsigned char *b, uint32_t b_length) {
  unsigned char word[4];
  uLong sum = crc32(0, (const unsigned char *)type, 4);
  if (a_length > 0) sum = crc32(sum, a, a_length);
  if (b_length > 0) sum = crc32(sum, b, b_length);
  put_u32(word, a_length + b_length);
  fwrite(word, 1, 4, to);
  fwrite(type, 1, 4, to);
  if (a_length > 0) fwrite(a, 1, a_length, to);
  if (b_length > 0) fwrite(b, 1, b_length, to);
  put_u32(word, (uint32_t)sum);
  fwrite(word, 1, 4, to);
}

static abbe_result no_png(const png_frame *f, abbe_error *error) {
  return abbe_error_set(error, ABBE_PARSE, "%s: no whole PNG", f->path);
}

static abbe_result open_frame(const char *path, png_frame *f, abbe_error *error) {
  char *data = NULL;
  *f = (png_frame){.path = path, .at = SIGNATURE};
  abbe_result result = abbe_file_read(path, MOST_BYTES, &data, &f->size, error);
  f->data = (unsigned char *)data;
  if (result != ABBE_OK) return result;
  if (f->size < SIGNATURE + HEAD + IHDR + TAIL || memcmp(f->data, signature, SIGNATURE) != 0 ||
      u32_at(f->data + SIGNATURE) != IHDR || memcmp(f->data + SIGNATURE + 4, "IHDR", 4) != 0)
    return no_png(f, error);
  return ABBE_OK;
}

static abbe_result next_chunk(png_frame *f, chunk *out, abbe_error *error) {
  if (f->size - f->at < HEAD + TAIL) return no_png(f, error);
  out->length = u32_at(f->data + f->at);
  out->type = f->data + f->at + 4;
  out->body = out->type + 4;
  if (f->size - f->at - HEAD - TAIL < out->length) return no_png(f, error);
  f->at += HEAD + TAIL + (size_t)out->length;
  return ABBE_OK;
}

static bool is(const chunk *c, const char *type) {
  return memcmp(c->type, type, 4) == 0;
}

static const unsigned char *kind_of(const png_frame *f) {
  return f->data + SIGNATURE + HEAD;
}

/* How long a frame stays, as a fraction of seconds. */
static void put_control(writing *w, const png_frame *f, double per_second) {
  unsigned char body[26] = {0};
  const long thousandths = lround(1000 / per_second);
  put_u32(body, w->sequence++);
  memcpy(body + 4, kind_of(f), 8); /* width and height */
  body[20] = (unsigned char)(thousandths >> 8);
  body[21] = (unsigned char)thousandths;
  body[22] = 1000 >> 8;
  body[23] = 1000 & 255;
  put_chunk(w->to, "fcTL", body, sizeof body, NULL, 0);
}

/* The pixels of the frame; of the first all that comes before them too. */
static abbe_result put_frame(writing *w, png_frame *f, bool first, size_t count, double per_second,
                             abbe_error *error) {
  bool pixels = false;
  for (;;) {
    chunk c = {0};
    ABBE_TRY(next_chunk(f, &c, error));
    if (is(&c, "IEND")) return pixels ? ABBE_OK : no_png(f, error);
    if (is(&c, "IDAT")) {
      unsigned char sequence[4];
      if (!pixels) put_control(w, f, per_second);
      pixels = true;
      if (!first) put_u32(sequence, w->sequence++);
      put_chunk(w->to, first ? "IDAT" : "fdAT", sequence, first ? 0 : 4, c.body, c.length);
    } else if (first && !pixels && !is(&c, "tEXt")) {
      char type[5] = {0};
      memcpy(type, c.type, 4);
      put_chunk(w->to, type, c.body, c.length, NULL, 0);
      if (is(&c, "IHDR")) {
        unsigned char body[8] = {0};
        put_u32(body, (uint32_t)count);
        put_chunk(w->to, "acTL", body, sizeof body, NULL, 0);
      }
    }
  }
}

static abbe_result put_frames(writing *w, const char *const *paths, size_t count, double per_second,
                              abbe_error *error) {
  unsigned char kind[IHDR];
  abbe_result result = ABBE_OK;
  fwrite(signature, 1, SIGNATURE, w->to);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    png_frame f;
    result = open_frame(paths[i], &f, error);
    if (result == ABBE_OK && i == 0) memcpy(kind, kind_of(&f), IHDR);
    if (result == ABBE_OK && memcmp(kind, kind_of(&f), IHDR) != 0)
      result = abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s is of another kind than %s",
                              paths[i], paths[0]);
    if (result == ABBE_OK) result = put_frame(w, &f, i == 0, count, per_second, error);
    free(f.data);
  }
  put_chunk(w->to, "IEND", NULL, 0, NULL, 0);
  return result;
}

abbe_result abbe_animated_png_write(const char *path, const char *const *frame, size_t count,
                                    double per_second, abbe_error *error) {
  abbe_file_writer writer;
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  writing w = {.to = writer.stream};
  abbe_result result = put_frames(&w, frame, count, per_second, error);
  return abbe_file_writer_end(&writer, result, error);
}
