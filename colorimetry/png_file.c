#include "colorimetry/png_file.h"

#include "spectral/file.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_SIDE = 16384, MAX_CHUNK_BYTES = 16 << 20, DEFLATE_RATIO = 1032 };

/* One file under way. libpng leaves by longjmp, so what must outlive that lives here. */
typedef struct job {
  const char *path;
  FILE *file;
  png_structp png;
  png_infop info;
  png_bytep rows;
  png_bytep *row;
  png_uint_32 width, height;
  int bits, samples; /* of a row's pixel in memory */
  bool io_failed, no_memory;
  char message[256];
} job;

static void on_error(png_structp png, png_const_charp message) {
  job *j = png_get_error_ptr(png);
  if (j->message[0] == '\0') snprintf(j->message, sizeof j->message, "%s", message);
  longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message) {
  (void)png, (void)message;
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

static bool write_rows(job *j, const abbe_image *image) {
  if (setjmp(png_jmpbuf(j->png))) return false;
  png_set_write_fn(j->png, j, write_bytes, flush_bytes);
  png_set_user_limits(j->png, ABBE_IMAGE_MAX_SIDE, ABBE_IMAGE_MAX_SIDE);
  png_set_IHDR(j->png, j->info, (png_uint_32)image->width, (png_uint_32)image->height, j->bits,
               j->samples == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(j->png, j->info);
  for (size_t y = 0; y < image->height; y++) {
    fill_row(image, y, j);
    png_write_row(j->png, j->rows);
  }
  png_write_end(j->png, NULL);
  return true;
}

static bool write_image(job *j, const abbe_image *image) {
  j->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, j, on_error, on_warning);
  j->info = j->png == NULL ? NULL : png_create_info_struct(j->png);
  j->rows = malloc(image->width * (size_t)j->samples * (size_t)(j->bits / 8));
  j->no_memory = j->info == NULL || j->rows == NULL;
  bool written = !j->no_memory && write_rows(j, image);
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
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  job j = {
      .path = path, .file = writer.stream, .bits = bits, .samples = image->channels >= 3 ? 3 : 1};
  if (write_image(&j, image)) return abbe_file_writer_commit(&writer, error);
  abbe_file_writer_discard(&writer);
  return abbe_error_set(error, j.no_memory ? ABBE_NO_MEMORY : ABBE_IO,
                        "%s: it cannot be written: %s", path,
                        j.no_memory ? "there is no memory for a row" : j.message);
}

/* Reading */

static bool read_header(job *j, double file_size) {
  if (setjmp(png_jmpbuf(j->png))) return false;
  png_set_read_fn(j->png, j, read_bytes);
  png_set_user_limits(j->png, MAX_SIDE, MAX_SIDE);
  png_set_chunk_malloc_max(j->png, MAX_CHUNK_BYTES);
  png_read_info(j->png, j->info);
  j->width = png_get_image_width(j->png, j->info);
  j->height = png_get_image_height(j->png, j->info);
  double stored = (double)png_get_rowbytes(j->png, j->info) * j->height;
  if (stored > DEFLATE_RATIO * file_size)
    png_error(j->png, "its header promises more pixels than its bytes can hold");

  png_set_palette_to_rgb(j->png);
  png_set_expand_gray_1_2_4_to_8(j->png);
  png_set_gray_to_rgb(j->png);
  png_set_strip_alpha(j->png);
  png_set_interlace_handling(j->png);
  png_read_update_info(j->png, j->info);
  j->bits = png_get_bit_depth(j->png, j->info);
  j->samples = png_get_channels(j->png, j->info);
  if (j->samples != 3) png_error(j->png, "its pixels cannot be expanded to red, green and blue");
  return true;
}

static bool read_rows(job *j) {
  size_t stride = (size_t)j->width * 3 * (size_t)(j->bits / 8);
  j->rows = malloc(stride * j->height);
  j->row = malloc(j->height * sizeof *j->row);
  j->no_memory = j->rows == NULL || j->row == NULL;
  if (j->no_memory) return false;
  for (size_t y = 0; y < j->height; y++) j->row[y] = j->rows + y * stride;
  if (setjmp(png_jmpbuf(j->png))) return false;
  png_read_image(j->png, j->row);
  png_read_end(j->png, NULL);
  return true;
}

static void take_samples(const job *j, abbe_image *image) {
  size_t count = image->width * image->height * 3;
  for (size_t i = 0; i < count; i++)
    image->data[i] = j->bits == 16 ? (float)(256 * j->rows[2 * i] + j->rows[2 * i + 1]) / 65535.0f
                                   : (float)j->rows[i] / 255.0f;
}

static abbe_result read_image(job *j, double file_size, abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  j->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, j, on_error, on_warning);
  j->info = j->png == NULL ? NULL : png_create_info_struct(j->png);
  j->no_memory = j->info == NULL;
  abbe_result result = ABBE_OK;
  if (j->no_memory || !read_header(j, file_size) || !read_rows(j)) {
    abbe_result code = j->no_memory ? ABBE_NO_MEMORY : j->io_failed ? ABBE_IO : ABBE_PARSE;
    result = abbe_error_set(error, code, "%s: %s%s", j->path,
                            j->no_memory ? "there is no memory for its pixels"
                                         : "it is not a whole PNG file: ",
                            j->message);
  }
  if (result == ABBE_OK) result = abbe_image_make(j->width, j->height, 3, names, out, error);
  if (result == ABBE_OK) take_samples(j, out);
  png_destroy_read_struct(&j->png, &j->info, NULL);
  free(j->row);
  free(j->rows);
  return result;
}

abbe_result abbe_png_read(const char *path, abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  FILE *file = fopen(path, "rb");
  struct stat status;
  if (file == NULL || fstat(fileno(file), &status) != 0) {
    int why = errno;
    if (file != NULL) fclose(file);
    return abbe_error_set(error, ABBE_IO, "%s: it cannot be read: %s", path, strerror(why));
  }
  abbe_result result = ABBE_OK;
  if (!S_ISREG(status.st_mode))
    result =
        abbe_error_set(error, ABBE_IO, "%s: it is not a file that can be read as a picture", path);
  job j = {.path = path, .file = file};
  if (result == ABBE_OK) result = read_image(&j, (double)status.st_size, out, error);
  fclose(file);
  return result;
}
