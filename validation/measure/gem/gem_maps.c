#include "validation/measure/gem/gem_maps.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

static const char COLUMNS[] = "pair,crown_rad,pavilion_rad,value,standard_error";
enum { ASKED_SIZE = 400, MOST_BYTES = 1 << 24 };

/* What must be alike for tables to go together. */
static void asked(const abbe_gem_optimum *o, char out[ASKED_SIZE]) {
  char crown[2][ABBE_NUMBER_TEXT_SIZE], pavilion[2][ABBE_NUMBER_TEXT_SIZE];
  char value[ABBE_NUMBER_TEXT_SIZE];
  snprintf(out, ASKED_SIZE,
           "%s of %zu x %zu angles, crown %s to %s rad, pavilion %s to %s rad; the design has %s",
           abbe_gem_amount_name(o->measure), o->crowns, o->pavilions,
           abbe_number_text(o->crown_rad[0], crown[0]),
           abbe_number_text(o->crown_rad[o->crowns - 1], crown[1]),
           abbe_number_text(o->pavilion_rad[0], pavilion[0]),
           abbe_number_text(o->pavilion_rad[o->pavilions - 1], pavilion[1]),
           abbe_number_text(o->design.value, value));
}

static void write_row(FILE *to, const abbe_gem_optimum *o, size_t i) {
  const double cell[] = {o->crown_rad[i % o->crowns], o->pavilion_rad[i / o->crowns],
                         o->value[i].value, o->value[i].error};
  fprintf(to, "%zu", i);
  for (size_t k = 0; k < sizeof cell / sizeof cell[0]; k++) {
    char text[ABBE_NUMBER_TEXT_SIZE];
    fprintf(to, ",%s", abbe_number_text(cell[k], text));
  }
  fputc('\n', to);
}

abbe_result abbe_gem_grid_file_write(const char *path, const abbe_gem_optimum *o,
                                     abbe_error *error) {
  assert(o->value);
  abbe_file_writer writer = {0};
  char text[ASKED_SIZE];
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  asked(o, text);
  fprintf(writer.stream, "# asked: %s\n%s\n", text, COLUMNS);
  for (size_t i = 0; i < o->crowns * o->pavilions; i++)
    if (!isnan(o->value[i].value)) write_row(writer.stream, o, i);
  return abbe_file_writer_commit(&writer, error);
}

/* ---- reading ---- */

static abbe_result read_row(const char *path, size_t line, const char *row, abbe_gem_optimum *o,
                            abbe_error *error) {
  double cell[5];
  const char *at = row;
  for (int k = 0; k < 5; k++) {
    const char *end;
    if (!abbe_number_read(at, &end, &cell[k]) || !isfinite(cell[k]) || *end != (k < 4 ? ',' : '\0'))
      return abbe_error_set(error, ABBE_PARSE,
                            "%s: line %zu: column %d of five numbers, %s, is none", path, line,
                            k + 1, COLUMNS);
    at = end + 1;
  }
  const double pairs = (double)(o->crowns * o->pavilions);
  if (!(cell[0] >= 0 && cell[0] < pairs && cell[0] == floor(cell[0])))
    return abbe_error_set(error, ABBE_PARSE, "%s: line %zu: pair %g of 0 to %.0f", path, line,
                          cell[0], pairs - 1);
  const size_t i = (size_t)cell[0];
  if (!isnan(o->value[i].value))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: line %zu: pair %zu is known already; is a table given twice?", path,
                          line, i);
  abbe_gem_optimum_know(o, i, (abbe_gem_number){cell[3], cell[4]});
  return ABBE_OK;
}

static abbe_result read_head(const char *path, size_t line, const char *row,
                             const abbe_gem_optimum *o, abbe_error *error) {
  static const char MARK[] = "# asked: ";
  char text[ASKED_SIZE];
  asked(o, text);
  if (line == 1 && strncmp(row, MARK, sizeof MARK - 1) != 0)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: no table of a part of a search; it begins with '%s'", path, MARK);
  if (line == 1 && strcmp(row + sizeof MARK - 1, text) != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s is of another search: it has %.300s; asked now is %.300s", path,
                          row + sizeof MARK - 1, text);
  if (line == 2 && strcmp(row, COLUMNS) != 0)
    return abbe_error_set(error, ABBE_PARSE, "%s: line 2: the columns are not %s", path, COLUMNS);
  return ABBE_OK;
}

abbe_result abbe_gem_grid_file_read(const char *path, abbe_gem_optimum *o, abbe_error *error) {
  assert(o->value);
  char *data, *rest = NULL;
  size_t size, line = 0;
  abbe_result result = abbe_file_read_text(path, MOST_BYTES, &data, &size, error);
  if (result != ABBE_OK) return result;
  for (char *row = strtok_r(data, "\r\n", &rest); row != NULL && result == ABBE_OK;
       row = strtok_r(NULL, "\r\n", &rest)) {
    line++;
    result = line <= 2 ? read_head(path, line, row, o, error) : read_row(path, line, row, o, error);
  }
  if (result == ABBE_OK && line < 2)
    result = abbe_error_set(error, ABBE_PARSE, "%s: no table of a part of a search", path);
  free(data);
  return result;
}
