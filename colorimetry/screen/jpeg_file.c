#include "colorimetry/screen/screen_file.h"

#include "base/file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <setjmp.h>
#include <stdlib.h>

#include <jpeglib.h>

enum { QUALITY = 95 };

typedef struct job {
  struct jpeg_error_mgr manager; /* the first: libjpeg hands it back */
  jmp_buf back;
  char why[JMSG_LENGTH_MAX];
  struct jpeg_compress_struct c;
  unsigned char *pixel, *out;
  unsigned long size;
  void *icc;
  size_t icc_size;
} job;

static void on_error(j_common_ptr c) {
  job *j = (job *)c->err;
  c->err->format_message(c, j->why);
  longjmp(j->back, 1);
}

static void on_message(j_common_ptr c, int level) {
  (void)c;
  (void)level;
}

/* Colour of each pixel's own (4:4:4): a stone's fire is narrow. */
static bool compress(job *j, const abbe_image *image) {
  j->c.err = jpeg_std_error(&j->manager);
  j->manager.error_exit = on_error;
  j->manager.emit_message = on_message;
  if (setjmp(j->back)) return false;
  jpeg_create_compress(&j->c);
  jpeg_mem_dest(&j->c, &j->out, &j->size);
  j->c.image_width = (JDIMENSION)image->width;
  j->c.image_height = (JDIMENSION)image->height;
  j->c.input_components = 3;
  j->c.in_color_space = JCS_RGB;
  jpeg_set_defaults(&j->c);
  jpeg_set_quality(&j->c, QUALITY, TRUE);
  j->c.comp_info[0].h_samp_factor = j->c.comp_info[0].v_samp_factor = 1;
  j->c.optimize_coding = TRUE;
  jpeg_simple_progression(&j->c);
  jpeg_start_compress(&j->c, TRUE);
  if (j->icc != NULL) jpeg_write_icc_profile(&j->c, j->icc, (unsigned)j->icc_size);
  while (j->c.next_scanline < j->c.image_height) {
    JSAMPROW row = j->pixel + 3 * image->width * j->c.next_scanline;
    jpeg_write_scanlines(&j->c, &row, 1);
  }
  jpeg_finish_compress(&j->c);
  return true;
}

abbe_result abbe_jpeg_write(const char *path, const abbe_image *image, int bits,
                            abbe_error *error) {
  job j = {.why = ""};
  (void)bits;
  abbe_result result = abbe_screen_file_bytes(path, image, 3, &j.pixel, error);
  if (result == ABBE_OK && abbe_rgb_encoding_is_known(image->xy, image->curve))
    result = abbe_rgb_encoding_profile(image->xy, image->curve, &j.icc, &j.icc_size, error);
  if (result == ABBE_OK && !compress(&j, image))
    result = abbe_error_set(error, ABBE_IO, "%s: it cannot be encoded: %s", path, j.why);
  if (result == ABBE_OK) result = abbe_file_write(path, j.out, j.size, error);
  jpeg_destroy_compress(&j.c);
  free(j.out);
  free(j.icc);
  free(j.pixel);
  return result;
}
