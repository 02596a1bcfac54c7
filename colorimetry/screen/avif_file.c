#include "colorimetry/screen/screen_file.h"

#include "base/file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <avif/avif.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Quantizers from 0 to 63: no step of an even picture is seen. */
enum { BEST = 0, WORST = 8, SPEED = 6 };
#define MOST_BYTES ((size_t)1 << 30)  /* of a file that is read, */
#define MOST_FREE ((size_t)256 << 20) /* and of pixels however small it is */

static abbe_result fail(const char *path, avifResult why, abbe_error *error) {
  return abbe_error_set(error, why == AVIF_RESULT_OUT_OF_MEMORY ? ABBE_NO_MEMORY : ABBE_IO,
                        "%s: it cannot be encoded: %s", path, avifResultToString(why));
}

/* [H273]: primaries, transfer, matrix. */
static abbe_result set_colour(const abbe_image *image, avifImage *out, abbe_error *error) {
  enum { SRGB = 13, UNSPECIFIED = 2 };
  double p3_xy[8], p3_curve[5];
  abbe_rgb_encoding_display_p3(p3_xy, p3_curve);
  const int code = abbe_rgb_encoding_primaries_code(image->xy);
  const bool curved = memcmp(image->curve, p3_curve, sizeof p3_curve) == 0 ||
                      abbe_rgb_encoding_is_srgb(image->xy, image->curve);
  const bool said = code != 0 && (image->transfer != 0 || curved);
  out->yuvRange = AVIF_RANGE_FULL;
  out->colorPrimaries = (avifColorPrimaries)(said ? code : UNSPECIFIED);
  out->transferCharacteristics =
      (avifTransferCharacteristics)(!said                  ? UNSPECIFIED
                                    : image->transfer != 0 ? image->transfer
                                                           : SRGB);
  out->matrixCoefficients = code == AVIF_COLOR_PRIMARIES_BT2020
                                ? AVIF_MATRIX_COEFFICIENTS_BT2020_NCL
                                : AVIF_MATRIX_COEFFICIENTS_BT709;
  if (said || !abbe_rgb_encoding_is_known(image->xy, image->curve)) return ABBE_OK;
  ABBE_FREED void *icc = NULL;
  size_t size = 0;
  ABBE_TRY(abbe_rgb_encoding_profile(image->xy, image->curve, &icc, &size, error));
  avifImageSetProfileICC(out, icc, size);
  return ABBE_OK;
}

static uint16_t *quantize(const abbe_image *image, int bits) {
  const float top = (float)((1 << bits) - 1);
  uint16_t *pixel = malloc(image->width * image->height * 3 * sizeof *pixel);
  for (size_t p = 0; pixel != NULL && p < image->width * image->height; p++)
    for (size_t k = 0; k < 3; k++) {
      const float v = image->data[p * image->channels + k]; /* not-a-number is not above 0 */
      pixel[3 * p + k] = (uint16_t)lroundf(top * (v > 0 ? fminf(v, 1) : 0));
    }
  return pixel;
}

static abbe_result fill(const char *path, const abbe_image *image, int bits, avifImage *out,
                        abbe_error *error) {
  avifRGBImage rgb;
  avifRGBImageSetDefaults(&rgb, out);
  rgb.format = AVIF_RGB_FORMAT_RGB;
  rgb.depth = (uint32_t)bits;
  uint16_t *pixel = quantize(image, bits);
  if (pixel == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for its pixels", path);
  rgb.pixels = (uint8_t *)pixel;
  rgb.rowBytes = (uint32_t)(3 * image->width * sizeof *pixel);
  const avifResult filled = avifImageRGBToYUV(out, &rgb);
  free(pixel);
  return filled == AVIF_RESULT_OK ? ABBE_OK : fail(path, filled, error);
}

static abbe_result encode(const char *path, const avifImage *image, abbe_error *error) {
  avifEncoder *encoder = avifEncoderCreate();
  avifRWData bytes = AVIF_DATA_EMPTY;
  if (encoder == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory to encode it", path);
  encoder->minQuantizer = BEST;
  encoder->maxQuantizer = WORST;
  encoder->speed = SPEED;
  const avifResult encoded = avifEncoderWrite(encoder, image, &bytes);
  abbe_result result = encoded == AVIF_RESULT_OK ? ABBE_OK : fail(path, encoded, error);
  if (result == ABBE_OK) result = abbe_file_write(path, bytes.data, bytes.size, error);
  avifRWDataFree(&bytes);
  avifEncoderDestroy(encoder);
  return result;
}

/* libavif before 1.3 counts an image's bytes in 32 bits. */
enum { MOST_PIXELS = ABBE_IMAGE_MAX_SIDE * (ABBE_IMAGE_MAX_SIDE / 8) };

/* In full range and without sharing of colour among pixels (4:4:4). */
abbe_result abbe_avif_write(const char *path, const abbe_image *image, int bits,
                            abbe_error *error) {
  if (image->transfer != 0 && abbe_rgb_encoding_primaries_code(image->xy) == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: PQ and HLG are written for the primaries of Rec.709, Rec.2020 or P3",
                          path);
  if (image->width * image->height > MOST_PIXELS)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: an AVIF of %zu x %zu pixels is not written; up to %d can be", path,
                          image->width, image->height, MOST_PIXELS);
  avifImage *out = avifImageCreate((uint32_t)image->width, (uint32_t)image->height, (uint32_t)bits,
                                   AVIF_PIXEL_FORMAT_YUV444);
  if (out == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for its pixels", path);
  abbe_result result = set_colour(image, out, error);
  if (result == ABBE_OK) result = fill(path, image, bits, out, error);
  if (result == ABBE_OK) result = encode(path, out, error);
  avifImageDestroy(out);
  return result;
}

/* ---- reading ---- */

static abbe_result unread(const char *path, avifResult why, abbe_error *error) {
  return abbe_error_set(error, why == AVIF_RESULT_OUT_OF_MEMORY ? ABBE_NO_MEMORY : ABBE_PARSE,
                        "%s: it cannot be read as AVIF: %s", path, avifResultToString(why));
}

/* What its numbers mean, which is sRGB where the file does not say it. */
static abbe_result take_colour(const char *path, const avifImage *from, abbe_image *image,
                               abbe_error *error) {
  enum { UNSPECIFIED = 2 };
  const int primaries = from->colorPrimaries == UNSPECIFIED ? 1 : from->colorPrimaries;
  const int transfer =
      from->transferCharacteristics == UNSPECIFIED ? 13 : from->transferCharacteristics;
  if (from->icc.size > 0)
    return abbe_rgb_encoding_profile_to_srgb(image, from->icc.data, from->icc.size, path, error);
  if (!abbe_rgb_encoding_of_codes(primaries, transfer, image->xy, image->curve))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: its primaries %d and transfer %d are not known here; primaries 1, 9 "
                          "or 12 with transfer 1, 4, 5, 6, 8, 13 to 16 or 18 are",
                          path, primaries, transfer);
  if (transfer == 16 || transfer == 18) image->transfer = transfer;
  return ABBE_OK;
}

static abbe_result take_pixels(const char *path, const avifImage *from, abbe_image *image,
                               abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  avifRGBImage rgb;
  ABBE_TRY(abbe_image_make(from->width, from->height, 3, names, image, error));
  const size_t count = 3 * image->width * image->height;
  uint16_t *pixel = malloc(count * sizeof *pixel);
  if (pixel == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for its pixels", path);
  avifRGBImageSetDefaults(&rgb, from);
  rgb.format = AVIF_RGB_FORMAT_RGB;
  rgb.depth = 16;
  rgb.pixels = (uint8_t *)pixel;
  rgb.rowBytes = (uint32_t)(3 * image->width * sizeof *pixel);
  const avifResult made = avifImageYUVToRGB(from, &rgb);
  for (size_t i = 0; made == AVIF_RESULT_OK && i < count; i++)
    image->data[i] = (float)pixel[i] / 65535;
  free(pixel);
  return made == AVIF_RESULT_OK ? take_colour(path, from, image, error) : unread(path, made, error);
}

static abbe_result decode(const char *path, avifDecoder *decoder, const char *data, size_t size,
                          abbe_image *image, abbe_error *error) {
  const avifTransformFlags turns = AVIF_TRANSFORM_CLAP | AVIF_TRANSFORM_IROT | AVIF_TRANSFORM_IMIR;
  avifResult done = avifDecoderSetIOMemory(decoder, (const uint8_t *)data, size);
  decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
  decoder->imageSizeLimit = MOST_PIXELS;
  if (done == AVIF_RESULT_OK) done = avifDecoderParse(decoder);
  if (done != AVIF_RESULT_OK) return unread(path, done, error);
  const avifImage *from = decoder->image;
  if ((from->transformFlags & turns) != 0)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "%s: it is to be turned, mirrored or cut out (irot, imir, clap), which is "
        "not done here; save it upright",
        path);
  ABBE_TRY(abbe_image_check_expansion(path, from->width, from->height, 3, size, MOST_FREE, error));
  done = avifDecoderNextImage(decoder);
  return done == AVIF_RESULT_OK ? take_pixels(path, from, image, error) : unread(path, done, error);
}

abbe_result abbe_avif_read(const char *path, abbe_image *out, abbe_error *error) {
  char *data = NULL;
  size_t size = 0;
  abbe_image image = {0};
  *out = image;
  ABBE_TRY(abbe_file_read(path, MOST_BYTES, &data, &size, error));
  avifDecoder *decoder = avifDecoderCreate();
  abbe_result result = decoder != NULL
                           ? decode(path, decoder, data, size, &image, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for it", path);
  if (decoder != NULL) avifDecoderDestroy(decoder);
  free(data);
  if (result == ABBE_OK)
    *out = image;
  else
    abbe_image_free(&image);
  return result;
}
