/* PLY: polygons and triangle strips, in text or binary of either order. */
#include "base/number.h"
#include "scenes/import/mesh/mesh_reading.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ELEMENTS = 32, MOST_PROPERTIES = 128, MOST_LINES = 65536 };

typedef enum number_kind { I8, U8, I16, U16, I32, U32, F32, F64, NO_KIND } number_kind;
static const size_t kind_size[] = {1, 1, 2, 2, 4, 4, 4, 8};

/* What a property's values are of a vertex (a component) or of a face (a list). */
typedef enum meaning {
  POINT,
  NORMAL = 3,
  UV = 6,
  CORNERS = 8,
  CORNER_UVS,
  STRIPS,
  NOTHING
} meaning;

typedef struct property {
  number_kind count, kind; /* kind of a list's count, or NO_KIND; kind of its values */
  meaning meaning;
} property;

typedef struct element {
  char name[64];
  size_t count, properties;
  property property[MOST_PROPERTIES];
} element;

typedef enum encoding { TEXT, LITTLE, BIG } encoding;

typedef struct reading {
  abbe_mesh_reading *to;
  const char *at, *end;
  encoding encoding;
  size_t corners, first_uv,
      uvs;          /* for the face that is read: its corners, and its own list of uv */
  size_t vertex_uv; /* the first vertex's */
  bool vertex_uvs;  /* vertices have some */
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

/* The names that programs give to properties. */
static meaning meaning_of(const char *owner, const char *name, bool list) {
  static const struct {
    const char *owner, *name;
    bool list;
    meaning meaning;
  } known[] = {
      {"vertex", "x", false, POINT},
      {"vertex", "y", false, POINT + 1},
      {"vertex", "z", false, POINT + 2},
      {"vertex", "nx", false, NORMAL},
      {"vertex", "ny", false, NORMAL + 1},
      {"vertex", "nz", false, NORMAL + 2},
      {"vertex", "u", false, UV},
      {"vertex", "v", false, UV + 1},
      {"vertex", "s", false, UV},
      {"vertex", "t", false, UV + 1},
      {"vertex", "texture_u", false, UV},
      {"vertex", "texture_v", false, UV + 1},
      {"face", "vertex_indices", true, CORNERS},
      {"face", "vertex_index", true, CORNERS},
      {"face", "texcoord", true, CORNER_UVS},
      {"tristrips", "vertex_indices", true, STRIPS},
      {"tristrips", "vertex_index", true, STRIPS},
  };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (known[i].list == list && strcmp(known[i].owner, owner) == 0 &&
        strcmp(known[i].name, name) == 0)
      return known[i].meaning;
  return NOTHING;
}

/* A name says what an element is, so it stands once. */
static bool take_element(reading *r, const char *line) {
  if (r->elements == MOST_ELEMENTS) return false;
  element *e = &r->element[r->elements];
  *e = (element){0};
  if (sscanf(line, "element %63s %20zu", e->name, &e->count) != 2) return false;
  for (size_t i = 0; i < r->elements; i++)
    if (strcmp(r->element[i].name, e->name) == 0) return false;
  r->elements++;
  return true;
}

static bool take_property(reading *r, const char *line) {
  char first[32], second[32], name[64];
  if (r->elements == 0 || r->element[r->elements - 1].properties == MOST_PROPERTIES) return false;
  element *e = &r->element[r->elements - 1];
  property *p = &e->property[e->properties];
  *p = (property){.count = NO_KIND};
  if (sscanf(line, "property list %31s %31s %63s", first, second, name) == 3) {
    p->count = kind_named(first);
    p->kind = kind_named(second);
    if (p->count == NO_KIND || p->count >= F32) return false;
  } else if (sscanf(line, "property %31s %63s", second, name) == 2) {
    p->kind = kind_named(second);
  } else {
    return false;
  }
  p->meaning = meaning_of(e->name, name, p->count != NO_KIND);
  e->properties++;
  return p->kind != NO_KIND;
}

static bool take_format(reading *r, const char *line) {
  static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  const char *name = line + 7 + strspn(line + 7, " ");
  const size_t length = strcspn(name, " ");
  for (int i = 0; i < 3; i++)
    if (strlen(names[i]) == length && memcmp(name, names[i], length) == 0) {
      r->encoding = (encoding)i;
      return true;
    }
  return false;
}

/* Blanks before and behind what the line says, and tabs in it. */
static void tidy(char *text, size_t length) {
  while (length > 0 && strchr("\r \t", text[length - 1]) != NULL) text[--length] = '\0';
  const size_t blank = strspn(text, " \t");
  memmove(text, text + blank, length - blank + 1);
  for (; *text != '\0'; text++)
    if (*text == '\t') *text = ' ';
}

/* One line into text, without its end, which is that of the first: a binary body may begin with
 * either of its bytes. False where there is none, or too long a one that is no comment. */
static bool next_line(reading *r, const char *ending, char *text, size_t size) {
  const char *end = memchr(r->at, ending[0], (size_t)(r->end - r->at));
  if (end == NULL) return false;
  size_t length = (size_t)(end - r->at);
  if (length >= size) {
    if (strncmp(r->at, "comment", 7) != 0 && strncmp(r->at, "obj_info", 8) != 0) return false;
    length = size - 1;
  }
  memcpy(text, r->at, length);
  text[length] = '\0';
  r->at = end + 1;
  if (ending[1] != '\0' && r->at < r->end && *r->at == ending[1]) r->at++;
  tidy(text, length);
  return true;
}

static const char *ending_of(const reading *r) {
  const char *at = r->at;
  while (at < r->end && *at != '\r' && *at != '\n') at++;
  return at + 1 < r->end && at[0] == '\r' ? (at[1] == '\n' ? "\r\n" : "\r") : "\n";
}

static bool take_line(reading *r, const char *line, int number) {
  if (number == 1) return strcmp(line, "ply") == 0;
  if (strncmp(line, "format ", 7) == 0) return take_format(r, line);
  if (strncmp(line, "element ", 8) == 0) return take_element(r, line);
  if (strncmp(line, "property ", 9) == 0) return take_property(r, line);
  return strncmp(line, "comment", 7) == 0 || strncmp(line, "obj_info", 8) == 0 || line[0] == '\0';
}

static abbe_result read_header(reading *r, size_t size, abbe_error *error) {
  char line[512];
  const char *ending = ending_of(r);
  for (int i = 1; i <= MOST_LINES; i++) {
    if (!next_line(r, ending, line, sizeof line)) {
      if (i > 1 && r->end - r->at < (ptrdiff_t)sizeof line) break;
      line[0] = '?';
      line[1] = '\0';
    }
    if (i > 1 && strcmp(line, "end_header") == 0) return ABBE_OK;
    if (!take_line(r, line, i))
      return abbe_error_set(error, ABBE_PARSE,
                            "%s: line %d is none of a PLY header; it begins with 'ply', then lines "
                            "of format, comment, obj_info, element or property, and end_header",
                            r->to->path, i);
    const element *e = r->elements > 0 ? &r->element[r->elements - 1] : NULL;
    if (e != NULL && e->properties == 0 && e->count > size)
      return abbe_error_set(error, ABBE_PARSE,
                            "%s: line %d announces %zu elements '%s', more than the %zu bytes of "
                            "the file can hold",
                            r->to->path, i, e->count, e->name, size);
  }
  return abbe_error_set(error, ABBE_PARSE, "%s: the PLY header has no end_header", r->to->path);
}

/* ---- numbers ---- */

static void skip_blanks(reading *r) {
  while (r->at < r->end && (*r->at == '\n' || *r->at == '\r' || *r->at == ' ' || *r->at == '\t'))
    r->at++;
}

static bool read_text(reading *r, double *out) {
  skip_blanks(r);
  return abbe_number_read(r->at, &r->at, out); /* a zero byte ends the file */
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
#define TAKE(type)                                                                                 \
  {                                                                                                \
    type value;                                                                                    \
    memcpy(&value, bytes, sizeof value);                                                           \
    *out = (double)value;                                                                          \
    return true;                                                                                   \
  }
  switch (kind) {
  case I8:
    TAKE(int8_t)
  case U8:
    TAKE(uint8_t)
  case I16:
    TAKE(int16_t)
  case U16:
    TAKE(uint16_t)
  case I32:
    TAKE(int32_t)
  case U32:
    TAKE(uint32_t)
  case F32:
    TAKE(float)
  default:
    TAKE(double)
  }
#undef TAKE
}

static bool read_number(reading *r, number_kind kind, double *out) {
  return r->encoding == TEXT ? read_text(r, out) : read_binary(r, kind, out);
}

/* ---- the body ---- */

/* Why an element was not read; in the order in which it is reported. */
typedef enum trouble { FINE, ENDS, NO_INDEX, NO_UVS, NO_MEMORY } trouble;

static trouble read_index(reading *r, number_kind kind, double least, double *out) {
  if (!read_number(r, kind, out)) return ENDS;
  return *out >= least && *out < (double)UINT32_MAX && *out == (double)(int64_t)*out ? FINE
                                                                                     : NO_INDEX;
}

static bool add_corner(reading *r, double point) {
  const uint32_t index = (uint32_t)point;
  return abbe_mesh_reading_corner(
      r->to, (abbe_mesh_corner){index, ABBE_MESH_READING_NONE, ABBE_MESH_READING_NONE});
}

static trouble read_corners(reading *r, number_kind kind, size_t count) {
  for (size_t i = 0; i < count; i++) {
    double index;
    const trouble why = read_index(r, kind, 0, &index);
    if (why != FINE) return why;
    if (!add_corner(r, index)) return NO_MEMORY;
  }
  r->corners = count;
  return abbe_mesh_reading_end_polygon(r->to) ? FINE : NO_MEMORY;
}

/* Every second triangle of a strip is reversed; -1 begins another strip. */
static trouble read_strip(reading *r, number_kind kind, size_t count) {
  double last[2] = {-1, -1};
  bool odd = false;
  for (size_t i = 0; i < count; i++) {
    double index;
    const trouble why = read_index(r, kind, -1, &index);
    if (why != FINE) return why;
    if (index >= 0 && last[0] >= 0) {
      const bool turns = last[0] == last[1] || last[1] == index || index == last[0];
      if (!turns && !(add_corner(r, last[odd]) && add_corner(r, last[!odd]) &&
                      add_corner(r, index) && abbe_mesh_reading_end_polygon(r->to)))
        return NO_MEMORY;
      odd = !odd;
    }
    if (index < 0) odd = false;
    last[0] = index < 0 ? -1 : last[1];
    last[1] = index;
  }
  return FINE;
}

/* They may stand before the corners as well as behind them. */
static trouble read_corner_uvs(reading *r, number_kind kind, size_t count) {
  r->first_uv = r->to->uv.count;
  r->uvs = count / 2;
  if (count % 2 != 0) return NO_UVS;
  for (size_t i = 0; i < r->uvs; i++) {
    double uv[2];
    if (!read_number(r, kind, &uv[0]) || !read_number(r, kind, &uv[1])) return ENDS;
    if (!abbe_mesh_list_add(&r->to->uv, 1, sizeof uv, uv)) return NO_MEMORY;
  }
  return FINE;
}

/* A face with fewer than three corners has none. */
static trouble give_uvs(reading *r) {
  if (r->uvs != 0 && r->uvs != r->corners) return NO_UVS;
  abbe_mesh_corner *corner = r->to->corner.item;
  for (size_t i = 0; i < r->uvs && r->corners >= 3; i++)
    corner[r->to->corner.count - r->corners + i].uv = (uint32_t)(r->first_uv + i);
  return FINE;
}

static trouble read_property(reading *r, const property *p, double vertex[8]) {
  double value, count = 1;
  if (p->count != NO_KIND) {
    if (!read_number(r, p->count, &count) || !(count >= 0 && count < (double)UINT32_MAX))
      return ENDS;
    if (p->meaning == CORNERS) return read_corners(r, p->kind, (size_t)count);
    if (p->meaning == STRIPS) return read_strip(r, p->kind, (size_t)count);
    if (p->meaning == CORNER_UVS) return read_corner_uvs(r, p->kind, (size_t)count);
  }
  for (size_t i = 0; i < (size_t)count; i++) {
    if (!read_number(r, p->kind, &value)) return ENDS;
    if (p->meaning < CORNERS) vertex[p->meaning] = value;
  }
  return FINE;
}

static bool has(const element *e, meaning what) {
  for (size_t p = 0; p < e->properties; p++)
    if (e->property[p].meaning == what) return true;
  return false;
}

static bool add_vertex(reading *r, const element *e, const double vertex[8]) {
  return abbe_mesh_reading_point(r->to, vertex) &&
         (!has(e, NORMAL) ||
          abbe_mesh_list_add(&r->to->normal, 1, 3 * sizeof *vertex, vertex + NORMAL)) &&
         (!has(e, UV) || abbe_mesh_list_add(&r->to->uv, 1, 2 * sizeof *vertex, vertex + UV));
}

/* *instance: the number of the one that was not read, from 1 on. */
static trouble read_element(reading *r, const element *e, size_t *instance) {
  const bool is_vertex = strcmp(e->name, "vertex") == 0;
  trouble why = FINE;
  *instance = 1;
  if (is_vertex) {
    r->vertex_uvs = has(e, UV);
    r->vertex_uv = r->to->uv.count;
  }
  /* a byte at the least for each of its values; what has none says nothing */
  if (e->properties == 0 && e->count > 0) return ENDS;
  if (e->properties > 0 && e->count > (size_t)(r->end - r->at) / e->properties) return ENDS;
  for (*instance = 0; *instance < e->count && why == FINE; ++*instance) {
    double vertex[8] = {0};
    r->corners = r->uvs = 0;
    for (size_t p = 0; p < e->properties && why == FINE; p++)
      why = read_property(r, &e->property[p], vertex);
    if (why == FINE) why = give_uvs(r);
    if (why == FINE && is_vertex && !add_vertex(r, e, vertex)) why = NO_MEMORY;
    /* some programs write more behind an element than they announce */
    while (r->encoding == TEXT && r->at < r->end && *r->at != '\n' && *r->at != '\r') r->at++;
  }
  return why;
}

static abbe_result say(const reading *r, trouble why, const element *e, size_t instance,
                       abbe_error *error) {
  if (why == NO_MEMORY) return abbe_mesh_reading_no_memory(r->to, error);
  if (why == NO_INDEX)
    return abbe_error_set(
        error, ABBE_GEOMETRY,
        "%s: element '%s' %zu names a vertex by what is no whole number from 0 on", r->to->path,
        e->name, instance);
  if (why == NO_UVS)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: element '%s' %zu has another number of texture coordinates than two "
                          "for each corner",
                          r->to->path, e->name, instance);
  return abbe_error_set(error, ABBE_PARSE,
                        "%s: it ends, or has something else than a number, before all that its "
                        "header announces: in element '%s' %zu of %zu",
                        r->to->path, e->name, instance, e->count);
}

/* Vertices' normals and texture coordinates are those of corners that have none of their own. */
static void share(reading *r) {
  abbe_mesh_corner *corner = r->to->corner.item;
  const size_t points = r->to->point.count;
  for (size_t i = 0; i < r->to->corner.count; i++) {
    if (r->to->normal.count == points && points > 0) corner[i].normal = corner[i].point;
    if (r->vertex_uvs && corner[i].point < points && corner[i].uv == ABBE_MESH_READING_NONE)
      corner[i].uv = (uint32_t)(r->vertex_uv + corner[i].point);
  }
}

static abbe_result read_body(reading *r, abbe_error *error) {
  for (size_t i = 0; i < r->elements; i++) {
    size_t instance = 0;
    const trouble why = read_element(r, &r->element[i], &instance);
    if (why != FINE) return say(r, why, &r->element[i], instance, error);
  }
  share(r);
  if (r->encoding == TEXT) skip_blanks(r);
  if (r->encoding == TEXT && r->at < r->end)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: it goes on with '%.20s' behind all that its header announces",
                          r->to->path, r->at);
  return ABBE_OK;
}

abbe_result abbe_ply_read(abbe_mesh_reading *to, const char *data, size_t size, abbe_error *error) {
  ABBE_FREED reading *r = calloc(1, sizeof *r);
  if (r == NULL) return abbe_mesh_reading_no_memory(to, error);
  r->to = to;
  r->at = data;
  r->end = data + size;
  ABBE_TRY(read_header(r, size, error));
  return read_body(r, error);
}
