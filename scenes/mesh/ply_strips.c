#include "scenes/mesh/ply_strips.h"

#include "base/number.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ELEMENTS = 16, MOST_PROPERTIES = 64, MOST_LINES = 256 };

typedef enum number_kind { I8, U8, I16, U16, I32, U32, F32, F64, NO_KIND } number_kind;
static const size_t kind_size[] = {1, 1, 2, 2, 4, 4, 4, 8};

typedef struct property {
  char name[32];
  number_kind count, kind; /* of a list's count, or NO_KIND; of its values */
} property;

typedef struct element {
  char name[32];
  size_t count, properties;
  property property[MOST_PROPERTIES];
} element;

typedef enum encoding { TEXT, LITTLE, BIG } encoding;

typedef struct reading {
  const char *path, *at, *end;
  encoding encoding;
  size_t elements;
  element element[MOST_ELEMENTS];
} reading;

static number_kind kind_named(const char *name) {
  static const char *const names[][2] = {
      {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
      {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
  for (int i = 0; i < NO_KIND; i++)
    if (strcmp(name, names[i][0]) == 0 || strcmp(name, names[i][1]) == 0) return (number_kind)i;
  return NO_KIND;
}

/* ---- the header ---- */

/* A name says what an element is, so it stands once. */
static bool take_element(reading *r, const char *line) {
  if (r->elements == MOST_ELEMENTS) return false;
  element *e = &r->element[r->elements];
  *e = (element){0};
  if (sscanf(line, "element %31s %20zu", e->name, &e->count) != 2) return false;
  for (size_t i = 0; i < r->elements; i++)
    if (strcmp(r->element[i].name, e->name) == 0) return false;
  r->elements++;
  return true;
}

static bool take_property(reading *r, const char *line) {
  char first[32], second[32];
  if (r->elements == 0 || r->element[r->elements - 1].properties == MOST_PROPERTIES) return false;
  element *e = &r->element[r->elements - 1];
  property *p = &e->property[e->properties];
  *p = (property){.count = NO_KIND};
  if (sscanf(line, "property list %31s %31s %31s", first, second, p->name) == 3) {
    p->count = kind_named(first);
    p->kind = kind_named(second);
    if (p->count == NO_KIND || p->count >= F32) return false;
  } else if (sscanf(line, "property %31s %31s", second, p->name) == 2) {
    p->kind = kind_named(second);
  } else {
    return false;
  }
  e->properties++;
  return p->kind != NO_KIND;
}

static bool take_format(reading *r, const char *line) {
  static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  char name[32] = "";
  if (sscanf(line, "format %31s", name) != 1) return false;
  for (int i = 0; i < 3; i++)
    if (strcmp(name, names[i]) == 0) {
      r->encoding = (encoding)i;
      return true;
    }
  return false;
}

/* One line into text, without its end; false where there is none, or it is too long. */
static bool next_line(reading *r, char *text, size_t size) {
  const char *end = memchr(r->at, '\n', (size_t)(r->end - r->at));
  if (end == NULL || (size_t)(end - r->at) >= size) return false;
  const size_t length = (size_t)(end - r->at);
  memcpy(text, r->at, length);
  text[length] = '\0';
  if (length > 0 && text[length - 1] == '\r') text[length - 1] = '\0';
  r->at = end + 1;
  return true;
}

/* The number of the line that is wrong, or 0. */
static int read_header(reading *r) {
  char line[512];
  for (int i = 1; i <= MOST_LINES; i++) {
    if (!next_line(r, line, sizeof line)) return i;
    bool ok = i > 1 || strcmp(line, "ply") == 0;
    if (strncmp(line, "end_header", 10) == 0) return 0;
    if (strncmp(line, "format ", 7) == 0) ok = take_format(r, line);
    if (strncmp(line, "element ", 8) == 0) ok = take_element(r, line);
    if (strncmp(line, "property ", 9) == 0) ok = take_property(r, line);
    if (!ok) return i;
  }
  return MOST_LINES;
}

/* ---- the body ---- */

static bool read_text(reading *r, double *out) {
  while (r->at < r->end && (*r->at == '\n' || *r->at == '\r' || *r->at == ' ' || *r->at == '\t'))
    r->at++;
  return abbe_number_read(r->at, &r->at, out) && r->at <= r->end; /* a zero byte ends the file */
}

static bool read_binary(reading *r, number_kind kind, double *out) {
  const size_t size = kind_size[kind];
  const uint16_t one = 1;
  const bool little = *(const unsigned char *)&one == 1;
  unsigned char bytes[8];
  if ((size_t)(r->end - r->at) < size) return false;
  for (size_t i = 0; i < size; i++)
    bytes[(r->encoding == LITTLE) == little ? i : size - 1 - i] = (unsigned char)r->at[i];
  r->at += size;
  int8_t i8;
  int16_t i16;
  uint16_t u16;
  int32_t i32;
  uint32_t u32;
  float f32;
#define TAKE(variable)                                                                             \
  memcpy(&variable, bytes, sizeof variable);                                                       \
  *out = (double)variable
  switch (kind) {
  case I8:
    TAKE(i8);
    break;
  case U8:
    *out = bytes[0];
    break;
  case I16:
    TAKE(i16);
    break;
  case U16:
    TAKE(u16);
    break;
  case I32:
    TAKE(i32);
    break;
  case U32:
    TAKE(u32);
    break;
  case F32:
    TAKE(f32);
    break;
  default:
    memcpy(out, bytes, sizeof *out);
  }
#undef TAKE
  return true;
}

static bool read_number(reading *r, number_kind kind, double *out) {
  return r->encoding == TEXT ? read_text(r, out) : read_binary(r, kind, out);
}

/* What is read of the body. */
typedef struct body {
  double (*position)[3];
  size_t vertices;
  uint32_t (*face)[3];
  size_t faces, room;
  bool no_memory, wrong_index;
} body;

static bool add_face(body *b, int64_t x, int64_t y, int64_t z) {
  if (x == y || y == z || z == x) return true; /* how strips turn a corner */
  if (b->faces == b->room) {
    const size_t room = b->room > 0 ? 2 * b->room : 1024;
    void *more =
        room <= 2 * (size_t)ABBE_MESH_MAX_FACES ? realloc(b->face, room * sizeof *b->face) : NULL;
    if (more == NULL) {
      b->no_memory = true;
      return false;
    }
    b->face = more;
    b->room = room;
  }
  uint32_t *f = b->face[b->faces++];
  f[0] = (uint32_t)x;
  f[1] = (uint32_t)y;
  f[2] = (uint32_t)z;
  return true;
}

/* Every second triangle of a strip runs the other way round; -1 begins another strip. */
static bool read_strip(reading *r, number_kind kind, size_t count, body *b) {
  int64_t last[2] = {-1, -1};
  bool odd = false;
  for (size_t i = 0; i < count; i++) {
    double value;
    if (!read_number(r, kind, &value)) return false;
    if (!(value >= -1 && value < (double)b->vertices)) {
      b->wrong_index = true;
      return false;
    }
    const int64_t index = (int64_t)value;
    if (index >= 0 && last[0] >= 0) {
      if (!add_face(b, last[odd], last[!odd], index)) return false;
      odd = !odd;
    }
    if (index < 0) odd = false;
    last[0] = index < 0 ? -1 : last[1];
    last[1] = index;
  }
  return true;
}

/* One element's property: kept where it is a coordinate or a strip, else passed over. */
static bool read_property(reading *r, const element *e, const property *p, size_t instance,
                          body *b) {
  const bool strips = strcmp(e->name, "tristrips") == 0, vertex = strcmp(e->name, "vertex") == 0;
  double value, count = 1;
  if (p->count != NO_KIND) {
    if (!read_number(r, p->count, &count) || !(count >= 0 && count < 4294967296.0)) return false;
    if (strips) return read_strip(r, p->kind, (size_t)count, b);
  }
  for (size_t i = 0; i < (size_t)count; i++) {
    if (!read_number(r, p->kind, &value)) return false;
    for (int k = 0; k < 3 && vertex && p->count == NO_KIND; k++)
      if (p->name[0] == "xyz"[k] && p->name[1] == '\0') b->position[instance][k] = value;
  }
  return true;
}

static bool read_body(reading *r, body *b) {
  for (size_t i = 0; i < r->elements; i++) {
    const element *e = &r->element[i];
    /* a byte at the least for each of its values; what has none says nothing */
    if (e->properties == 0 && e->count > 0) return false;
    if (e->properties > 0 && e->count > (size_t)(r->end - r->at) / e->properties) return false;
    if (strcmp(e->name, "vertex") == 0 && b->position == NULL) {
      b->position = calloc(e->count + 1, sizeof *b->position);
      b->vertices = e->count;
      b->no_memory = b->position == NULL;
      if (b->no_memory) return false;
    }
    for (size_t k = 0; k < e->count; k++)
      for (size_t p = 0; p < e->properties; p++)
        if (!read_property(r, e, &e->property[p], k, b)) return false;
  }
  return true;
}

static abbe_result make(const reading *r, const body *b, abbe_mesh *out, abbe_error *error) {
  for (size_t v = 0; v < b->vertices; v++)
    if (!isfinite(b->position[v][0]) || !isfinite(b->position[v][1]) ||
        !isfinite(b->position[v][2]))
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "%s: vertex %zu is at (%g, %g, %g); coordinates must be finite",
                            r->path, v, b->position[v][0], b->position[v][1], b->position[v][2]);
  if (b->faces == 0)
    return abbe_error_set(error, ABBE_GEOMETRY, "%s: its triangle strips have no triangles",
                          r->path);
  const abbe_result result = abbe_mesh_make(b->vertices, b->faces, false, out, error);
  if (result != ABBE_OK) return result;
  memcpy(out->position, b->position, b->vertices * sizeof *out->position);
  memcpy(out->face, b->face, b->faces * sizeof *out->face);
  return ABBE_OK;
}

abbe_result abbe_ply_read_strips(const char *data, size_t size, const char *path, abbe_mesh *out,
                                 abbe_error *error) {
  ABBE_REQUIRE(data && path && out, error);
  memset(out, 0, sizeof *out);
  reading *r = calloc(1, sizeof *r);
  body b = {0};
  abbe_result result = ABBE_OK;
  if (r == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to read it", path);
  *r = (reading){.path = path, .at = data, .end = data + size};
  const int wrong = read_header(r);
  if (wrong != 0)
    result = abbe_error_set(error, ABBE_PARSE, "%s: line %d is none of a PLY header", path, wrong);
  else if (read_body(r, &b))
    result = make(r, &b, out, error);
  else if (b.no_memory)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its triangle strips", path);
  else if (b.wrong_index)
    result = abbe_error_set(error, ABBE_GEOMETRY,
                            "%s: a triangle strip names a vertex that is none of the file's %zu",
                            path, b.vertices);
  else
    result = abbe_error_set(error, ABBE_PARSE,
                            "%s: it ends, or has something else than a number, before all that its "
                            "header announces",
                            path);
  free(b.position);
  free(b.face);
  free(r);
  return result;
}
