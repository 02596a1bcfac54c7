#include "colorimetry/screen/screen_file.h"

#include "colorimetry/image/png_file.h"

#include <string.h>
#include <strings.h>

#ifdef ABBE_HAS_AVIF
#define AVIF(writer) NULL, writer
#else
#define AVIF(writer) "libavif", NULL
abbe_result abbe_avif_read(const char *path, abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: this abbe was built without libavif; a .png can be read", path);
}
#endif
#ifdef ABBE_HAS_JPEG
#define JPEG(writer) NULL, writer
#else
#define JPEG(writer) "libjpeg-turbo", NULL
#endif
#ifdef ABBE_HAS_WEBP
#define WEBP(writer, mover) NULL, writer, mover
#else
#define WEBP(writer, mover) "libwebp", NULL, NULL
#endif

static const abbe_screen_kind kinds[] = {
    {".png", "PNG", "8 or 16", {8, 16}, true, NULL, abbe_png_write, abbe_animated_png_write, 1000},
    {".avif", "AVIF", "10 or 12", {10, 12}, false, AVIF(abbe_avif_write), NULL, 0},
    {".webp", "WebP", "8", {8, 8}, true, WEBP(abbe_webp_write, abbe_webp_move), 1000},
    {".gif", "GIF", "8", {8, 8}, false, NULL, abbe_gif_write, abbe_gif_move, 50},
    {".jpg", "JPEG", "8", {8, 8}, false, JPEG(abbe_jpeg_write), NULL, 0},
    {".jpeg", "JPEG", "8", {8, 8}, false, JPEG(abbe_jpeg_write), NULL, 0}};

const abbe_screen_kind *abbe_screen_kind_of(const char *path) {
  const char *dot = path != NULL ? strrchr(path, '.') : NULL;
  for (size_t i = 0; dot != NULL && i < sizeof kinds / sizeof *kinds; i++)
    if (strcasecmp(dot, kinds[i].ending) == 0) return &kinds[i];
  return NULL;
}

static const abbe_screen_kind *kind_or_png(const char *path) {
  const abbe_screen_kind *kind = abbe_screen_kind_of(path);
  return kind != NULL ? kind : &kinds[0];
}

abbe_result abbe_screen_file_check(const char *path, const abbe_screen_file_needs *needs,
                                   abbe_error *error) {
  const abbe_screen_kind *kind = kind_or_png(path);
  if (kind->library != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: this abbe was built without %s; a .png can be written", path,
                          kind->library);
  if (needs->bits != 0 && needs->bits != kind->bit[0] && needs->bits != kind->bit[1])
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a file of kind %s has %s bits, not %d; a PNG has 8 or 16, an AVIF "
                          "10 or 12, the others 8",
                          path, kind->name, kind->bits, needs->bits);
  if (needs->alpha && !kind->alpha)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: %s holds no transparency here; .png and .webp do", path, kind->name);
  if (needs->moves && kind->move == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: %s does not move here; .png, .webp and .gif do", path, kind->name);
  if (needs->moves && !(needs->per_second >= 0.1 && needs->per_second <= kind->most_per_second))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a %s shows 0.1 to %g frames a second, not %g", path, kind->name,
                          kind->most_per_second, needs->per_second);
  if (needs->transfer != 0 && kind->bit[1] == 8)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: PQ and HLG are held by .png and .avif, not by %s", path, kind->name);
  if (needs->transfer != 0 && needs->bits == 8)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: PQ and HLG are written with 16 bits",
                          path);
  return ABBE_OK;
}

abbe_result abbe_screen_file_write(const char *path, const abbe_image *image, int bits,
                                   abbe_error *error) {
  const abbe_screen_kind *kind = kind_or_png(path);
  const abbe_screen_file_needs needs = {.bits = bits, .transfer = image->transfer};
  ABBE_TRY(abbe_screen_file_check(path, &needs, error));
  const bool png = kind == &kinds[0];
  if (image->data == NULL || (!png && image->channels < 3))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: there are no R, G, B to write", path);
  if (bits == 0) bits = kind->bit[png && image->transfer != 0];
  return kind->write(path, image, bits, error);
}

abbe_result abbe_screen_file_move(const char *path, const char *const *frame, size_t count,
                                  double per_second, abbe_error *error) {
  const abbe_screen_file_needs needs = {.moves = true, .per_second = per_second};
  ABBE_TRY(abbe_screen_file_check(path, &needs, error));
  if (count == 0 || count > 1000000)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: of %zu frames; 1 to 1000000 can move",
                          path, count);
  return kind_or_png(path)->move(path, frame, count, per_second, error);
}
