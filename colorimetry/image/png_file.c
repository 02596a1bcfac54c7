#include "colorimetry/image/png_file.h"

#include "base/file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SIDE = 16384, MAX_CHUNK_BYTES = 4 << 20, DEFLATE_RATIO = 1032 };

/* One file being read or written. libpng leaves by longjmp, so what must outlive that lives
 * here. */
typedef struct job {
  const char *path;
  FILE *file;
  png_structp png;
  png_infop info;
  png_bytep rows;
  png_bytep *row;
  png_uint_32 width, height;
  int bits, samples; /* a row's pixel in memory */
  void *icc;         /* to be written; of three channels that are not in sRGB */
  size_t icc_size;
  bool over_white; /* reads what is transparent, too */
  bool io_failed, no_memory;
  char message[256];
} job;

static void on_error(png_structp png, png_const_charp message) {
  job *j = png_get_error_ptr(png);
  snprintf(j->message, sizeof j->message, "%s", message);
  longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message) {
  (void)png, (void)message;
}

/* libpng leaves out what there was no memory for, as a profile, and goes on. */
static png_voidp allocate(png_structp png, png_alloc_size_t size) {
  job *j = png_get_mem_ptr(png);
  void *memory = malloc(size);
  if (memory == NULL) j->no_memory = true;
  return memory;
}

static void give_back(png_structp png, png_voidp memory) {
  (void)png;
  free(memory);
}

static void write_bytes(png_structp png, png_bytep bytes, size_t size) {
  job *j = png_get_io_ptr(png);
  if (fwrite(bytes, 1, size, j->file) == size) return;
  j->io_failed = true;
  png_error(png, strerror(errno));
}

static void flush_bytes(png_structp png) {
  (void)png;
}

static void read_bytes(png_structp png, png_bytep bytes, size_t size) {
  job *j = png_get_io_ptr(png);
  if (fread(bytes, 1, size, j->file) == size) return;
  j->io_failed = ferror(j->file) != 0;
  png_error(png, j->io_failed ? strerror(errno) : "it ends too early");
}

/* Writing */

static unsigned quantize(float value, unsigned top) {
  if (!(value > 0)) return 0; /* not-a-number too */
  return value >= 1 ? top : (unsigned)lround((double)value * top);
}

static void fill_row(const abbe_image *image, size_t y, const job *j) {
  const unsigned top = j->bits == 16 ? 65535 : 255;
  png_bytep out = j->rows;
  for (size_t x = 0; x < image->width; x++)
    for (int k = 0; k < j->samples; k++) {
      unsigned v = quantize(image->data[(y * image->width + x) * image->channels + (size_t)k], top);
      if (j->bits == 16) *out++ = (png_byte)(v >> 8);
      *out++ = (png_byte)(v & 255);
    }
}

/* libpng before 1.6.45 has no call for it; a chunk that it does not know goes before the pixels. */
static void write_cicp(const job *j, const abbe_image *image) {
  png_byte codes[4] = {(png_byte)abbe_rgb_encoding_primaries_code(image->xy),
                       (png_byte)image->transfer, 0, 1};
  png_unknown_chunk chunk = {
      .name = "cICP", .data = codes, .size = sizeof codes, .location = PNG_HAVE_IHDR};
  png_set_keep_unknown_chunks(j->png, PNG_HANDLE_CHUNK_ALWAYS, chunk.name, 1);
  png_set_unknown_chunks(j->png, j->info, &chunk, 1);
}

/* The chunks that state what the numbers mean. */
static void write_encoding(const job *j, const abbe_image *image) {
  if (image->transfer != 0) {
    write_cicp(j, image);
    return;
  }
  if (abbe_rgb_encoding_is_srgb(image->xy, image->curve))
    png_set_sRGB_gAMA_and_cHRM(j->png, j->info, PNG_sRGB_INTENT_RELATIVE);
  else if (j->icc != NULL)
    png_set_iCCP(j->png, j->info, "icc", PNG_COMPRESSION_TYPE_BASE, j->icc,
                 (png_uint_32)j->icc_size);
}

static void write_text(const job *j, const abbe_image *image) {
  static char key[] = ABBE_PNG_TEXT;
  const char *value = abbe_image_attribute_text(image, ABBE_PNG_TEXT);
  if (value == NULL) return;
  png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE,
                   .key = key,
                   .text = (png_charp)(uintptr_t)value,
                   .text_length = strlen(value)};
  png_set_text(j->png, j->info, &text, 1);
}

static bool write_rows(job *j, const abbe_image *image) {
  if (setjmp(png_jmpbuf(j->png))) return false;
  png_set_write_fn(j->png, j, write_bytes, flush_bytes);
  png_set_user_limits(j->png, ABBE_IMAGE_MAX_SIDE, ABBE_IMAGE_MAX_SIDE);
  png_set_IHDR(j->png, j->info, (png_uint_32)image->width, (png_uint_32)image->height, j->bits,
               j->samples == 4   ? PNG_COLOR_TYPE_RGB_ALPHA
               : j->samples == 3 ? PNG_COLOR_TYPE_RGB
                                 : PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  write_encoding(j, image);
  write_text(j, image);
  png_write_info(j->png, j->info);
  for (size_t y = 0; y < image->height; y++) {
    fill_row(image, y, j);
    png_write_row(j->png, j->rows);
  }
  png_write_end(j->png, NULL);
  return true;
}

static bool write_image(job *j, const abbe_image *image) {
  j->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, j, on_error, on_warning, j, allocate,
                                     give_back);
  j->info = j->png == NULL ? NULL : png_create_info_struct(j->png);
  j->rows = malloc(image->width * (size_t)j->samples * (size_t)(j->bits / 8));
  j->no_memory = j->info == NULL || j->rows == NULL;
  bool written = !j->no_memory && write_rows(j, image) && !j->no_memory;
  png_destroy_write_struct(&j->png, &j->info);
  free(j->rows);
  return written;
}

abbe_result abbe_png_write(const char *path, const abbe_image *image, int bits, abbe_error *error) {
  if (bits != 8 && bits != 16)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a PNG of %d bits cannot be written; 8 or 16 can", path, bits);
  if (image->data == NULL || image->channels == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: the image to write is empty", path);
  if (image->transfer != 0 &&
      (bits != 16 || image->channels < 3 || abbe_rgb_encoding_primaries_code(image->xy) == 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: PQ and HLG are written with 16 bits, for the primaries of Rec.709, "
                          "Rec.2020 or P3",
                          path);
  job j = {.path = path, .bits = bits, .samples = image->channels < 3 ? 1 : 3};
  if (image->channels > 3 && strcmp(image->channel[3], "A") == 0) j.samples = 4;
  abbe_file_writer writer = {0};
  abbe_result result = ABBE_OK;
  if (j.samples >= 3 && abbe_rgb_encoding_is_known(image->xy, image->curve) &&
      !abbe_rgb_encoding_is_srgb(image->xy, image->curve))
    result = abbe_rgb_encoding_profile(image->xy, image->curve, &j.icc, &j.icc_size, error);
  if (result == ABBE_OK) result = abbe_file_writer_open(&writer, path, error);
  j.file = writer.stream;
  const bool written = result == ABBE_OK && write_image(&j, image);
  free(j.icc);
  if (written) return abbe_file_writer_commit(&writer, error);
  abbe_file_writer_discard(&writer);
  if (result != ABBE_OK) return result;
  return abbe_error_set(error, j.no_memory ? ABBE_NO_MEMORY : ABBE_IO,
                        "%s: could not be written and is as it was: %s", path,
                        j.no_memory ? "there is no memory for it" : j.message);
}

/* Reading */

/* Besides pixels only the chunks about their colour are read: no text, thumbnail or profile of
 * whatever kind is unpacked in vain. */
static void choose_chunks(const job *j) {
  static const png_byte known[] = "bKGD\0eXIf\0hIST\0iTXt\0oFFs\0pCAL\0pHYs\0sBIT\0sCAL\0"
                                  "sPLT\0sTER\0tEXt\0tIME\0zTXt\0tRNS";
  static const png_byte cicp[] = "cICP"; /* younger than libpng 1.6.45 */
  png_set_keep_unknown_chunks(j->png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
  png_set_keep_unknown_chunks(j->png, PNG_HANDLE_CHUNK_NEVER, known,
                              (int)sizeof known / 5 - j->over_white);
  png_set_keep_unknown_chunks(j->png, PNG_HANDLE_CHUNK_ALWAYS, cicp, 1);
  png_set_chunk_cache_max(j->png, 8);
  png_set_chunk_malloc_max(j->png, MAX_CHUNK_BYTES);
}

static bool read_header(job *j, double file_size) {
  if (setjmp(png_jmpbuf(j->png))) return false;
  png_set_read_fn(j->png, j, read_bytes);
  png_set_user_limits(j->png, MAX_SIDE, MAX_SIDE);
  choose_chunks(j);
  png_read_info(j->png, j->info);
  j->width = png_get_image_width(j->png, j->info);
  j->height = png_get_image_height(j->png, j->info);
  double stored = (double)png_get_rowbytes(j->png, j->info) * j->height;
  if (stored > DEFLATE_RATIO * file_size)
    png_error(j->png, "its header promises more pixels than its bytes can hold");

  png_set_palette_to_rgb(j->png);
  png_set_expand_gray_1_2_4_to_8(j->png);
  png_set_gray_to_rgb(j->png);
  if (j->over_white)
    png_set_tRNS_to_alpha(j->png);
  else
    png_set_strip_alpha(j->png);
  png_set_interlace_handling(j->png);
  png_read_update_info(j->png, j->info);
  j->bits = png_get_bit_depth(j->png, j->info);
  j->samples = png_get_channels(j->png, j->info);
  if (j->samples != 3 && !(j->over_white && j->samples == 4))
    png_error(j->png, "its pixels cannot be expanded to red, green and blue");
  return true;
}

static bool read_rows(job *j) {
  size_t stride = (size_t)j->width * (size_t)j->samples * (size_t)(j->bits / 8);
  j->rows = malloc(stride * j->height);
  j->row = malloc(j->height * sizeof *j->row);
  j->no_memory = j->no_memory || j->rows == NULL || j->row == NULL;
  if (j->no_memory) return false;
  for (size_t y = 0; y < j->height; y++) j->row[y] = j->rows + y * stride;
  if (setjmp(png_jmpbuf(j->png))) return false;
  png_read_image(j->png, j->row);
  png_read_end(j->png, NULL);
  return true;
}

static float sample_of(const job *j, size_t i) {
  return j->bits == 16 ? (float)(256 * j->rows[2 * i] + j->rows[2 * i + 1]) / 65535.0f
                       : (float)j->rows[i] / 255.0f;
}

static void take_samples(const job *j, abbe_image *image) {
  const size_t count = image->width * image->height, samples = (size_t)j->samples;
  for (size_t i = 0; i < 3 * count; i++) image->data[i] = sample_of(j, i / 3 * samples + i % 3);
}

/* Straight alpha, as PNG's is, in light and not in its code. */
static void lay_over_white(const job *j, abbe_image *image) {
  for (size_t i = 0; i < 3 * image->width * image->height && j->samples == 4; i++) {
    const double alpha = (double)sample_of(j, i / 3 * 4 + 3);
    if (alpha < 1)
      image->data[i] = (float)abbe_srgb_encoded(
          1 + alpha * (abbe_rgb_encoding_light(image->curve, (double)image->data[i]) - 1));
  }
}

/* The code points of a display's RGB in full range; false for others. */
static bool decode_cicp(const png_unknown_chunk *chunk, double xy[8], double curve[5]) {
  const png_byte *code = chunk->data;
  return chunk->size == 4 && code[1] < 16 && code[2] == 0 && code[3] == 1 &&
         abbe_rgb_encoding_of_codes(code[0], code[1], xy, curve);
}

/* By gAMA and cHRM, either of which may be missing; sRGB stands in for both. */
static void decode_gamma(const job *j, double xy[8], double curve[5]) {
  double gamma = 0, w[2], r[2], g[2], b[2], rec709[8];
  abbe_rgb_encoding_srgb(xy, curve);
  memcpy(rec709, xy, sizeof rec709);
  if (png_get_cHRM(j->png, j->info, &w[0], &w[1], &r[0], &r[1], &g[0], &g[1], &b[0], &b[1]) != 0) {
    const double stated[8] = {r[0], r[1], g[0], g[1], b[0], b[1], w[0], w[1]};
    memcpy(xy, stated, sizeof stated);
  }
  if (png_get_gAMA(j->png, j->info, &gamma) == 0 || !(gamma > 0)) return;
  /* old readers know sRGB as 1/2.2 with sRGB's primaries */
  const bool srgb = abbe_rgb_encoding_is_srgb(xy, curve) && fabs(gamma * 2.2 - 1) < 1e-3;
  const double power[5] = {1 / gamma, 1, 0, 0, 0};
  if (!srgb) memcpy(curve, power, sizeof power);
}

/* The file's chunks about its colour, in the order in which [PNG2025] ranks them. */
static abbe_result become_srgb(const job *j, abbe_image *image, abbe_error *error) {
  png_unknown_chunkp chunk = NULL;
  png_charp name = NULL;
  png_bytep icc = NULL;
  png_uint_32 size = 0;
  int method = 0;
  abbe_rgb_encoding_srgb(image->xy, image->curve);
  if (png_get_unknown_chunks(j->png, j->info, &chunk) > 0) {
    if (!decode_cicp(chunk, image->xy, image->curve))
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: its cICP chunk says an encoding that is not known here; primaries "
                            "1, 9 or 12 with transfer 1, 4, 5, 6, 8, 13, 14 or 15, matrix 0 and "
                            "full range are",
                            j->path);
  } else if (png_get_valid(j->png, j->info, PNG_INFO_sRGB) != 0) {
    return ABBE_OK;
  } else if (png_get_iCCP(j->png, j->info, &name, &method, &icc, &size) != 0) {
    return abbe_rgb_encoding_profile_to_srgb(image, icc, size, j->path, error);
  } else {
    decode_gamma(j, image->xy, image->curve);
  }
  if (abbe_rgb_encoding_is_srgb(image->xy, image->curve)) return ABBE_OK;
  return abbe_rgb_encoding_to_srgb(image, j->path, error);
}

static abbe_result read_image(job *j, double file_size, abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  j->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, j, on_error, on_warning, j, allocate,
                                    give_back);
  j->info = j->png == NULL ? NULL : png_create_info_struct(j->png);
  j->no_memory = j->info == NULL;
  abbe_result result = ABBE_OK;
  bool read = !j->no_memory && read_header(j, file_size);
  if (read)
    result = abbe_image_check_expansion(j->path, j->width, j->height, 3, (size_t)file_size,
                                        ABBE_PNG_FREE_BYTES, error);
  if (result == ABBE_OK && !(read && read_rows(j) && !j->no_memory)) {
    abbe_result code = j->no_memory ? ABBE_NO_MEMORY : j->io_failed ? ABBE_IO : ABBE_PARSE;
    result = abbe_error_set(error, code, "%s: %s%s", j->path,
                            j->no_memory ? "there is no memory for its pixels"
                                         : "it is not a whole PNG file: ",
                            j->message);
  }
  if (result == ABBE_OK) result = abbe_image_make(j->width, j->height, 3, names, out, error);
  if (result == ABBE_OK) take_samples(j, out);
  if (result == ABBE_OK) result = become_srgb(j, out, error);
  if (result == ABBE_OK) lay_over_white(j, out);
  free(j->rows);
  if (result != ABBE_OK) abbe_image_free(out);
  png_destroy_read_struct(&j->png, &j->info, NULL);
  free(j->row);
  return result;
}

static abbe_result read_file(const char *path, bool over_white, abbe_image *out,
                             abbe_error *error) {
  *out = (abbe_image){0};
  FILE *file;
  size_t size = 0;
  ABBE_TRY(abbe_file_open(path, &file, &size, error));
  job j = {.path = path, .file = file, .over_white = over_white};
  abbe_result result = read_image(&j, (double)size, out, error);
  fclose(file);
  return result;
}

abbe_result abbe_png_read(const char *path, abbe_image *out, abbe_error *error) {
  return read_file(path, false, out, error);
}

abbe_result abbe_png_read_over_white(const char *path, abbe_image *out, abbe_error *error) {
  return read_file(path, true, out, error);
}

/* ---- its text ---- */

/* Chunks up to the pixels, of whatever kind; lengths are the file's own and are not allocated. */
static abbe_result find_text(const char *path, FILE *file, char **out, abbe_error *error) {
  static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  enum { MOST_TEXT = 1 << 16, MOST_CHUNKS = 256 };
  const size_t key = sizeof ABBE_PNG_TEXT;
  unsigned char head[8];
  if (fread(head, sizeof head, 1, file) != 1 || memcmp(head, signature, sizeof head) != 0)
    return abbe_error_set(error, ABBE_PARSE, "%s: it is no PNG", path);
  for (int i = 0; i < MOST_CHUNKS && fread(head, sizeof head, 1, file) == 1; i++) {
    const uint32_t length = png_get_uint_32(head);
    if (memcmp(head + 4, "IDAT", 4) == 0) break;
    char *text = NULL;
    if (memcmp(head + 4, "tEXt", 4) == 0 && length >= key && length <= MOST_TEXT)
      text = calloc(1, length + 1);
    if (text != NULL) {
      const bool own = fread(text, length, 1, file) == 1 && memcmp(text, ABBE_PNG_TEXT, key) == 0;
      if (own) *out = strdup(text + key);
      free(text);
      if (own || fseek(file, 4, SEEK_CUR) != 0) break;
    } else if (length > INT32_MAX || fseek(file, (long)length + 4, SEEK_CUR) != 0) {
      break;
    }
  }
  return ABBE_OK;
}

abbe_result abbe_png_read_text(const char *path, char **out, abbe_error *error) {
  FILE *file;
  *out = NULL;
  ABBE_TRY(abbe_file_open(path, &file, NULL, error));
  abbe_result result = find_text(path, file, out, error);
  fclose(file);
  return result;
}
