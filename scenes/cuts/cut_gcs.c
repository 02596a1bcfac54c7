#include "scenes/cuts/cut_file.h"

#include "base/maths.h"
#include "base/number.h"
#include "base/text.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DEPTH = 16, ASSUMED_GEAR = 96, MOST_FOLDS = 1000 };

typedef struct reading {
  XML_Parser parser;
  const char *name;
  abbe_cut *cut;
  abbe_report *report;
  abbe_error *error;
  abbe_result result;
  int depth; /* depth of elements */
  bool in_tier, in_facet, geared;
  double angle_deg, distance; /* the tier's; NAN: not stated */
  double n[3];                /* the facet's normal; NAN: not stated */
  double index_deg, reach;    /* the facet's index, how far its corners lie; NAN: not stated */
  size_t facet_line;
} reading;

/* The first failure holds; the parser goes no further. */
static void stop(reading *r, abbe_result code) {
  r->result = code;
  XML_StopParser(r->parser, XML_FALSE);
}

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static void
fail(reading *r, abbe_result code, const char *format, ...) {
  char prefix[300];
  va_list arguments;
  if (r->result != ABBE_OK) return;
  snprintf(prefix, sizeof prefix, "%.255s:%zu: ", r->name, abbe_xml_line(r->parser));
  va_start(arguments, format);
  abbe_error_set_list(r->error, code, prefix, format, arguments);
  va_end(arguments);
  stop(r, code);
}

static void no_memory(reading *r) {
  abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for a design");
  stop(r, ABBE_NO_MEMORY);
}

static const char *attribute(const char **attributes, const char *key) {
  for (; attributes[0]; attributes += 2)
    if (strcmp(attributes[0], key) == 0) return attributes[1];
  return NULL;
}

/* What the attribute says, or `otherwise` where there is none. */
static double number(reading *r, const char **attributes, const char *key, double otherwise) {
  const char *text = attribute(attributes, key), *end;
  double value;
  if (!text) return otherwise;
  if (abbe_number_read(text, &end, &value) && isfinite(value)) {
    while (*end == ' ') end++;
    if (*end == '\0') return value;
  }
  fail(r, ABBE_SCHEMA, "'%s' is a number, not '%.40s'", key, text);
  return otherwise;
}

/* A copy of the attribute on one line, or NULL where it is empty. */
static char *words(reading *r, const char **attributes, const char *key) {
  const char *text = attribute(attributes, key);
  if (!text || text[0] == '\0') return NULL;
  char *copy = strdup(text);
  if (!copy) no_memory(r);
  for (char *c = copy; c && *c != '\0'; c++)
    if ((unsigned char)*c < ' ') *c = ' ';
  return copy;
}

/* ---- elements ---- */

/* For people alone, since every facet is listed: what is no number of folds is passed over, not
 * refused. 0 says nothing. */
static void begin_symmetry(reading *r, const char **attributes) {
  const char *text = attribute(attributes, "symmetry"), *mirror = attribute(attributes, "mirror");
  const char *end;
  double folds = 0;
  if (text && (!abbe_number_read(text, &end, &folds) || *end != '\0' || folds != round(folds) ||
               !(folds >= 0 && folds <= MOST_FOLDS))) {
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, abbe_xml_line(r->parser), NULL,
                    "the symmetry '%.40s' is no number of folds", text);
    return;
  }
  r->cut->folds = (int)folds;
  r->cut->mirror = mirror && (strcmp(mirror, "1") == 0 || strcmp(mirror, "true") == 0);
}

static void begin_index(reading *r, const char **attributes) {
  const double gear = number(r, attributes, "gear", ASSUMED_GEAR);
  if (gear == 0 || gear != round(gear) || fabs(gear) > ABBE_CUT_MAX_GEAR)
    fail(r, ABBE_SCHEMA, "a gear has 1 to %d teeth, not %g", ABBE_CUT_MAX_GEAR, gear);
  else
    r->cut->gear = (int)gear;
  r->geared = true;
  if (r->result == ABBE_OK) begin_symmetry(r, attributes);
}

static void begin_tier(reading *r, const char **attributes) {
  const double degrees = number(r, attributes, "angle", NAN);
  r->in_tier = true;
  r->distance = number(r, attributes, "depth", NAN);
  if (r->result != ABBE_OK) return;
  if (!(degrees >= 0 && degrees <= 180)) {
    fail(r, ABBE_SCHEMA, "a tier's 'angle' is from 0 (table) to 180 (culet) degrees%s",
         isnan(degrees) ? ", and it is missing" : "");
    return;
  }
  r->angle_deg = degrees < 90 ? degrees : degrees - 180; /* 180: +0 */
  if (degrees == 180) r->angle_deg = -0.0;
  if (abbe_cut_add_tier(r->cut, r->angle_deg, 0, r->error) != ABBE_OK) {
    stop(r, ABBE_NO_MEMORY);
    return;
  }
  r->cut->tier[r->cut->tier_count - 1].instruction = words(r, attributes, "instructions");
}

static void begin_facet(reading *r, const char **attributes) {
  static const char *const keys[] = {"nx", "ny", "nz"};
  r->in_facet = true;
  r->reach = NAN;
  for (int k = 0; k < 3; k++) r->n[k] = number(r, attributes, keys[k], NAN);
  r->index_deg = number(r, attributes, "index_angle", NAN);
}

/* The normal of an angle and an index: on the crown they turn in the other direction than below. */
static bool find_normal(reading *r) {
  if (abbe_vector_finite(r->n) && abbe_vector_normalise(r->n)) return true;
  if (!isfinite(r->index_deg)) return false;
  const bool crown = !signbit(r->angle_deg);
  const double turn = (crown ? r->index_deg - 90 : 270 - r->index_deg) * ABBE_PI / 180;
  const double slope = fabs(r->angle_deg) * ABBE_PI / 180;
  r->n[0] = sin(slope) * cos(turn);
  r->n[1] = sin(slope) * sin(turn);
  r->n[2] = crown ? cos(slope) : -cos(slope);
  return abbe_vector_normalise(r->n);
}

static void begin_vertex(reading *r, const char **attributes) {
  static const char *const keys[] = {"x", "y", "z"};
  double at[3];
  for (int k = 0; k < 3; k++) at[k] = number(r, attributes, keys[k], NAN);
  if (r->result != ABBE_OK) return;
  if (!abbe_vector_finite(at)) {
    fail(r, ABBE_SCHEMA, "a 'vertex' has x, y and z");
    return;
  }
  if (!find_normal(r)) return;
  const double reach = abbe_vector_dot(r->n, at);
  if (!(reach <= r->reach)) r->reach = reach; /* NAN at first */
}

static void end_facet(reading *r) {
  r->in_facet = false;
  if (!find_normal(r)) {
    fail(r, ABBE_SCHEMA, "a facet has no direction: neither nx, ny and nz nor 'index_angle'");
    return;
  }
  const double distance = isfinite(r->distance) ? r->distance : r->reach;
  if (!(distance >= 1 / ABBE_CUT_FAR && distance <= ABBE_CUT_FAR)) {
    if (isnan(distance))
      fail(r, ABBE_SCHEMA, "a tier without 'depth' wants facets with vertices");
    else
      fail(r, ABBE_SCHEMA, "a facet's plane is %g from the centre; it must be above 0, %g to %g",
           distance, 1 / ABBE_CUT_FAR, ABBE_CUT_FAR);
    return;
  }
  const abbe_result result = abbe_cut_add_facet(r->cut, 0, r->error);
  if (result == ABBE_UNSUPPORTED)
    fail(r, result, "more than %d facets; no stone has so many", ABBE_CUT_MAX_FACETS);
  else if (result != ABBE_OK)
    stop(r, result);
  if (result != ABBE_OK) return;
  abbe_cut_facet *facet = &r->cut->facet[r->cut->facet_count - 1];
  facet->n[0] = -r->n[0];
  facet->n[1] = -r->n[1];
  facet->n[2] = r->n[2];
  facet->d = distance;
}

/* A tier without facets is none. One whose facets' corners say their depths has the mean of them.
 */
static void end_tier(reading *r, char *name) {
  abbe_cut *cut = r->cut;
  abbe_cut_tier *tier = &cut->tier[cut->tier_count - 1];
  r->in_tier = false;
  if (tier->count == 0) {
    free(tier->instruction);
    free(name);
    cut->tier_count--;
    return;
  }
  for (size_t i = 0; i < tier->count; i++)
    tier->distance += cut->facet[tier->first + i].d / (double)tier->count;
  cut->facet[tier->first].name = name;
}

static void begin_info(reading *r, const char **attributes) {
  static const char *const keys[] = {"title", "author", "date", "shape", "footer1", "footer2"};
  size_t heading = 0, footnote = 0;
  for (size_t i = 0; i < sizeof keys / sizeof *keys && r->result == ABBE_OK; i++) {
    char *text = words(r, attributes, keys[i]);
    char **line = i < 4 ? &r->cut->heading[heading] : &r->cut->footnote[footnote];
    if (!text) continue;
    free(*line);
    *line = text;
    if (i < 4) heading++;
    if (i >= 4) footnote++;
  }
}

static void begin_render(reading *r, const char **attributes) {
  const double n = number(r, attributes, "refractive_index", 0);
  if (n > 1 && n < 100) r->cut->refractive_index = n;
}

/* ---- the document ---- */

typedef struct document {
  reading r;
  char *tier_name;
} document;

static void XMLCALL begin(void *data, const XML_Char *element, const XML_Char **attributes) {
  document *d = data;
  reading *r = &d->r;
  if (r->result != ABBE_OK) return;
  if (r->depth == 0 && strcmp(element, "GemCutStudio") != 0) {
    fail(r, ABBE_PARSE, "this is no design of Gem Cut Studio: it begins with <%.40s>", element);
    return;
  }
  if (++r->depth > MOST_DEPTH) {
    fail(r, ABBE_PARSE, "elements are nested deeper than in any design");
    return;
  }
  if (r->depth == 2 && strcmp(element, "index") == 0) begin_index(r, attributes);
  if (r->depth == 2 && strcmp(element, "info") == 0) begin_info(r, attributes);
  if (r->depth == 2 && strcmp(element, "render") == 0) begin_render(r, attributes);
  if (r->depth == 2 && strcmp(element, "tier") == 0) {
    begin_tier(r, attributes);
    if (r->result == ABBE_OK) d->tier_name = words(r, attributes, "name");
  }
  if (r->depth == 3 && r->in_tier && strcmp(element, "facet") == 0) begin_facet(r, attributes);
  if (r->depth == 4 && r->in_facet && strcmp(element, "vertex") == 0) begin_vertex(r, attributes);
}

static void XMLCALL end(void *data, const XML_Char *element) {
  document *d = data;
  reading *r = &d->r;
  (void)element;
  if (r->result != ABBE_OK) return;
  r->depth--;
  if (r->depth == 2 && r->in_facet) end_facet(r);
  if (r->depth != 1 || !r->in_tier) return;
  end_tier(r, d->tier_name);
  d->tier_name = NULL;
}

/* Whatever has one may have entities: of other files, or that grow without end. */
static void XMLCALL refuse_type(void *data, const XML_Char *name, const XML_Char *system,
                                const XML_Char *public, int internal) {
  (void)name;
  (void)system;
  (void)public;
  (void)internal;
  fail(&((document *)data)->r, ABBE_PARSE, "a design has no document type (<!DOCTYPE)");
}

static const char *encoding_of(const char *data, size_t size) {
  const char *end = memchr(data, '>', size);
  const size_t head = end ? (size_t)(end - data) : 0;
  if (size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0) return NULL;
  if (size >= 2 && (memcmp(data, "\xff\xfe", 2) == 0 || memcmp(data, "\xfe\xff", 2) == 0))
    return NULL;
  for (size_t i = 0; i + 8 < head && memcmp(data, "<?xml", 5) == 0; i++)
    if (memcmp(data + i, "encoding", 8) == 0) return NULL; /* the file says it */
  return "windows-1252";
}

/* expat knows neither Windows-1252 nor what it lacks: letter by letter. */
static int XMLCALL know_encoding(void *data, const XML_Char *name, XML_Encoding *info) {
  static const unsigned short high[32] = {
      0x20ac, 0x81,   0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160,
      0x2039, 0x0152, 0x8d,   0x017d, 0x8f,   0x90,   0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
      0x2013, 0x2014, 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0x9d,   0x017e, 0x0178};
  char lower[16] = "";
  (void)data;
  for (size_t i = 0; name[i] != '\0' && i + 1 < sizeof lower; i++)
    lower[i] = (char)(name[i] >= 'A' && name[i] <= 'Z' ? name[i] + 32 : name[i]);
  if (strcmp(lower, "windows-1252") != 0 && strcmp(lower, "cp1252") != 0) return XML_STATUS_ERROR;
  for (int i = 0; i < 256; i++) info->map[i] = i >= 0x80 && i < 0xa0 ? high[i - 0x80] : i;
  info->data = NULL;
  info->convert = NULL;
  info->release = NULL;
  return XML_STATUS_OK;
}

static void parse(document *d, const char *data, size_t size) {
  reading *r = &d->r;
  XML_SetUserData(r->parser, d);
  XML_SetElementHandler(r->parser, begin, end);
  XML_SetStartDoctypeDeclHandler(r->parser, refuse_type);
  XML_SetUnknownEncodingHandler(r->parser, know_encoding, NULL);
  if (XML_Parse(r->parser, data, (int)size, 1) == XML_STATUS_OK || r->result != ABBE_OK) return;
  if (XML_GetErrorCode(r->parser) == XML_ERROR_NO_MEMORY)
    no_memory(r);
  else
    fail(r, ABBE_PARSE, "this is no well-formed XML, as a .gcs design is: %s",
         XML_ErrorString(XML_GetErrorCode(r->parser)));
}

static abbe_result finish(reading *r) {
  abbe_cut *cut = r->cut;
  abbe_error inner = {0};
  if (!r->geared) {
    cut->gear = ASSUMED_GEAR;
    abbe_report_add(r->report, ABBE_NOTE_ASSUMED, 0, NULL,
                    "no 'index' says the gear; %d teeth are assumed", ASSUMED_GEAR);
  }
  for (size_t i = 0; i < cut->facet_count; i++)
    cut->facet[i].index = abbe_cut_index(cut, cut->facet[i].n);
  for (size_t t = 0; t < cut->tier_count; t++) { /* the normals rule over what a tier says */
    double sum = 0;
    for (size_t i = 0; i < cut->tier[t].count; i++)
      sum += fabs(abbe_cut_angle(cut->facet[cut->tier[t].first + i].n));
    const double mean = sum / (double)cut->tier[t].count;
    const bool below = signbit(abbe_cut_angle(cut->facet[cut->tier[t].first].n));
    cut->tier[t].angle_deg = below ? -mean : mean;
  }
  const abbe_result result = abbe_cut_check(cut, &inner);
  return result == ABBE_OK
             ? result
             : abbe_error_set(r->error, result, "%.255s: %.600s", r->name, inner.text);
}

abbe_result abbe_cut_gcs_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error) {
  memset(out, 0, sizeof *out);
  document d = {.r = {.name = name, .cut = out, .report = report, .error = error}};
  if (size > INT_MAX)
    return abbe_error_set(error, ABBE_PARSE, "%.255s: no design is as long", name);
  d.r.parser = XML_ParserCreate(encoding_of(data, size));
  if (!d.r.parser) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design");
  parse(&d, data, size);
  XML_ParserFree(d.r.parser);
  free(d.tier_name);
  if (d.r.result == ABBE_OK) d.r.result = finish(&d.r);
  if (d.r.result != ABBE_OK) abbe_cut_free(out);
  return d.r.result;
}

/* ---- out ---- */

/* From the design to the file: turned by half a turn, moved down, scaled. */
typedef struct writing {
  const abbe_cut *cut;
  const abbe_cut_polyhedron *p;
  FILE *to;
  double scale, middle;
} writing;

static void write_text(FILE *to, const char *key, const char *text) {
  if (text == NULL || text[0] == '\0') return;
  fprintf(to, " %s=\"", key);
  for (const char *c = text; *c != '\0'; c++) {
    if (strchr("&<>\"", *c) != NULL || (unsigned char)*c < ' ')
      fprintf(to, "&#%d;", (unsigned char)*c < ' ' ? ' ' : *c);
    else
      fputc(*c, to);
  }
  fputc('"', to);
}

static void write_value(FILE *to, const char *key, double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, " %s=\"%s\"", key, abbe_number_text(value, text));
}

static double depth_of(const writing *w, const abbe_cut_facet *f) {
  return w->scale * (f->d - w->middle * f->n[2]);
}

static void write_facet(const writing *w, const abbe_cut_face *face) {
  const abbe_cut_facet *f = &w->cut->facet[face->facet];
  const double turn = atan2(-f->n[1], -f->n[0]) * 180 / ABBE_PI;
  const bool crown = !signbit(w->cut->tier[f->tier].angle_deg);
  fputs("    <facet", w->to);
  write_value(w->to, "nx", -f->n[0]);
  write_value(w->to, "ny", -f->n[1]);
  write_value(w->to, "nz", f->n[2]);
  write_value(w->to, "index_angle", fmod(720 + (crown ? 90 + turn : 270 - turn), 360));
  fputs(">\n", w->to);
  for (size_t i = 0; i < face->count; i++) {
    const double *at = w->p->vertex[w->p->corner[face->first + i]];
    fputs("      <vertex", w->to);
    write_value(w->to, "x", -w->scale * at[0]);
    write_value(w->to, "y", -w->scale * at[1]);
    write_value(w->to, "z", w->scale * (at[2] - w->middle));
    fputs("/>\n", w->to);
  }
  fputs("    </facet>\n", w->to);
}

static void write_tier(const writing *w, size_t t) {
  const abbe_cut_tier *tier = &w->cut->tier[t];
  const abbe_cut_facet *first = NULL;
  bool alike = true;
  for (size_t i = 0; i < w->p->face_count; i++) {
    const abbe_cut_facet *f = &w->cut->facet[w->p->face[i].facet];
    if (f->tier != t) continue;
    if (first == NULL) first = f;
    alike = alike && fabs(depth_of(w, f) - depth_of(w, first)) <= 1e-12;
  }
  if (first == NULL) return;
  fputs("  <tier", w->to);
  write_value(w->to, "angle", signbit(tier->angle_deg) ? 180 + tier->angle_deg : tier->angle_deg);
  if (alike) write_value(w->to, "depth", depth_of(w, first));
  write_text(w->to, "name", abbe_cut_facet_name(w->cut, (size_t)(first - w->cut->facet)));
  write_text(w->to, "instructions", tier->instruction);
  fputs(">\n", w->to);
  for (size_t i = 0; i < w->p->face_count; i++)
    if (w->cut->facet[w->p->face[i].facet].tier == t) write_facet(w, &w->p->face[i]);
  fputs("  </tier>\n", w->to);
}

static void write_info(const writing *w) {
  static const char *const heads[] = {"title", "author", "date", "shape"};
  fputs("  <info", w->to);
  for (int i = 0; i < ABBE_CUT_LINES; i++) write_text(w->to, heads[i], w->cut->heading[i]);
  write_text(w->to, "footer1", w->cut->footnote[0]);
  write_text(w->to, "footer2", w->cut->footnote[1]);
  fputs("/>\n", w->to);
}

static abbe_result check_depths(const writing *w, abbe_error *error) {
  for (size_t i = 0; i < w->p->face_count; i++)
    if (!(depth_of(w, &w->cut->facet[w->p->face[i].facet]) >= 1 / ABBE_CUT_FAR))
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "a facet's plane passes the middle of the stone's axis on the wrong "
                            "side, which a .gcs file cannot say; write .asc");
  return ABBE_OK;
}

abbe_result abbe_cut_gcs_write(const abbe_cut *cut, const abbe_cut_polyhedron *p, FILE *to,
                               abbe_report *report, abbe_error *error) {
  const double reach = fmax(fmax(p->max[0], -p->min[0]), fmax(p->max[1], -p->min[1]));
  const writing w = {cut, p, to, 1 / reach, 0.5 * (p->min[2] + p->max[2])};
  ABBE_TRY(check_depths(&w, error));
  fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<GemCutStudio version=\"1000\">\n", to);
  fprintf(to, "  <index gear=\"%d\" symmetry=\"%d\" mirror=\"%d\"/>\n", cut->gear, cut->folds,
          cut->mirror);
  for (size_t t = 0; t < cut->tier_count; t++) write_tier(&w, t);
  if (cut->refractive_index > 0) {
    fputs("  <render", to);
    write_value(to, "refractive_index", cut->refractive_index);
    fputs("/>\n", to);
  }
  write_info(&w);
  fputs("</GemCutStudio>\n", to);
  if (cut->footnote[2] != NULL)
    abbe_report_add(report, ABBE_NOTE_LOST, 0, NULL, "a .gcs file has two lines at its foot");
  return ferror(to) ? abbe_error_set(error, ABBE_IO, "the design cannot be written") : ABBE_OK;
}
