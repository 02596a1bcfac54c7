#include "spectral/editing/check_parts.h"

#include "base/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- names ---- */

static const struct {
  const char *name, *meaning;
} kinds[] = {
#define ABBE_FINDING_ROW(code, name, meaning) {name, meaning},
    ABBE_FINDING_KINDS(ABBE_FINDING_ROW)
#undef ABBE_FINDING_ROW
};

static bool known_kind(abbe_finding_kind kind) {
  return (int)kind >= 0 && kind < ABBE_FINDING_KIND_COUNT;
}

const char *abbe_finding_kind_name(abbe_finding_kind kind) {
  return known_kind(kind) ? kinds[kind].name : "unknown";
}

const char *abbe_finding_kind_meaning(abbe_finding_kind kind) {
  return known_kind(kind) ? kinds[kind].meaning : "unknown";
}

const char *abbe_finding_weight_name(abbe_finding_weight weight) {
  switch (weight) {
  case ABBE_FINDING_NOTE:
    return "note";
  case ABBE_FINDING_DOUBTFUL:
    return "doubtful";
  case ABBE_FINDING_WRONG:
    return "wrong";
  }
  return "unknown";
}

/* ---- the list ---- */

void abbe_findings_free(abbe_findings *findings) {
  if (findings == NULL) return;
  for (size_t i = 0; i < findings->count; i++) {
    free(findings->finding[i].evidence);
    free(findings->finding[i].fix);
    free(findings->finding[i].value);
  }
  free(findings->finding);
  *findings = (abbe_findings){0};
}

/* A finding at the end of the list, of that row and without a text yet; NULL for want of memory. It
 * stays where it is until the next is added. */
static abbe_finding *findings_add(abbe_findings *findings, abbe_finding_kind kind,
                                  abbe_finding_weight weight, size_t row) {
  abbe_findings *f = findings;
  if (f->count == f->capacity) {
    size_t capacity = f->capacity > 0 ? 2 * f->capacity : 16;
    abbe_finding *larger = realloc(f->finding, capacity * sizeof *larger);
    if (larger == NULL) return NULL;
    f->finding = larger;
    f->capacity = capacity;
  }
  abbe_finding *made = &f->finding[f->count++];
  *made = (abbe_finding){.kind = kind, .weight = weight, .row = row, .other = ABBE_FINDING_NO_ROW};
  return made;
}

static abbe_finding *no_memory(abbe_check *c) {
  c->result = abbe_error_set(c->error, ABBE_NO_MEMORY, "no memory for what is found");
  return NULL;
}

bool abbe_check_has(const abbe_check *c, double lambda_nm) {
  return lambda_nm >= c->low_nm && lambda_nm <= c->high_nm;
}

bool abbe_check_is_exponent(const abbe_dispersion *dispersion, size_t k) {
  abbe_dispersion_model model = dispersion->model;
  bool powers = model == ABBE_DISPERSION_POLYNOMIAL || model == ABBE_DISPERSION_POWERS ||
                model == ABBE_DISPERSION_RII4;
  return powers && k > 0 && k % 2 == 0;
}

abbe_finding *abbe_check_find(abbe_check *c, abbe_finding_kind kind, abbe_finding_weight weight) {
  abbe_finding *made = findings_add(c->findings, kind, weight, c->row);
  return made != NULL ? made : no_memory(c);
}

void abbe_check_say(abbe_check *c, char **sentence, const char *format, ...) {
  char text[1200];
  va_list arguments;
  va_start(arguments, format);
  abbe_number_format_list(text, sizeof text, format, arguments);
  va_end(arguments);
  free(*sentence);
  *sentence = strdup(text);
  if (*sentence == NULL) no_memory(c);
}

void abbe_check_set_coefficients(abbe_check *c, abbe_finding *finding,
                                 const abbe_dispersion *right) {
  char list[ABBE_DISPERSION_MAX_COEFFICIENTS * (ABBE_NUMBER_TEXT_SIZE + 2) + 3] = "[";
  char text[ABBE_NUMBER_TEXT_SIZE];
  size_t used = 1;
  for (size_t i = 0; i < right->count; i++)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "",
                             abbe_number_text(right->c[i], text));
  abbe_check_say(c, &finding->value, "%s]", list);
  finding->key = "coefficients";
}

/* Rows that are alike: one name twice, or one glass under two names. */
enum { LINES = 5 };
static const double lines_nm[LINES] = {ABBE_LINE_D_NM, ABBE_LINE_SMALL_G_NM, ABBE_LINE_F_NM,
                                       ABBE_LINE_C_NM, 404.656};

/* Below what catalogues print; and a slip of one in the fifth decimal, which a refractometer does
 * not resolve either. */
static const double SAME = 1e-7, NEAR = 1.5e-5;

typedef struct place {
  size_t row;
  const abbe_material *material;
  double n[LINES];
} place;

static int by_name(const void *a, const void *b) {
  const place *x = a, *y = b;
  int order = strcasecmp(x->material->name, y->material->name);
  return order != 0 ? order : x->row < y->row ? -1 : 1;
}

static int by_index(const void *a, const void *b) {
  const place *x = a, *y = b;
  if (x->n[0] != y->n[0]) return x->n[0] < y->n[0] ? -1 : 1;
  return x->row < y->row ? -1 : 1;
}

/* The finding stands at the later row and names the earlier. */
static abbe_finding *find_pair(abbe_findings *findings, const place *a, const place *b,
                               abbe_finding_kind kind, abbe_finding_weight weight, abbe_check *c) {
  const place *first = a->row < b->row ? a : b, *later = first == a ? b : a;
  *c = (abbe_check){.row = later->row, .findings = findings, .error = c->error};
  abbe_finding *f = abbe_check_find(c, kind, weight);
  if (f != NULL) f->other = first->row;
  return f;
}

static abbe_result compare_names(place *places, size_t count, abbe_findings *findings,
                                 abbe_error *error) {
  qsort(places, count, sizeof *places, by_name);
  for (size_t i = 1; i < count; i++) {
    if (strcasecmp(places[i - 1].material->name, places[i].material->name) != 0) continue;
    abbe_check c = {.error = error};
    abbe_finding *f = find_pair(findings, &places[i - 1], &places[i], ABBE_FINDING_SAME_NAME,
                                ABBE_FINDING_WRONG, &c);
    if (f != NULL) {
      abbe_check_say(&c, &f->evidence, "the name '%s' stands on lines %zu and %zu",
                     places[i].material->name, places[i - 1].material->line,
                     places[i].material->line);
      abbe_check_say(&c, &f->fix, "rename or remove one of the two");
    }
    if (c.result != ABBE_OK) return c.result;
  }
  return ABBE_OK;
}

/* The largest difference at the lines where both have an index. */
static double apart(const place *a, const place *b) {
  double largest = NAN;
  for (int k = 0; k < LINES; k++) largest = fmax(largest, fabs(a->n[k] - b->n[k]));
  return largest;
}

static abbe_result note_pair(const place *a, const place *b, double off, abbe_findings *findings,
                             abbe_error *error) {
  abbe_check c = {.error = error};
  bool same = off <= SAME;
  abbe_finding *f = find_pair(findings, a, b, same ? ABBE_FINDING_SAME : ABBE_FINDING_NEAR,
                              ABBE_FINDING_NOTE, &c);
  if (f == NULL) return c.result;
  const place *first = a->row < b->row ? a : b;
  const bool absorbs = a->material->attenuation != NULL || b->material->attenuation != NULL ||
                       abbe_material_is_fluorescent(a->material) ||
                       abbe_material_is_fluorescent(b->material);
  const char *besides = absorbs ? "; absorption is not compared" : "";
  if (off == 0)
    abbe_check_say(&c, &f->evidence, "n is that of %s (line %zu)%s", first->material->name,
                   first->material->line, besides);
  else
    abbe_check_say(&c, &f->evidence, "n differs from that of %s (line %zu) by %.1g at most%s",
                   first->material->name, first->material->line, off, besides);
  abbe_check_say(&c, &f->fix,
                 same ? "keep one, unless they differ in something else"
                      : "the same glass from two sources, or a copy with a slip?");
  return c.result;
}

static abbe_result compare_indices(place *places, size_t count, abbe_findings *findings,
                                   abbe_error *error) {
  /* constants are round numbers, and alike by chance */
  size_t kept = 0;
  for (size_t i = 0; i < count; i++)
    if (isfinite(places[i].n[0]) &&
        places[i].material->dispersion.model != ABBE_DISPERSION_CONSTANT)
      places[kept++] = places[i];
  qsort(places, kept, sizeof *places, by_index);
  for (size_t i = 0; i < kept; i++)
    for (size_t k = i + 1; k < kept && places[k].n[0] - places[i].n[0] <= NEAR; k++) {
      double off = apart(&places[i], &places[k]);
      if (!(off <= NEAR)) continue;
      ABBE_TRY(note_pair(&places[i], &places[k], off, findings, error));
      break; /* each row is named once, however many are alike */
    }
  return ABBE_OK;
}

abbe_result abbe_check_compare_rows(const abbe_material_table *table, abbe_findings *findings,
                                    abbe_error *error) {
  ABBE_FREED place *places = malloc((table->count + 1) * sizeof *places);
  if (places == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to compare rows");
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    places[i] = (place){.row = i, .material = m};
    for (int k = 0; k < LINES; k++) {
      bool told = m->extrapolate || !abbe_material_extrapolates(m, lines_nm[k]);
      places[i].n[k] = told ? abbe_dispersion_n(&m->dispersion, lines_nm[k]) : NAN;
    }
  }
  ABBE_TRY(compare_names(places, table->count, findings, error));
  return compare_indices(places, table->count, findings, error);
}
