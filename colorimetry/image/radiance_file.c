#include "colorimetry/image/picture_file.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINE = 2048, LEAST_RUN_LINE = 8, MOST_RUN_LINE = 0x7fff };

typedef struct reader {
  const char *path;
  const uint8_t *data;
  size_t size, at;
  double divisor[3]; /* for R, G, B: all exposures and colour corrections */
  double xy[8];
  bool xyze;
  bool columns, right_to_left, bottom_up; /* how lines run */
  size_t width, height;
} reader;

static abbe_result broken(const reader *r, const char *what, abbe_error *error) {
  return abbe_error_set(error, ABBE_PARSE, "%s: it cannot be read as a Radiance picture: %s",
                        r->path, what);
}

/* The next line without its end; false where there is none or it is too long. */
static bool next_line(reader *r, char line[MAX_LINE]) {
  const uint8_t *start = r->data + r->at;
  const uint8_t *end = memchr(start, '\n', r->size - r->at);
  const size_t length = end ? (size_t)(end - start) : 0;
  if (!end || length >= MAX_LINE) return false;
  memcpy(line, start, length);
  line[length] = '\0';
  if (length > 0 && line[length - 1] == '\r') line[length - 1] = '\0';
  r->at += length + 1;
  return true;
}

/* count numbers and nothing else. */
static bool read_numbers(const char *text, size_t count, double *out) {
  for (size_t i = 0; i < count; i++) {
    text += strspn(text, " \t");
    if (!abbe_number_read(text, &text, &out[i]) || !isfinite(out[i])) return false;
  }
  return text[strspn(text, " \t")] == '\0';
}

static bool divide_by(reader *r, const double factor[3]) {
  bool fine = true;
  for (int k = 0; k < 3; k++) {
    r->divisor[k] *= factor[k];
    fine = fine && factor[k] > 0 && r->divisor[k] > 1e-30 && r->divisor[k] < 1e30;
  }
  return fine;
}

static abbe_result read_variable(reader *r, const char *line, abbe_error *error) {
  double value[3];
  if (strncmp(line, "FORMAT=", 7) == 0) {
    const char *format = line + 7 + strspn(line + 7, " \t");
    r->xyze = strncmp(format, "32-bit_rle_xyze", 15) == 0;
    if (!r->xyze && strncmp(format, "32-bit_rle_rgbe", 15) != 0)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: its FORMAT is '%.40s'; 32-bit_rle_rgbe and 32-bit_rle_xyze can "
                            "be read",
                            r->path, format);
  } else if (strncmp(line, "EXPOSURE=", 9) == 0) {
    if (!read_numbers(line + 9, 1, value)) return broken(r, "its EXPOSURE is no number", error);
    value[1] = value[2] = value[0];
    if (!divide_by(r, value)) return broken(r, "its EXPOSURE is not above 0, or too large", error);
  } else if (strncmp(line, "COLORCORR=", 10) == 0) {
    if (!read_numbers(line + 10, 3, value) || !divide_by(r, value))
      return broken(r, "its COLORCORR is not three numbers above 0", error);
  } else if (strncmp(line, "PRIMARIES=", 10) == 0) {
    if (!read_numbers(line + 10, 8, r->xy))
      return broken(r, "its PRIMARIES are not eight numbers", error);
  }
  return ABBE_OK;
}

static abbe_result read_header(reader *r, abbe_error *error) {
  char line[MAX_LINE];
  abbe_result result = ABBE_OK;
  if (r->size < 2 || memcmp(r->data, "#?", 2) != 0)
    return broken(r, "it does not begin with #?RADIANCE", error);
  while (result == ABBE_OK) {
    if (!next_line(r, line)) return broken(r, "its header is cut off", error);
    if (line[0] == '\0') return ABBE_OK;
    result = read_variable(r, line, error);
  }
  return result;
}

/* One side: "+X 1024", its sign and letter; false where it is none. */
static bool read_side(const char **text, char *sign, char *letter, size_t *side) {
  const char *s = *text + strspn(*text, " \t");
  *sign = s[0];
  if (*sign != '+' && *sign != '-') return false;
  *letter = s[1];
  if (*letter != 'X' && *letter != 'Y') return false;
  s += 2;
  s += strspn(s, " \t");
  *side = 0;
  size_t digits = 0;
  for (; s[digits] >= '0' && s[digits] <= '9' && digits < 7; digits++)
    *side = *side * 10 + (size_t)(s[digits] - '0');
  *text = s + digits;
  return digits > 0 && *side >= 1 && *side <= ABBE_IMAGE_MAX_SIDE;
}

static abbe_result read_resolution(reader *r, abbe_error *error) {
  char line[MAX_LINE], sign[2], letter[2];
  size_t side[2];
  const char *text = line;
  if (!next_line(r, line)) return broken(r, "it has no line with its size", error);
  for (int i = 0; i < 2; i++)
    if (!read_side(&text, &sign[i], &letter[i], &side[i]))
      return abbe_error_set(error, ABBE_PARSE,
                            "%s: its size is '%.60s'; one such as -Y 512 +X 1024, up to %d a side, "
                            "is right",
                            r->path, line, ABBE_IMAGE_MAX_SIDE);
  if (letter[0] == letter[1]) return broken(r, "its size has one side twice", error);
  r->columns = letter[0] == 'X';
  const int y = r->columns;
  r->bottom_up = sign[y] == '+';
  r->right_to_left = sign[1 - y] == '-';
  r->height = side[y];
  r->width = side[1 - y];
  return ABBE_OK;
}

/* The rest of a line as pixels one by one, some of which repeat the one before; done: those that
 * are there already. */
static const char *read_old(reader *r, uint8_t (*line)[4], size_t done, size_t length) {
  unsigned shift = 0;
  while (done < length) {
    if (r->size - r->at < 4) return "it is cut off";
    const uint8_t *pixel = r->data + r->at;
    r->at += 4;
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      memcpy(line[done++], pixel, 4);
      shift = 0;
      continue;
    }
    if (done == 0) return "a line begins with the repetition of a pixel";
    if (shift > 24) return "a run is too long";
    const size_t count = (size_t)pixel[3] << shift;
    if (count > length - done) return "a run is longer than its line";
    for (size_t i = 0; i < count; i++, done++) memcpy(line[done], line[done - 1], 4);
    shift += 8;
  }
  return NULL;
}

/* Each of the four bytes of all pixels by itself, in runs. */
static const char *read_new(reader *r, uint8_t (*line)[4], size_t length) {
  for (int k = 0; k < 4; k++)
    for (size_t done = 0; done < length;) {
      if (r->size - r->at < 2) return "it is cut off";
      const uint8_t code = r->data[r->at++];
      const bool run = code > 128;
      const size_t count = run ? code & 127 : code;
      if (count == 0 || count > length - done) return "a run is longer than its line";
      if (r->size - r->at < (run ? 1 : count)) return "it is cut off";
      for (size_t i = 0; i < count; i++) line[done++][k] = r->data[r->at + (run ? 0 : i)];
      r->at += run ? 1 : count;
    }
  return NULL;
}

static const char *read_line(reader *r, uint8_t (*line)[4], size_t length) {
  if (length < LEAST_RUN_LINE || length > MOST_RUN_LINE) return read_old(r, line, 0, length);
  if (r->size - r->at < 4) return "it is cut off";
  const uint8_t *head = r->data + r->at;
  if (head[0] != 2 || head[1] != 2 || head[2] >= 128) return read_old(r, line, 0, length);
  if (((size_t)head[2] << 8 | head[3]) != length) return "a line is of another length";
  r->at += 4;
  return read_new(r, line, length);
}

static void store_line(const reader *r, const uint8_t (*line)[4], size_t number, abbe_image *out) {
  const size_t length = r->columns ? r->height : r->width;
  for (size_t i = 0; i < length; i++) {
    size_t x = r->columns ? number : i, y = r->columns ? i : number;
    if (r->right_to_left) x = r->width - 1 - x;
    if (r->bottom_up) y = r->height - 1 - y;
    float *pixel = out->data + (y * r->width + x) * 3;
    /* the exponent counts from 128 and mantissas from 2^-8; 0 is black */
    const double unit = line[i][3] ? ldexp(1, line[i][3] - 136) : 0;
    for (int k = 0; k < 3; k++) pixel[k] = (float)(line[i][k] * unit / r->divisor[k]);
  }
}

/* All lines; NULL, or why not and at which line. Flat: pixels one by one without runs, though a
 * line may begin as one in runs does. */
static const char *read_lines(reader *r, bool flat, uint8_t (*line)[4], abbe_image *out,
                              size_t *number) {
  const size_t count = r->columns ? r->width : r->height;
  const size_t length = r->columns ? r->height : r->width;
  for (*number = 0; *number < count; ++*number) {
    if (flat) {
      memcpy(line, r->data + r->at, 4 * length);
      r->at += 4 * length;
    } else {
      const char *reason = read_line(r, line, length);
      if (reason != NULL) return reason;
    }
    store_line(r, (const uint8_t(*)[4])line, *number, out);
  }
  return NULL;
}

static abbe_result read_pixels(reader *r, abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  const size_t count = r->columns ? r->width : r->height;
  const size_t length = r->columns ? r->height : r->width;
  abbe_result result = abbe_image_check_expansion(r->path, r->width, r->height, 3, r->size,
                                                  ABBE_RADIANCE_FREE_BYTES, error);
  if (result == ABBE_OK) result = abbe_image_make(r->width, r->height, 3, names, out, error);
  if (result != ABBE_OK) return result;
  uint8_t(*line)[4] = calloc(length, sizeof *line);
  if (line == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for a line", r->path);
  if (result == ABBE_OK) {
    const size_t start = r->at;
    size_t number = 0;
    const char *reason = read_lines(r, false, line, out, &number);
    if (reason != NULL && r->size - start == 4 * r->width * r->height) {
      r->at = start;
      reason = read_lines(r, true, line, out, &number);
    }
    if (reason != NULL)
      result = abbe_error_set(error, ABBE_PARSE,
                              "%s: it cannot be read as a Radiance picture: %s (line %zu of %zu)",
                              r->path, reason, number + 1, count);
  }
  free(line);
  return result;
}

abbe_result abbe_radiance_read(const char *path, abbe_image *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  char *data = NULL;
  reader r = {.path = path, .divisor = {1, 1, 1}};
  abbe_result result = abbe_file_read(path, ABBE_RADIANCE_MAX_BYTES, &data, &r.size, error);
  r.data = (const uint8_t *)data;
  if (result == ABBE_OK) result = read_header(&r, error);
  if (result == ABBE_OK) result = read_resolution(&r, error);
  if (result == ABBE_OK) result = read_pixels(&r, out, error);
  free(data);
  if (result != ABBE_OK) {
    abbe_image_free(out);
    return result;
  }
  if (r.xyze)
    abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_XYZ, out->xy);
  else
    memcpy(out->xy, r.xy, sizeof out->xy);
  return ABBE_OK;
}
