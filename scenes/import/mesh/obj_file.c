/* Wavefront OBJ: polygons by points, texture coordinates and normals; materials by their names. */
#include "base/file.h"
#include "base/foreign_text.h"
#include "base/number.h"
#include "scenes/import/mesh/mesh_reading.h"

#include <stdlib.h>
#include <string.h>

typedef struct reading {
  abbe_mesh_reading *to;
  const char *at, *end;
  bool wanted; /* the material that is used now is the one to be read */
  abbe_error *error;
} reading;

static abbe_result fail(const reading *r, const char *what) {
  return abbe_error_set(r->error, ABBE_PARSE, "%s: line %zu: %s", r->to->path, r->to->line, what);
}

/* Blanks, and ends of lines that a backslash continues. */
static void skip_blanks(reading *r) {
  for (;;) {
    if (r->at < r->end && (*r->at == ' ' || *r->at == '\t')) {
      r->at++;
    } else if (r->at + 1 < r->end && *r->at == '\\' && (r->at[1] == '\n' || r->at[1] == '\r')) {
      r->at += r->at[1] == '\r' && r->at + 2 < r->end && r->at[2] == '\n' ? 3 : 2;
      r->to->line++;
    } else {
      return;
    }
  }
}

static bool line_ends(const reading *r) {
  return r->at >= r->end || *r->at == '\n' || *r->at == '\r' || *r->at == '#';
}

static bool word_ends(const reading *r) {
  return line_ends(r) || *r->at == ' ' || *r->at == '\t' || *r->at == '\\';
}

static void skip_line(reading *r) {
  while (r->at < r->end && *r->at != '\n' && *r->at != '\r') {
    skip_blanks(r);
    if (r->at < r->end && *r->at != '\n' && *r->at != '\r') r->at++;
  }
  if (r->at + 1 < r->end && *r->at == '\r' && r->at[1] == '\n') r->at++;
  if (r->at < r->end) r->at++;
  r->to->line++;
}

/* As many numbers as there are, up to most; their count, or -1 where something else stands. */
static int read_numbers(reading *r, double *out, int most) {
  int count = 0;
  for (skip_blanks(r); count < most && !line_ends(r); skip_blanks(r))
    if (!abbe_number_read(r->at, &r->at, &out[count++]) || !word_ends(r)) return -1;
  return count;
}

static abbe_result read_vector(reading *r, abbe_mesh_list *list, int least, int most,
                               const char *what) {
  double v[3] = {0};
  const int count = read_numbers(r, v, most);
  if (count < least) return fail(r, what);
  return abbe_mesh_list_add(list, 1, (size_t)most * sizeof *v, v)
             ? ABBE_OK
             : abbe_mesh_reading_no_memory(r->to, r->error);
}

/* One of the list's items: they are counted from 1, or backwards from the last with -1. */
static bool read_index(reading *r, const abbe_mesh_list *list, uint32_t *out) {
  const bool back = *r->at == '-';
  const char *first = r->at += back;
  uint64_t value = 0;
  for (; r->at < r->end && *r->at >= '0' && *r->at <= '9'; r->at++)
    if (value <= UINT32_MAX) value = 10 * value + (uint64_t)(*r->at - '0');
  if (r->at == first || value == 0 || value >= UINT32_MAX || (back && value > list->count))
    return false;
  *out = (uint32_t)(back ? list->count - value : value - 1);
  return true;
}

static bool read_corner(reading *r, abbe_mesh_corner *c) {
  *c = (abbe_mesh_corner){0, ABBE_MESH_READING_NONE, ABBE_MESH_READING_NONE};
  if (!read_index(r, &r->to->point, &c->point)) return false;
  if (r->at < r->end && *r->at == '/') {
    r->at++;
    if (!word_ends(r) && *r->at != '/' && !read_index(r, &r->to->uv, &c->uv)) return false;
  }
  if (r->at < r->end && *r->at == '/') {
    r->at++;
    if (!word_ends(r) && !read_index(r, &r->to->normal, &c->normal)) return false;
  }
  return word_ends(r);
}

static abbe_result read_face(reading *r) {
  abbe_mesh_corner corner;
  for (skip_blanks(r); !line_ends(r); skip_blanks(r)) {
    if (!read_corner(r, &corner))
      return fail(r, "a face's corner is the number of a vertex, counted from 1 or backwards from "
                     "-1, as in 7, 7/2, 7/2/3 or 7//3");
    if (r->wanted && !abbe_mesh_reading_corner(r->to, corner))
      return abbe_mesh_reading_no_memory(r->to, r->error);
  }
  return abbe_mesh_reading_end_polygon(r->to) ? ABBE_OK
                                              : abbe_mesh_reading_no_memory(r->to, r->error);
}

/* The rest of the line, without blanks around it; its length. */
static size_t rest_of_line(reading *r) {
  skip_blanks(r);
  const char *to = r->at;
  while (to < r->end && *to != '\n' && *to != '\r') to++;
  while (to > r->at && (to[-1] == ' ' || to[-1] == '\t')) to--;
  return (size_t)(to - r->at);
}

static void read_material(reading *r) {
  const size_t length = rest_of_line(r);
  const char *name = r->to->material;
  r->wanted = name == NULL || (strlen(name) == length && memcmp(name, r->at, length) == 0);
}

/* Whether there was memory for a file beside the mesh's. */
static bool note_file(reading *r, const char *name, size_t length) {
  abbe_mesh_list *others = &r->to->others;
  const char *path = r->to->path;
  const size_t folder = (size_t)(abbe_file_name(path) - path);
  return (folder == 0 || abbe_mesh_list_add(others, folder, 1, path)) &&
         abbe_mesh_list_add(others, length, 1, name) && abbe_mesh_list_add(others, 1, 1, "");
}

/* Files of materials are not read, but they are the mesh's: nothing is written over them. Blanks
 * part their names, and programs write names that have blanks: so each word is one, and all
 * together. */
static abbe_result note_materials(reading *r) {
  const size_t length = rest_of_line(r);
  const char *const all = r->at, *const end = all + length, *word = all;
  bool noted = length == 0 || note_file(r, all, length);
  while (noted && word < end) {
    const char *to = word;
    while (to < end && *to != ' ' && *to != '\t') to++;
    if (to > word && (size_t)(to - word) < length) noted = note_file(r, word, (size_t)(to - word));
    word = to + 1;
  }
  return noted ? ABBE_OK : abbe_mesh_reading_no_memory(r->to, r->error);
}

static bool is_word(const char *from, size_t length, const char *word) {
  return strlen(word) == length && memcmp(from, word, length) == 0;
}

static abbe_result read_line(reading *r) {
  static const char *const surfaces[] = {"surf", "bsp", "bzp", "cdp", "res"};
  skip_blanks(r);
  const char *word = r->at;
  while (!word_ends(r)) r->at++;
  const size_t n = (size_t)(r->at - word);
  if (is_word(word, n, "v"))
    return read_vector(r, &r->to->point, 3, 3, "a vertex ('v') is three numbers");
  if (is_word(word, n, "vn"))
    return read_vector(r, &r->to->normal, 3, 3, "a normal ('vn') is three numbers");
  if (is_word(word, n, "vt"))
    return read_vector(r, &r->to->uv, 1, 2, "a texture coordinate ('vt') is two numbers");
  if (is_word(word, n, "f") || is_word(word, n, "fo")) return read_face(r);
  if (is_word(word, n, "mtllib")) return note_materials(r);
  if (is_word(word, n, "usemtl")) read_material(r);
  for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++)
    if (is_word(word, n, surfaces[i]))
      return abbe_error_set(r->error, ABBE_UNSUPPORTED,
                            "%s: line %zu: '%s' is a free-form surface; only polygons are read",
                            r->to->path, r->to->line, surfaces[i]);
  return ABBE_OK;
}

static abbe_result read_text(abbe_mesh_reading *to, const char *data, size_t size,
                             abbe_error *error) {
  reading r = {.to = to, .at = data, .end = data + size, .error = error};
  to->line = 1;
  r.wanted = to->material == NULL;
  while (r.at < r.end) {
    ABBE_TRY(read_line(&r));
    skip_line(&r);
  }
  return ABBE_OK;
}

/* A byte-order mark tells of UTF-16, or is no part of the first line. */
abbe_result abbe_obj_read(abbe_mesh_reading *to, const char *data, size_t size, abbe_error *error) {
  static const char *const marks[] = {"\xff\xfe", "\xfe\xff", "\xef\xbb\xbf"};
  bool marked = false;
  for (size_t i = 0; i < 3; i++)
    marked = marked || (size >= strlen(marks[i]) && memcmp(data, marks[i], strlen(marks[i])) == 0);
  if (!marked) return read_text(to, data, size, error);
  ABBE_FREED char *text = NULL;
  size_t length = 0;
  ABBE_TRY(abbe_encoding_decode(data, size, &text, &length, error));
  return read_text(to, text, length, error);
}
