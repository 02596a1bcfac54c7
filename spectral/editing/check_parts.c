#include "spectral/editing/check_parts.h"

#include "base/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
