#include "scenes/cuts/cut_file.h"

#include "base/maths.h"
#include "scenes/cuts/cut.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define END_OF_FACETS (-99999.0)
enum { MARK = 0x7fff, MOST_TEXT = 255, MOST_FOLDS = 1000 };

/* ---- in ---- */

typedef struct reading {
  const unsigned char *data;
  size_t size, at;
  const char *name;
  abbe_cut *cut;
  abbe_report *report;
  int32_t key; /* the last facet's tier */
} reading;

#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
static abbe_result
fail(const reading *r, size_t at, abbe_result code, abbe_error *error, const char *format, ...) {
  char prefix[300];
  va_list arguments;
  snprintf(prefix, sizeof prefix, "%.255s: byte %zu: ", r->name, at);
  va_start(arguments, format);
  abbe_error_set_list(error, code, prefix, format, arguments);
  va_end(arguments);
  return code;
}

static uint64_t bits_at(const unsigned char *data, size_t bytes) {
  uint64_t bits = 0;
  for (size_t i = 0; i < bytes; i++) bits |= (uint64_t)data[i] << 8 * i;
  return bits;
}

static abbe_result need(const reading *r, size_t bytes, const char *what, abbe_error *error) {
  if (r->size - r->at >= bytes) return ABBE_OK;
  return fail(r, r->at, ABBE_PARSE, error,
              "the file ends within %s; it is cut short, or no .gem design", what);
}

static abbe_result take_doubles(reading *r, double *out, size_t count, const char *what,
                                abbe_error *error) {
  ABBE_TRY(need(r, 8 * count, what, error));
  for (size_t i = 0; i < count; i++, r->at += 8) {
    const uint64_t bits = bits_at(r->data + r->at, 8);
    memcpy(&out[i], &bits, sizeof bits);
  }
  return ABBE_OK;
}

static abbe_result take_whole(reading *r, int32_t *out, const char *what, abbe_error *error) {
  ABBE_TRY(need(r, 4, what, error));
  const uint32_t bits = (uint32_t)bits_at(r->data + r->at, 4);
  memcpy(out, &bits, sizeof bits);
  r->at += 4;
  return ABBE_OK;
}

/* A length and as many bytes. */
static abbe_result take_text(reading *r, const char **text, size_t *length, const char *what,
                             abbe_error *error) {
  ABBE_TRY(need(r, 1, what, error));
  *length = r->data[r->at++];
  ABBE_TRY(need(r, *length, what, error));
  *text = (const char *)r->data + r->at;
  r->at += *length;
  return ABBE_OK;
}

static abbe_result keep(const char *text, size_t length, char **out, abbe_error *error) {
  *out = abbe_cut_text_widen(text, length);
  return *out ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design's text");
}

static abbe_result skip_polygon(reading *r, abbe_error *error) {
  for (;;) {
    int32_t more;
    double vertex[3];
    const size_t at = r->at;
    abbe_result result = take_whole(r, &more, "a facet's corners", error);
    if (result != ABBE_OK || more == 0) return result;
    if (more != 1)
      return fail(r, at, ABBE_PARSE, error,
                  "a facet's corners are each announced by 1 and ended by 0, not %d; this is no "
                  ".gem design",
                  (int)more);
    ABBE_TRY(take_doubles(r, vertex, 3, "a facet's corner", error));
  }
}

/* Facets of one tier have its key, its angle and its distance. */
static bool goes_on(const reading *r, int32_t key, double angle, double distance) {
  const double alike_deg = 1e-6, alike = 1e-7;
  if (r->cut->tier_count == 0 || key != r->key) return false;
  const abbe_cut_tier *tier = &r->cut->tier[r->cut->tier_count - 1];
  return fabs(angle - tier->angle_deg) <= alike_deg &&
         !signbit(angle) == !signbit(tier->angle_deg) &&
         fabs(distance - tier->distance) <= alike * distance;
}

static abbe_result take_words(reading *r, const char *text, size_t length, abbe_error *error) {
  abbe_cut_facet *facet = &r->cut->facet[r->cut->facet_count - 1];
  char **instruction = &r->cut->tier[facet->tier].instruction;
  const char *tab = memchr(text, '\t', length);
  const size_t name = tab ? (size_t)(tab - text) : length;
  if (name > 0) ABBE_TRY(keep(text, name, &facet->name, error));
  if (tab && name + 1 < length && !*instruction)
    ABBE_TRY(keep(tab + 1, length - name - 1, instruction, error));
  return ABBE_OK;
}

static abbe_result take_facet(reading *r, size_t at, const double p[3], abbe_error *error) {
  const double length = abbe_vector_length(p);
  const char *text = NULL;
  size_t text_length = 0;
  int32_t key;
  if (!(length >= 1 / ABBE_CUT_FAR && length <= ABBE_CUT_FAR))
    return fail(r, at, ABBE_SCHEMA, error,
                "facet %zu has no plane: its vector is (%g, %g, %g), of which the length is 1 over "
                "the distance",
                r->cut->facet_count + 1, p[0], p[1], p[2]);
  abbe_result result = take_whole(r, &key, "a facet's tier", error);
  if (result == ABBE_OK) result = take_text(r, &text, &text_length, "a facet's name", error);
  if (result != ABBE_OK) return result;
  double n[3];
  for (int k = 0; k < 3; k++) n[k] = p[k] / length;
  const double angle = abbe_cut_angle(n);
  if (!goes_on(r, key, angle, 1 / length))
    result = abbe_cut_add_tier(r->cut, angle, 1 / length, error);
  r->key = key;
  if (result == ABBE_OK) result = abbe_cut_add_facet(r->cut, 0, error);
  if (result == ABBE_UNSUPPORTED)
    return fail(r, at, result, error, "more than %d facets; no stone has so many",
                ABBE_CUT_MAX_FACETS);
  if (result != ABBE_OK) return result;
  abbe_cut_facet *facet = &r->cut->facet[r->cut->facet_count - 1];
  memcpy(facet->n, n, sizeof n);
  facet->d = 1 / length;
  result = take_words(r, text, text_length, error);
  return result == ABBE_OK ? skip_polygon(r, error) : result;
}

static abbe_result take_facets(reading *r, abbe_error *error) {
  for (;;) {
    double p[3];
    const size_t at = r->at;
    abbe_result result = take_doubles(r, p, 1, "its facets", error);
    if (result == ABBE_OK && p[0] == END_OF_FACETS) return ABBE_OK;
    if (result == ABBE_OK) result = take_doubles(r, p + 1, 2, "a facet's plane", error);
    if (result == ABBE_OK) result = take_facet(r, at, p, error);
    if (result != ABBE_OK) return result;
  }
}

static abbe_result take_lines(reading *r, abbe_error *error) {
  for (int i = 0; i < 2 * ABBE_CUT_LINES; i++) {
    const char *text = NULL;
    size_t length = 0;
    char **line = i < ABBE_CUT_LINES ? &r->cut->heading[i] : &r->cut->footnote[i - ABBE_CUT_LINES];
    ABBE_TRY(take_text(r, &text, &length, "its headings and footnotes", error));
    if (length > 0) ABBE_TRY(keep(text, length, line, error));
  }
  return ABBE_OK;
}

static abbe_result take_trailer(reading *r, abbe_error *error) {
  const char *const what = "what follows the facets";
  abbe_cut *cut = r->cut;
  int32_t folds, mirror, gear, mark;
  ABBE_TRY(take_whole(r, &folds, what, error));
  ABBE_TRY(take_whole(r, &mirror, what, error));
  const size_t gear_at = r->at;
  ABBE_TRY(take_whole(r, &gear, what, error));
  ABBE_TRY(take_doubles(r, &cut->refractive_index, 1, what, error));
  ABBE_TRY(take_whole(r, &mark, what, error));
  const size_t offset_at = r->at;
  ABBE_TRY(take_doubles(r, &cut->offset, 1, what, error));
  ABBE_TRY(take_lines(r, error));
  if (gear == 0 || gear > ABBE_CUT_MAX_GEAR || gear < -ABBE_CUT_MAX_GEAR)
    return fail(r, gear_at, ABBE_SCHEMA, error,
                "a gear has 1 to %d teeth (below 0 where it is reversed), not %d",
                ABBE_CUT_MAX_GEAR, (int)gear);
  if (!(fabs(cut->offset) <= ABBE_CUT_FAR))
    return fail(r, offset_at, ABBE_SCHEMA, error, "the gear's offset %g is not an index",
                cut->offset);
  cut->gear = gear;
  cut->folds = folds > 0 && folds <= MOST_FOLDS ? folds : 0;
  cut->mirror = mirror != 0;
  if (!(cut->refractive_index > 1 && cut->refractive_index < 100)) {
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, 0, NULL, "no stone has a refractive index of %g",
                    cut->refractive_index);
    cut->refractive_index = 0;
  }
  if (r->at < r->size)
    abbe_report_add(r->report, ABBE_NOTE_LOST, 0, NULL,
                    "the %zu bytes behind the design, such as a preform, are left out",
                    r->size - r->at);
  return ABBE_OK;
}

abbe_result abbe_cut_gem_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error) {
  memset(out, 0, sizeof *out);
  reading r = {.data = (const unsigned char *)data,
               .size = size,
               .name = name,
               .cut = out,
               .report = report};
  abbe_result result = take_facets(&r, error);
  if (result == ABBE_OK) result = take_trailer(&r, error);
  for (size_t i = 0; i < out->facet_count && result == ABBE_OK; i++)
    out->facet[i].index = abbe_cut_index(out, out->facet[i].n);
  abbe_error inner = {0};
  if (result == ABBE_OK) {
    result = abbe_cut_check(out, &inner);
    if (result != ABBE_OK) abbe_error_set(error, result, "%.255s: %.600s", name, inner.text);
  }
  if (result != ABBE_OK) abbe_cut_free(out);
  return result;
}

/* ---- out ---- */

static void put_bits(FILE *to, uint64_t bits, int bytes) {
  for (int i = 0; i < bytes; i++) putc((int)(bits >> 8 * i & 0xff), to);
}

static void put_double(FILE *to, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  put_bits(to, bits, 8);
}

static void put_whole(FILE *to, int value) {
  put_bits(to, (uint32_t)value, 4);
}

/* "name", or "name<tab>instruction". */
static void put_text(FILE *to, const char *text, const char *second, abbe_report *report) {
  char narrow[2][1024];
  size_t first = abbe_cut_text_narrow(text, narrow[0], sizeof narrow[0]), rest = 0;
  const size_t room = second ? MOST_TEXT - 1 : MOST_TEXT;
  if (second) rest = abbe_cut_text_narrow(second, narrow[1], sizeof narrow[1]);
  if (first + rest > room)
    abbe_report_add(report, ABBE_NOTE_LOST, 0, NULL, "a text beyond %d bytes is cut: '%.80s'",
                    MOST_TEXT, first > room ? text : second);
  if (first > room) first = room;
  if (rest > room - first) rest = room - first;
  putc((int)(first + rest + (second != NULL)), to);
  fwrite(narrow[0], 1, first, to);
  if (second) putc('\t', to);
  fwrite(narrow[1], 1, rest, to);
}

static void put_facet(const abbe_cut *cut, size_t i, const abbe_cut_polyhedron *p,
                      const abbe_cut_face *face, FILE *to, abbe_report *report) {
  const abbe_cut_facet *f = &cut->facet[i];
  const char *instruction = cut->tier[f->tier].instruction;
  for (int k = 0; k < 3; k++) put_double(to, f->n[k] / f->d);
  put_whole(to, (int)f->tier + 1);
  put_text(to, f->name ? f->name : "", instruction ? instruction : "", report);
  for (size_t c = 0; face && c < face->count; c++) {
    put_whole(to, 1);
    for (int k = 0; k < 3; k++) put_double(to, p->vertex[p->corner[face->first + c]][k]);
  }
  put_whole(to, 0);
}

abbe_result abbe_cut_gem_write(const abbe_cut *cut, const abbe_cut_polyhedron *p, FILE *to,
                               abbe_report *report, abbe_error *error) {
  ABBE_TRY(abbe_cut_check(cut, error));
  size_t next = 0;
  for (size_t i = 0; i < cut->facet_count; i++) {
    const bool has = next < p->face_count && p->face[next].facet == i;
    put_facet(cut, i, p, has ? &p->face[next] : NULL, to, report);
    next += has;
  }
  put_double(to, END_OF_FACETS);
  put_whole(to, cut->folds);
  put_whole(to, cut->mirror);
  put_whole(to, cut->gear);
  put_double(to, cut->refractive_index);
  put_whole(to, MARK);
  put_double(to, cut->offset);
  for (int i = 0; i < 2 * ABBE_CUT_LINES; i++) {
    const char *line = i < ABBE_CUT_LINES ? cut->heading[i] : cut->footnote[i - ABBE_CUT_LINES];
    put_text(to, line ? line : "", NULL, report);
  }
  return ferror(to) ? abbe_error_set(error, ABBE_IO, "the design could not be written") : ABBE_OK;
}
