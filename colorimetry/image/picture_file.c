#include "colorimetry/image/picture_file.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/exr.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { MOST_HEADER = 1 << 20, LONGEST_KEY = 64, BANDS = ABBE_IMAGE_MAX_CHANNELS };

/* ---- the header ---- */

typedef enum number_key {
  SAMPLES,
  LINES,
  BAND_COUNT,
  OFFSET,
  TYPE,
  ORDER,
  SCALE,
  PACKED,
  KEYS
} number_key;

typedef struct header {
  const char *path;
  size_t line, light; /* line that is read, from 1, and that of the wavelengths */
  double value[KEYS]; /* NaN: not stated */
  char interleave[4]; /* "bsq", "bil", "bip" */
  char unit[32];      /* of wavelengths; "": not stated */
  size_t wavelengths, gains, offsets, names;
  double wavelength[BANDS], gain[BANDS], offset[BANDS];
  char *name[BANDS];
} header;

__attribute__((format(printf, 4, 5))) static abbe_result
refuse(const header *h, abbe_result code, abbe_error *error, const char *format, ...) {
  char prefix[600];
  va_list list;
  snprintf(prefix, sizeof prefix, h->line > 0 ? "%.500s:%zu: " : "%.500s: ", h->path, h->line);
  va_start(list, format);
  abbe_error_set_list(error, code, prefix, format, list);
  va_end(list);
  return code;
}

/* The next item of a list in braces, or of one without: up to a comma, without blanks about it. */
static bool next_item(char **list, char **item) {
  char *at = *list + strspn(*list, " \t\n{");
  if (*at == '\0' || *at == '}') return false;
  const size_t length = strcspn(at, ",}");
  *list = at + length + (at[length] == ',' ? 1 : 0);
  if (at[length] == '}') *list = at + length + strlen(at + length);
  at[length] = '\0';
  for (size_t end = length; end > 0 && isspace((unsigned char)at[end - 1]);) at[--end] = '\0';
  *item = at;
  return true;
}

static abbe_result read_list(const header *h, const char *key, char *text, double out[BANDS],
                             size_t *count, abbe_error *error) {
  char *item;
  const char *end;
  for (*count = 0; next_item(&text, &item); ++*count) {
    if (*count == BANDS)
      return refuse(h, ABBE_UNSUPPORTED, error, "'%s' has more than %d numbers", key, BANDS);
    if (!abbe_number_read(item, &end, &out[*count]) || *end != '\0' || !isfinite(out[*count]))
      return refuse(h, ABBE_PARSE, error, "number %zu of '%s' is '%.40s', which is none",
                    *count + 1, key, item);
  }
  return ABBE_OK;
}

static abbe_result read_names(header *h, char *text, abbe_error *error) {
  char *item;
  while (h->names < BANDS && next_item(&text, &item))
    if ((h->name[h->names++] = strdup(item)) == NULL)
      return refuse(h, ABBE_NO_MEMORY, error, "no memory for the names of bands");
  return ABBE_OK;
}

/* What else it says goes with the picture. */
static abbe_result keep(const char *key, const char *text, abbe_image *image, abbe_error *error) {
  if (*text == '\0' || image->attribute_count == ABBE_IMAGE_MAX_ATTRIBUTES) return ABBE_OK;
  return abbe_image_set_attribute(image, key, text, error);
}

/* attributes: an image that has nothing else yet */
static abbe_result read_key(header *h, const char *key, char *text, abbe_image *attributes,
                            abbe_error *error) {
  static const char *const numbers[KEYS] = {"samples",
                                            "lines",
                                            "bands",
                                            "header offset",
                                            "data type",
                                            "byte order",
                                            "reflectance scale factor",
                                            "file compression"};
  const char *end;
  for (int k = 0; k < KEYS; k++) {
    if (strcasecmp(key, numbers[k]) != 0) continue;
    if (abbe_number_read(text, &end, &h->value[k]) && *end == '\0' && h->value[k] >= 0 &&
        isfinite(h->value[k]))
      return ABBE_OK;
    return refuse(h, ABBE_PARSE, error, "'%s' is '%.40s', no number from 0 on", key, text);
  }
  if (strcasecmp(key, "wavelength") == 0) h->light = h->line;
  if (strcasecmp(key, "wavelength") == 0)
    return read_list(h, key, text, h->wavelength, &h->wavelengths, error);
  if (strcasecmp(key, "data gain values") == 0)
    return read_list(h, key, text, h->gain, &h->gains, error);
  if (strcasecmp(key, "data offset values") == 0)
    return read_list(h, key, text, h->offset, &h->offsets, error);
  if (strcasecmp(key, "band names") == 0) return read_names(h, text, error);
  if (strcasecmp(key, "interleave") == 0) snprintf(h->interleave, sizeof h->interleave, "%s", text);
  if (strcasecmp(key, "wavelength units") == 0) snprintf(h->unit, sizeof h->unit, "%s", text);
  return keep(key, text, attributes, error);
}

/* A line "key = value", the value in braces over several lines; *text moves past it. */
static abbe_result read_line(header *h, char **text, abbe_image *attributes, abbe_error *error) {
  char key[LONGEST_KEY], *line = *text + strspn(*text, " \t");
  size_t length = strcspn(line, "\n=");
  const bool has_value = line[length] == '=' && *line != ';';
  char *value = line + length + has_value;
  size_t own = strcspn(value, "\n"), lines = 1;
  if (has_value && value[strspn(value, " \t")] == '{') {
    own = strcspn(value, "}");
    if (value[own] == '\0') return refuse(h, ABBE_PARSE, error, "its list has no '}'");
    own += strcspn(value + own, "\n");
  }
  for (size_t i = 0; i < own; i++) lines += value[i] == '\n';
  *text = value + own + (value[own] == '\n');
  value[own] = '\0';
  abbe_result result = ABBE_OK;
  if (has_value) {
    while (own > 0 && isspace((unsigned char)value[own - 1])) value[--own] = '\0';
    while (length > 0 && isspace((unsigned char)line[length - 1])) length--;
    snprintf(key, sizeof key, "%.*s", (int)(length < LONGEST_KEY ? length : LONGEST_KEY - 1), line);
    if (key[0] != '\0') result = read_key(h, key, value + strspn(value, " \t"), attributes, error);
  }
  h->line += lines;
  return result;
}

/* ---- wavelengths ---- */

/* Nanometres of a wavelength in the unit; NaN: it is none. */
static double nanometres(const char *unit, double value) {
  static const struct {
    const char *name;
    double nm; /* below 0: so many times its inverse */
  } units[] = {
      {"nanometers", 1},    {"nm", 1},           {"micrometers", 1e3}, {"microns", 1e3},
      {"um", 1e3},          {"\u00b5m", 1e3},    {"\u03bcm", 1e3},     {"millimeters", 1e6},
      {"mm", 1e6},          {"meters", 1e9},     {"m", 1e9},           {"angstroms", 0.1},
      {"wavenumber", -1e7}, {"cm-1", -1e7},      {"ghz", -299792458},  {"mhz", -299792458e3},
      {"hz", -299792458e9}, {"thz", -299792.458}};
  for (size_t i = 0; i < sizeof units / sizeof *units; i++)
    if (strcasecmp(unit, units[i].name) == 0)
      return units[i].nm > 0 ? value * units[i].nm : -units[i].nm / value;
  return NAN;
}

static bool are_within(const header *h, double least, double most) {
  for (size_t i = 0; i < h->wavelengths; i++)
    if (h->wavelength[i] < least || h->wavelength[i] > most) return false;
  return true;
}

static abbe_result become_nanometres(header *h, abbe_image *attributes, abbe_error *error) {
  h->line = h->light;
  const bool silent = h->unit[0] == '\0' || strcasecmp(h->unit, "unknown") == 0;
  if (h->wavelengths == 0 || strcasecmp(h->unit, "index") == 0) {
    h->wavelengths = 0;
    return ABBE_OK;
  }
  if (silent && !are_within(h, 100, 10000) && !are_within(h, 0.1, 10))
    return refuse(h, ABBE_PARSE, error,
                  "it does not say what unit its wavelengths have; add a line such as wavelength "
                  "units = Nanometers");
  if (silent) {
    snprintf(h->unit, sizeof h->unit, are_within(h, 100, 10000) ? "nm" : "um");
    ABBE_TRY(keep("wavelength units", h->unit[0] == 'n' ? "nm, not stated" : "um, not stated",
                  attributes, error));
  }
  for (size_t i = 0; i < h->wavelengths; i++) {
    const double stated = h->wavelength[i], nm = nanometres(h->unit, stated);
    if (isnan(nanometres(h->unit, 1)))
      return refuse(h, ABBE_UNSUPPORTED, error,
                    "wavelengths in '%s' cannot be read; in Nanometers, Micrometers, Angstroms, "
                    "Wavenumber or GHz they can",
                    h->unit);
    if (!(nm >= 1e-3 && nm <= 1e9))
      return refuse(h, ABBE_PARSE, error, "wavelength %zu is %g %s, none of light", i + 1, stated,
                    h->unit);
    h->wavelength[i] = abbe_number_tidy(nm);
    for (size_t k = 0; k < i; k++)
      if (h->wavelength[k] == h->wavelength[i])
        return refuse(h, ABBE_PARSE, error, "wavelengths %zu and %zu are both %g %s", k + 1, i + 1,
                      stated, h->unit);
  }
  return ABBE_OK;
}

/* ---- what it promises ---- */

/* Bytes of a number of ENVI's types; 0: none that is real. */
static size_t bytes_of(double type) {
  static const unsigned char bytes[16] = {0, 1, 2, 4, 4, 8, 0, 0, 0, 0, 0, 0, 2, 4, 8, 8};
  return type >= 0 && type < 16 ? bytes[(int)type] : 0;
}

static abbe_result check_header(header *h, abbe_error *error) {
  static const char *const names[] = {"samples", "lines", "bands"};
  h->line = 0;
  for (int k = 0; k < 3; k++)
    if (!(h->value[k] >= 1 && h->value[k] == floor(h->value[k])))
      return refuse(h, ABBE_PARSE, error, "its header has no line '%s = ' with a number from 1 on",
                    names[k]);
  if (h->value[SAMPLES] > ABBE_IMAGE_MAX_SIDE || h->value[LINES] > ABBE_IMAGE_MAX_SIDE ||
      h->value[BAND_COUNT] > BANDS)
    return refuse(h, ABBE_INVALID_ARGUMENT, error,
                  "%.0f x %.0f pixels of %.0f bands; %d a side and %d bands are the most",
                  h->value[SAMPLES], h->value[LINES], h->value[BAND_COUNT], ABBE_IMAGE_MAX_SIDE,
                  BANDS);
  if (bytes_of(h->value[TYPE]) == 0)
    return refuse(h, ABBE_UNSUPPORTED, error,
                  "its data type is %g; 1 to 5 and 12 to 15, real numbers, can be read",
                  h->value[TYPE]);
  if (h->value[PACKED] > 0)
    return refuse(h, ABBE_UNSUPPORTED, error, "its cube is compressed; unpack it");
  if (strcasecmp(h->interleave, "bsq") != 0 && strcasecmp(h->interleave, "bil") != 0 &&
      strcasecmp(h->interleave, "bip") != 0)
    return refuse(h, ABBE_PARSE, error, "its interleave is '%s'; bsq, bil and bip are right",
                  h->interleave);
  if (!(h->value[ORDER] <= 1)) h->value[ORDER] = 0;
  if (!(h->value[OFFSET] >= 0)) h->value[OFFSET] = 0;
  const struct {
    const char *what;
    size_t count;
  } lists[] = {{"wavelength", h->wavelengths},
               {"data gain values", h->gains},
               {"data offset values", h->offsets}};
  for (int k = 0; k < 3; k++)
    if (lists[k].count != 0 && (double)lists[k].count != h->value[BAND_COUNT])
      return refuse(h, ABBE_PARSE, error, "it has %zu numbers of '%s' and %.0f bands",
                    lists[k].count, lists[k].what, h->value[BAND_COUNT]);
  return ABBE_OK;
}

static abbe_result read_header(header *h, abbe_image *attributes, abbe_error *error) {
  char *text = NULL, *at;
  size_t size = 0;
  ABBE_TRY(abbe_file_read_text(h->path, MOST_HEADER, &text, &size, error));
  for (int k = 0; k < KEYS; k++) h->value[k] = NAN;
  at = text + strcspn(text, "\n");
  at += *at == '\n';
  h->line = 2;
  abbe_result result = ABBE_OK;
  while (result == ABBE_OK && *at != '\0') result = read_line(h, &at, attributes, error);
  free(text);
  if (result == ABBE_OK) result = check_header(h, error);
  return result == ABBE_OK ? become_nanometres(h, attributes, error) : result;
}

/* ---- the cube ---- */

static abbe_result open_cube(const header *h, FILE **cube, size_t *size, char *name, size_t longest,
                             abbe_error *error) {
  static const char *const endings[] = {"",     ".img", ".raw", ".dat", ".bin",
                                        ".bsq", ".bil", ".bip", ".cube"};
  const size_t length = strlen(h->path), own = length > 4 ? length - 4 : 0;
  const bool named = own > 0 && strcasecmp(h->path + own, ".hdr") == 0;
  for (size_t i = 0; named && i < sizeof endings / sizeof *endings; i++) {
    snprintf(name, longest, "%.*s%s", (int)own, h->path, endings[i]);
    struct stat info; /* a folder may have the name too */
    if (stat(name, &info) == 0 && !S_ISDIR(info.st_mode))
      return abbe_file_open(name, cube, size, error);
  }
  return refuse(h, ABBE_NOT_FOUND, error,
                "there is no cube beside this header: %.*s, alone or with .img, .raw, .dat, .bin, "
                ".bsq, .bil, .bip or .cube",
                (int)own, h->path);
}

static double number_at(const header *h, const unsigned char *bytes) {
  const int type = (int)h->value[TYPE];
  const size_t count = bytes_of(type);
  const bool big = h->value[ORDER] > 0;
  uint64_t bits = 0;
  for (size_t i = 0; i < count; i++) bits = bits << 8 | bytes[big ? i : count - 1 - i];
  const uint32_t low = (uint32_t)bits;
  float single;
  double whole;
  memcpy(&single, &low, sizeof single);
  memcpy(&whole, &bits, sizeof whole);
  switch (type) {
  case 2:
    return (int16_t)bits;
  case 3:
    return (int32_t)low;
  case 4:
    return (double)single;
  case 5:
    return whole;
  case 14:
    return (double)(int64_t)bits;
  default:
    return (double)bits;
  }
}

/* Rows of the cube, in the order in which they stand. */
static bool read_rows(const header *h, FILE *cube, unsigned char *row, abbe_image *image) {
  const size_t wide = image->width, high = image->height, bands = image->channels;
  const size_t bytes = bytes_of(h->value[TYPE]);
  const bool pixels = strcasecmp(h->interleave, "bip") == 0;
  const bool planes = strcasecmp(h->interleave, "bsq") == 0;
  const size_t rows = pixels ? high : high * bands, count = pixels ? wide * bands : wide;
  for (size_t r = 0; r < rows; r++) {
    const size_t y = pixels ? r : planes ? r % high : r / bands;
    if (fread(row, bytes, count, cube) != count) return false;
    for (size_t i = 0; i < count; i++) {
      const size_t x = pixels ? i / bands : i;
      const size_t band = pixels ? i % bands : planes ? r / high : r % bands;
      double v = number_at(h, row + bytes * i);
      if (h->gains > 0) v *= h->gain[band];
      if (h->offsets > 0) v += h->offset[band];
      if (h->value[SCALE] > 0) v /= h->value[SCALE];
      image->data[(y * wide + x) * bands + band] = (float)v;
    }
  }
  return true;
}

static abbe_result make_image(const header *h, abbe_image *image, abbe_error *error) {
  const size_t bands = (size_t)h->value[BAND_COUNT];
  char(*text)[64] = calloc(bands, sizeof *text);
  const char **names = calloc(bands, sizeof *names);
  abbe_result result = text != NULL && names != NULL
                           ? ABBE_OK
                           : refuse(h, ABBE_NO_MEMORY, error, "no memory for its bands");
  for (size_t b = 0; b < bands && result == ABBE_OK; b++) {
    names[b] = text[b];
    if (h->wavelengths > 0) abbe_image_band_name(h->wavelength[b], text[b], sizeof text[b]);
    if (h->wavelengths > 0 && h->value[SCALE] > 0) memmove(text[b], text[b] + 1, strlen(text[b]));
    if (h->wavelengths > 0 && h->value[SCALE] > 0) text[b][0] = 'T';
    if (h->wavelengths == 0) snprintf(text[b], sizeof text[b], "band %zu", b + 1);
    if (h->wavelengths == 0 && b < h->names && h->name[b][0] != '\0') names[b] = h->name[b];
  }
  if (result == ABBE_OK)
    result = abbe_image_make((size_t)h->value[SAMPLES], (size_t)h->value[LINES], bands, names,
                             image, error);
  free(text);
  free(names);
  return result;
}

static abbe_result read_cube(header *h, abbe_image *image, abbe_error *error) {
  FILE *cube = NULL;
  size_t size = 0;
  char name[4096];
  h->line = 0;
  ABBE_TRY(open_cube(h, &cube, &size, name, sizeof name, error));
  const double own =
      h->value[SAMPLES] * h->value[LINES] * h->value[BAND_COUNT] * (double)bytes_of(h->value[TYPE]);
  abbe_result result = ABBE_OK;
  if ((double)size < h->value[OFFSET] + own)
    result = abbe_error_set(error, ABBE_PARSE,
                            "%s: it has %zu bytes; its header %s asks for %.0f from byte %.0f on",
                            name, size, h->path, own, h->value[OFFSET]);
  if (result == ABBE_OK) result = make_image(h, image, error);
  unsigned char *row =
      result == ABBE_OK ? malloc(image->width * image->channels * bytes_of(h->value[TYPE])) : NULL;
  if (result == ABBE_OK && row == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for a row", name);
  if (result == ABBE_OK &&
      (fseeko(cube, (off_t)h->value[OFFSET], SEEK_SET) != 0 || !read_rows(h, cube, row, image)))
    result = abbe_error_set(error, ABBE_IO, "%s: it cannot be read to its end", name);
  free(row);
  fclose(cube);
  return result;
}

abbe_result abbe_envi_read(const char *path, abbe_image *out, abbe_error *error) {
  abbe_image attributes = {0}, image = {0};
  header *h = calloc(1, sizeof *h);
  *out = image;
  if (h == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for it", path);
  h->path = path;
  abbe_result result = read_header(h, &attributes, error);
  if (result == ABBE_OK) result = read_cube(h, &image, error);
  if (result == ABBE_OK) {
    image.attribute = attributes.attribute;
    image.attribute_count = attributes.attribute_count;
    *out = image;
  } else {
    abbe_image_free(&image);
    abbe_image_free(&attributes);
  }
  for (size_t i = 0; i < h->names; i++) free(h->name[i]);
  free(h);
  return result;
}

/* ---- kinds ---- */

abbe_result abbe_picture_file_find_kind(const char *path, abbe_picture_file_kind *out,
                                        abbe_error *error) {
  FILE *stream = NULL;
  char head[5] = {0};
  char *name = strndup(path, abbe_exr_file_length(path));
  if (name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for it", path);
  const abbe_result result = abbe_file_open(name, &stream, NULL, error);
  free(name);
  if (result != ABBE_OK) return result;
  const size_t size = fread(head, 1, sizeof head, stream);
  fclose(stream);
  const bool exr = size >= 4 && memcmp(head, "\x76\x2f\x31\x01", 4) == 0;
  *out = exr                                       ? ABBE_PICTURE_FILE_EXR
         : size >= 2 && memcmp(head, "#?", 2) == 0 ? ABBE_PICTURE_FILE_RADIANCE
         : size == 5 && memcmp(head, "ENVI", 4) == 0 && isspace((unsigned char)head[4])
             ? ABBE_PICTURE_FILE_ENVI
             : ABBE_PICTURE_FILE_OTHER;
  return ABBE_OK;
}

abbe_result abbe_picture_file_read(const char *path, abbe_image *out, abbe_error *error) {
  abbe_picture_file_kind kind = ABBE_PICTURE_FILE_OTHER;
  *out = (abbe_image){0};
  ABBE_TRY(abbe_picture_file_find_kind(path, &kind, error));
  return kind == ABBE_PICTURE_FILE_RADIANCE ? abbe_radiance_read(path, out, error)
         : kind == ABBE_PICTURE_FILE_ENVI   ? abbe_envi_read(path, out, error)
                                            : abbe_exr_read(path, out, error);
}
