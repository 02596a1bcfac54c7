#include "spectral/editing/table_edit.h"

#include "spectral/editing/check.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_PASSES = 4 };

static bool stands_twice(const abbe_material_table *table, size_t row) {
  for (size_t i = 0; i < table->count; i++)
    if (i != row && strcasecmp(table->material[i].name, table->material[row].name) == 0)
      return true;
  return false;
}

static void refuse(abbe_table_fix *out, const char *name, const char *why) {
  if (out->refused++ == 0) snprintf(out->why, sizeof out->why, "%.80s: %.300s", name, why);
}

static void remember_warning(abbe_table_fix *out, const abbe_material *m) {
  size_t used = strlen(out->warned), length = strlen(m->name);
  if (m->warning == NULL || used + length + 3 > sizeof out->warned) return;
  bool second = used >= length && strcmp(out->warned + used - length, m->name) == 0;
  if (second) return; /* value of the same row */
  snprintf(out->warned + used, sizeof out->warned - used, "%s%s", used > 0 ? ", " : "", m->name);
}

/* The number of values that were set, into *set. */
static abbe_result apply(abbe_table_edit *edit, const abbe_material_table *table,
                         const abbe_findings *found, abbe_table_fix *out, size_t *set,
                         abbe_error *error) {
  out->refused = 0;
  out->why[0] = '\0';
  for (size_t i = 0; i < found->count; i++) {
    const abbe_finding *f = &found->finding[i];
    if (!f->certain || f->key == NULL || f->value == NULL) continue;
    const char *name = table->material[f->row].name;
    abbe_error why = {0};
    if (stands_twice(table, f->row)) {
      refuse(out, name, "the name stands twice, so it does not say which record to fix");
      continue;
    }
    abbe_result result = abbe_table_edit_set(edit, name, f->key, f->value, &why);
    if (result == ABBE_NO_MEMORY) return abbe_error_set(error, result, "%s", why.text);
    if (result != ABBE_OK) {
      refuse(out, name, why.text);
    } else {
      remember_warning(out, &table->material[f->row]);
      ++*set;
    }
  }
  out->fixed += *set;
  return ABBE_OK;
}

static abbe_result pass(abbe_table_edit *edit, const abbe_material_table *known,
                        abbe_table_fix *out, size_t *set, abbe_error *error) {
  size_t size = 0;
  const char *text = abbe_table_edit_text(edit, &size);
  abbe_material_table table;
  abbe_findings found = {0};
  abbe_result result =
      abbe_material_table_parse_lenient(text, size, "the table", &table, NULL, error);
  if (result != ABBE_OK) return result;
  result = abbe_check_table(&table, known, &found, error);
  if (result == ABBE_OK) result = apply(edit, &table, &found, out, set, error);
  abbe_findings_free(&found);
  abbe_material_table_free(&table);
  return result;
}

abbe_result abbe_table_fix_make(abbe_table_edit *edit, const abbe_material_table *known,
                                abbe_table_fix *out, abbe_error *error) {
  *out = (abbe_table_fix){0};
  size_t set = 1;
  abbe_result result = ABBE_OK;
  for (int i = 0; i < MAX_PASSES && set > 0 && result == ABBE_OK; i++) {
    set = 0;
    result = pass(edit, known, out, &set, error);
  }
  return result;
}
