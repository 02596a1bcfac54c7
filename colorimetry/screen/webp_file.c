#include "colorimetry/screen/screen_file.h"

#include "base/file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <math.h>
#include <stdlib.h>
#include <webp/encode.h>
#include <webp/mux.h>

/* A still picture is what a PNG of 8 bits would hold. */
enum { LOSSLESS_EFFORT = 6, MOVING_QUALITY = 90 };

static abbe_result fail(const char *path, const char *why, abbe_error *error) {
  return abbe_error_set(error, ABBE_IO, "%s: it cannot be encoded: %s", path, why);
}

static bool import(WebPPicture *p, const unsigned char *pixel, size_t samples) {
  const int stride = p->width * (int)samples;
  p->use_argb = 1;
  return samples == 4 ? WebPPictureImportRGBA(p, pixel, stride) != 0
                      : WebPPictureImportRGB(p, pixel, stride) != 0;
}

static abbe_result check_sides(const char *path, size_t width, size_t height, abbe_error *error) {
  if (width <= WEBP_MAX_DIMENSION && height <= WEBP_MAX_DIMENSION) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: WebP has at most %d pixels a side", path,
                        WEBP_MAX_DIMENSION);
}

/* The file of what was encoded, with a profile where the picture is not sRGB. */
static abbe_result wrap(const char *path, const abbe_image *image, const WebPMemoryWriter *encoded,
                        abbe_error *error) {
  void *icc = NULL;
  size_t size = 0;
  WebPData file = {NULL, 0}, picture = {encoded->mem, encoded->size};
  if (!abbe_rgb_encoding_is_known(image->xy, image->curve) ||
      abbe_rgb_encoding_is_srgb(image->xy, image->curve))
    return abbe_file_write(path, encoded->mem, encoded->size, error);
  abbe_result result = abbe_rgb_encoding_profile(image->xy, image->curve, &icc, &size, error);
  WebPMux *mux = result == ABBE_OK ? WebPMuxCreate(&picture, 0) : NULL;
  const WebPData profile = {icc, size};
  const bool whole = mux != NULL && WebPMuxSetChunk(mux, "ICCP", &profile, 0) == WEBP_MUX_OK &&
                     WebPMuxAssemble(mux, &file) == WEBP_MUX_OK;
  if (result == ABBE_OK)
    result = whole ? abbe_file_write(path, file.bytes, file.size, error)
                   : fail(path, "its profile does not go in", error);
  WebPDataClear(&file);
  WebPMuxDelete(mux);
  free(icc);
  return result;
}

abbe_result abbe_webp_write(const char *path, const abbe_image *image, int bits,
                            abbe_error *error) {
  const size_t samples = abbe_screen_file_samples(image);
  unsigned char *pixel = NULL;
  WebPConfig config;
  WebPPicture p;
  WebPMemoryWriter out;
  (void)bits;
  abbe_result result = check_sides(path, image->width, image->height, error);
  if (result == ABBE_OK) result = abbe_screen_file_bytes(path, image, samples, &pixel, error);
  if (result != ABBE_OK) return result;
  WebPMemoryWriterInit(&out);
  if (!WebPConfigInit(&config) || !WebPConfigLosslessPreset(&config, LOSSLESS_EFFORT) ||
      !WebPPictureInit(&p)) {
    free(pixel);
    return fail(path, "libwebp is of another version", error);
  }
  config.exact = 1;
  p.width = (int)image->width;
  p.height = (int)image->height;
  p.writer = WebPMemoryWrite;
  p.custom_ptr = &out;
  result = import(&p, pixel, samples) && WebPEncode(&config, &p)
               ? wrap(path, image, &out, error)
               : fail(path, "libwebp has no memory", error);
  WebPPictureFree(&p);
  WebPMemoryWriterClear(&out);
  free(pixel);
  return result;
}

/* ---- one that moves ---- */

typedef struct moving {
  const char *path;
  size_t width, height;
  WebPAnimEncoder *encoder;
  WebPConfig config;
} moving;

static abbe_result begin(moving *m, abbe_error *error) {
  WebPAnimEncoderOptions options;
  if (m->encoder != NULL) return ABBE_OK;
  ABBE_TRY(check_sides(m->path, m->width, m->height, error));
  if (!WebPConfigInit(&m->config) || !WebPAnimEncoderOptionsInit(&options))
    return fail(m->path, "libwebp is of another version", error);
  m->config.quality = MOVING_QUALITY;
  m->config.use_sharp_yuv = 1;
  m->encoder = WebPAnimEncoderNew((int)m->width, (int)m->height, &options);
  return m->encoder != NULL ? ABBE_OK : fail(m->path, "libwebp has no memory", error);
}

static abbe_result add_frame(moving *m, const char *frame, int at_ms, abbe_error *error) {
  unsigned char *pixel = NULL;
  WebPPicture p;
  abbe_result result = abbe_screen_file_frame(frame, &m->width, &m->height, &pixel, error);
  if (result == ABBE_OK) result = begin(m, error);
  if (result == ABBE_OK && WebPPictureInit(&p)) {
    p.width = (int)m->width;
    p.height = (int)m->height;
    if (!import(&p, pixel, 3) || !WebPAnimEncoderAdd(m->encoder, &p, at_ms, &m->config))
      result = fail(frame, WebPAnimEncoderGetError(m->encoder), error);
    WebPPictureFree(&p);
  }
  free(pixel);
  return result;
}

abbe_result abbe_webp_move(const char *path, const char *const *frame, size_t count,
                           double per_second, abbe_error *error) {
  moving m = {.path = path};
  WebPData out = {NULL, 0};
  abbe_result result = ABBE_OK;
  if ((double)count * 1000 / per_second > INT32_MAX)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: it would last longer than WebP can",
                          path);
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = add_frame(&m, frame[i], (int)lround((double)i * 1000 / per_second), error);
  if (result == ABBE_OK &&
      (!WebPAnimEncoderAdd(m.encoder, NULL, (int)lround((double)count * 1000 / per_second), NULL) ||
       !WebPAnimEncoderAssemble(m.encoder, &out)))
    result = fail(path, WebPAnimEncoderGetError(m.encoder), error);
  if (result == ABBE_OK) result = abbe_file_write(path, out.bytes, out.size, error);
  WebPDataClear(&out);
  WebPAnimEncoderDelete(m.encoder);
  return result;
}
