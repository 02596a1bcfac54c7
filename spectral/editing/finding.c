#include "spectral/editing/finding.h"

#include <stdlib.h>

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

abbe_finding *abbe_findings_add(abbe_findings *findings, abbe_finding_kind kind,
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
