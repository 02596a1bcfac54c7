/* STL: text, or binary where its length is what its count of triangles makes it. */
#include "base/number.h"
#include "scenes/import/mesh/mesh_reading.h"

#include <string.h>
#include <strings.h>

enum { HEAD = 84, TRIANGLE = 50 };

static bool add_corner(abbe_mesh_reading *to, const double at[3]) {
  const uint32_t index = (uint32_t)to->point.count;
  return abbe_mesh_reading_point(to, at) &&
         abbe_mesh_reading_corner(
             to, (abbe_mesh_corner){index, ABBE_MESH_READING_NONE, ABBE_MESH_READING_NONE});
}

/* ---- binary ---- */

static uint32_t word(const unsigned char *at) {
  return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static double number(const unsigned char *at) {
  const uint32_t bits = word(at);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static abbe_result read_binary(abbe_mesh_reading *to, const unsigned char *data, size_t size,
                               abbe_error *error) {
  const size_t count = word(data + HEAD - 4), body = size - HEAD;
  if (body != count * TRIANGLE)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: as a binary STL it announces %zu triangles of %d bytes, and %zu "
                          "bytes follow, which are %zu triangles and %zu bytes: it was cut short, "
                          "or its count (bytes 81 to 84) is wrong",
                          to->path, count, TRIANGLE, body, body / TRIANGLE, body % TRIANGLE);
  for (size_t i = 0; i < count; i++) {
    for (size_t c = 1; c <= 3; c++) { /* the first three numbers are its normal */
      double at[3];
      for (size_t k = 0; k < 3; k++) at[k] = number(data + HEAD + i * TRIANGLE + 4 * (3 * c + k));
      if (!add_corner(to, at)) return abbe_mesh_reading_no_memory(to, error);
    }
    if (!abbe_mesh_reading_end_polygon(to)) return abbe_mesh_reading_no_memory(to, error);
  }
  return ABBE_OK;
}

/* ---- text ---- */

typedef struct reading {
  abbe_mesh_reading *to;
  const char *at, *end;
  size_t line;
  abbe_error *error;
} reading;

static bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static void skip_blanks(reading *r) {
  for (; r->at < r->end && is_blank(*r->at); r->at++) r->line += *r->at == '\n';
}

/* Passes over the words, in whatever case; false, and nowhere, where others stand. */
static bool take_word(reading *r, const char *name) {
  skip_blanks(r);
  const size_t length = strlen(name);
  if ((size_t)(r->end - r->at) < length || strncasecmp(r->at, name, length) != 0) return false;
  if (r->at + length < r->end && !is_blank(r->at[length])) return false;
  r->at += length;
  return true;
}

static void skip_line(reading *r) {
  while (r->at < r->end && *r->at != '\n' && *r->at != '\r') r->at++;
}

static abbe_result fail(reading *r, const char *what) {
  skip_blanks(r);
  char found[24];
  size_t n = 0;
  for (; n + 1 < sizeof found && r->at + n < r->end && !is_blank(r->at[n]); n++)
    found[n] = r->at[n];
  found[n] = '\0';
  return abbe_error_set(r->error, ABBE_PARSE, "%s: line %zu: %s belongs here, and %s%s%s stands",
                        r->to->path, r->line, what, n > 0 ? "'" : "", n > 0 ? found : "the end",
                        n > 0 ? "'" : "");
}

static bool read_numbers(reading *r, double out[3]) {
  for (int k = 0; k < 3; k++) {
    skip_blanks(r);
    if (!abbe_number_read(r->at, &r->at, &out[k])) return false; /* a zero byte ends the file */
  }
  return true;
}

/* Normals are those of faces, computed: what stands for them is passed over. */
static abbe_result read_facet(reading *r) {
  double at[3];
  if (take_word(r, "normal")) skip_line(r);
  if (!take_word(r, "outer") || !take_word(r, "loop")) return fail(r, "'outer loop'");
  while (take_word(r, "vertex")) {
    if (!read_numbers(r, at)) return fail(r, "a number of a vertex");
    if (!add_corner(r->to, at)) return abbe_mesh_reading_no_memory(r->to, r->error);
  }
  if (r->to->open < 3) return fail(r, "'vertex', three times,");
  if (!abbe_mesh_reading_end_polygon(r->to)) return abbe_mesh_reading_no_memory(r->to, r->error);
  if (!take_word(r, "endloop")) return fail(r, "'vertex' or 'endloop'");
  return take_word(r, "endfacet") ? ABBE_OK : fail(r, "'endfacet'");
}

static abbe_result read_text(reading *r) {
  abbe_result result = ABBE_OK;
  do {
    if (!take_word(r, "solid")) return fail(r, "'solid'");
    skip_line(r);
    while (result == ABBE_OK && take_word(r, "facet")) result = read_facet(r);
    if (result == ABBE_OK && !take_word(r, "endsolid") && !take_word(r, "end solid"))
      return fail(r, "'facet' or 'endsolid'");
    skip_line(r);
    skip_blanks(r);
  } while (result == ABBE_OK && r->at < r->end);
  return result;
}

abbe_result abbe_stl_read(abbe_mesh_reading *to, const char *data, size_t size, abbe_error *error) {
  const unsigned char *bytes = (const unsigned char *)data;
  reading r = {.to = to, .at = data, .end = data + size, .line = 1, .error = error};
  const bool sized = size >= HEAD && size - HEAD == (size_t)word(bytes + HEAD - 4) * TRIANGLE;
  /* some programs begin binary files with 'solid' too; text has no zero bytes */
  const bool text = !sized && memchr(data, 0, size) == NULL;
  if (text || size < HEAD) return read_text(&r);
  return read_binary(to, bytes, size, error);
}
