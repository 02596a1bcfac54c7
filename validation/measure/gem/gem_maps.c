#include "validation/measure/gem/gem_maps.h"

#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <math.h>

enum { AMOUNTS = ABBE_GEM_AMOUNT_COUNT };

static const char *const names[] = {
#define ABBE_GEM_MAP_NAME(code, name, text) name,
    ABBE_GEM_MAPS(ABBE_GEM_MAP_NAME)
#undef ABBE_GEM_MAP_NAME
};
static const char *const texts[] = {
#define ABBE_GEM_MAP_TEXT(code, name, text) text,
    ABBE_GEM_MAPS(ABBE_GEM_MAP_TEXT)
#undef ABBE_GEM_MAP_TEXT
};

const char *abbe_gem_map_name(abbe_gem_map map) {
  return (unsigned)map < ABBE_GEM_MAP_COUNT ? names[map] : "unknown";
}

const char *abbe_gem_map_text(abbe_gem_map map) {
  return (unsigned)map < ABBE_GEM_MAP_COUNT ? texts[map] : "unknown";
}

/* Sums over the pixel's rays, which make cover of it. */
static void sum_amounts(const abbe_gem_view *v, size_t pixel, double sum[AMOUNTS]) {
  for (int a = 0; a < AMOUNTS; a++) sum[a] = 0;
  for (size_t r = 0; r < v->repeats; r++)
    for (int a = 0; a < AMOUNTS; a++)
      sum[a] += (double)v->amount[(pixel * v->repeats + r) * AMOUNTS + (size_t)a];
  for (int a = 0; a < AMOUNTS; a++) sum[a] /= (double)v->repeats;
}

/* Linear, of a share of light each; chosen to be distinguishable. */
static const double green[3] = {0.02, 0.55, 0.06}, red[3] = {0.80, 0.02, 0.03},
                    blue[3] = {0.04, 0.12, 0.85};

static void paint(const abbe_gem_view *v, size_t pixel, abbe_gem_map map, double rgb[3]) {
  double a[AMOUNTS];
  sum_amounts(v, pixel, a);
  for (int c = 0; c < 3; c++) switch (map) {
    case ABBE_GEM_MAP_ISO:
      rgb[c] = a[ABBE_GEM_ISO];
      break;
    case ABBE_GEM_MAP_COS:
      rgb[c] = a[ABBE_GEM_COS];
      break;
    case ABBE_GEM_MAP_LEAKAGE:
      rgb[c] = a[ABBE_GEM_DOWN];
      break;
    case ABBE_GEM_MAP_ASET:
      rgb[c] = green[c] * a[ABBE_GEM_GREEN] + red[c] * a[ABBE_GEM_RED] + blue[c] * a[ABBE_GEM_BLUE];
      break;
    case ABBE_GEM_MAP_IDEAL: /* the hole for the eye is black */
      rgb[c] = red[c] * (a[ABBE_GEM_GREEN] + a[ABBE_GEM_RED]) + a[ABBE_GEM_BELOW];
      break;
    default:
      rgb[c] = (double)v->xyz[3 * pixel + (size_t)c];
    }
  if (map != ABBE_GEM_MAP_COLOUR) return;
  double matrix[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, rgb, rgb);
}

/* [IEC61966] */
static double encode(double light) {
  const double x = fmin(fmax(light, 0), 1);
  return abbe_srgb_encoded(x);
}

abbe_result abbe_gem_map_paint(const abbe_gem_view *v, abbe_gem_map map, abbe_image *out,
                               abbe_error *error) {
  static const char *const channels[] = {"R", "G", "B"};
  ABBE_TRY(abbe_image_make(v->side, v->side, 3, channels, out, error));
  abbe_rgb_encoding_srgb(out->xy, out->curve);
  for (size_t i = 0; i < v->side * v->side; i++) {
    double rgb[3];
    paint(v, i, map, rgb);
    for (size_t c = 0; c < 3; c++)
      out->data[3 * i + c] = (float)encode(rgb[c] + 1 - (double)v->cover[i]);
  }
  return ABBE_OK;
}

abbe_result abbe_gem_map_image(const abbe_gem_view *v, abbe_image *out, abbe_error *error) {
  enum { CHANNELS = 4 + AMOUNTS };
  const char *channels[CHANNELS] = {"X", "Y", "Z", "cover"};
  for (int a = 0; a < AMOUNTS; a++) channels[4 + a] = abbe_gem_amount_name((abbe_gem_amount)a);
  abbe_result result = abbe_image_make(v->side, v->side, CHANNELS, channels, out, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < v->side * v->side; i++) {
    float *to = out->data + i * CHANNELS;
    double sum[AMOUNTS];
    const double cover = (double)v->cover[i];
    sum_amounts(v, i, sum);
    to[3] = v->cover[i];
    for (size_t c = 0; c < 3 && cover > 0; c++) to[c] = (float)((double)v->xyz[3 * i + c] / cover);
    for (int a = 0; a < AMOUNTS && cover > 0; a++) to[4 + a] = (float)(sum[a] / cover);
  }
  result =
      abbe_image_set_attribute(out, "abbe:space", abbe_rgb_space_name(ABBE_RGB_SPACE_XYZ), error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
