#include "spectral/materials/material_query.h"

#include "spectral/materials/material_numbers.h"

#include <ctype.h>
#include <fnmatch.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *abbe_material_key_name(abbe_material_key key) {
  static const char *const names[] = {
#define ABBE_MATERIAL_KEY_ROW(code, name) name,
      ABBE_MATERIAL_KEYS(ABBE_MATERIAL_KEY_ROW)
#undef ABBE_MATERIAL_KEY_ROW
  };
  return (int)key >= 0 && key < ABBE_MATERIAL_KEY_COUNT ? names[key] : "unknown";
}

/* ---- choosing ---- */

static char *lower(const char *text) {
  char *made = strdup(text);
  for (char *at = made; at != NULL && *at != '\0'; at++) *at = (char)tolower((unsigned char)*at);
  return made;
}

/* Both are in lower case; pattern may be NULL. */
static bool matches(const char *pattern, const char *text) {
  if (pattern == NULL) return true;
  if (text == NULL) return false;
  if (strpbrk(pattern, "*?[") != NULL) return fnmatch(pattern, text, 0) == 0;
  return strstr(text, pattern) != NULL;
}

static bool text_matches(const char *pattern, const char *text, bool *no_memory) {
  if (pattern == NULL) return true;
  char *plain = lower(text != NULL ? text : "");
  if (plain == NULL) *no_memory = true;
  bool found = plain != NULL && matches(pattern, plain);
  free(plain);
  return found;
}

static bool within(double value, double min, double max) {
  return (min == 0 && max == 0) || (value >= min && value <= max);
}

/* ---- sorting ---- */

typedef struct place {
  size_t row;
  double number;    /* NaN: the row has none */
  const char *text; /* NULL where numbers sort */
  bool descending;
} place;

static int in_order(const void *a, const void *b) {
  const place *x = a, *y = b;
  int order = 0;
  if (x->text != NULL && y->text != NULL)
    order = strcasecmp(x->text, y->text);
  else if (isnan(x->number) || isnan(y->number))
    return isnan(x->number) == isnan(y->number) ? (x->row > y->row) - (x->row < y->row)
           : isnan(x->number)                   ? 1
                                                : -1;
  else
    order = (x->number > y->number) - (x->number < y->number);
  if (order != 0) return x->descending ? -order : order;
  return (x->row > y->row) - (x->row < y->row);
}

static place place_of(const abbe_material_table *table, size_t row, const abbe_material_query *q,
                      const abbe_material_numbers *n) {
  const abbe_material *m = &table->material[row];
  place p = {.row = row, .descending = q->descending, .number = (double)row};
  switch (q->sort) {
  case ABBE_MATERIAL_KEY_NAME:
    p.text = m->name;
    break;
  case ABBE_MATERIAL_KEY_SOURCE:
    p.text = m->source != NULL ? m->source : "";
    break;
  case ABBE_MATERIAL_KEY_ND:
    p.number = n->n_d;
    break;
  case ABBE_MATERIAL_KEY_VD:
    p.number = n->v_d;
    break;
  case ABBE_MATERIAL_KEY_BG:
    p.number = n->b_g;
    break;
  case ABBE_MATERIAL_KEY_PGF:
    p.number = n->p_gF;
    break;
  case ABBE_MATERIAL_KEY_FROM:
    p.number = m->min_nm;
    break;
  case ABBE_MATERIAL_KEY_TO:
    p.number = m->max_nm;
    break;
  default:
    break;
  }
  return p;
}

/* ---- both ---- */

static size_t choose(const abbe_material_table *table, const abbe_material_query *q,
                     const char *name, const char *source, place *places, bool *no_memory) {
  size_t count = 0;
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    abbe_material_numbers n;
    abbe_material_numbers_make(m, &n);
    if (within(n.n_d, q->n_d_min, q->n_d_max) && within(n.v_d, q->v_d_min, q->v_d_max) &&
        text_matches(name, m->name, no_memory) && text_matches(source, m->source, no_memory))
      places[count++] = place_of(table, i, q, &n);
  }
  qsort(places, count, sizeof *places, in_order);
  return count;
}

abbe_result abbe_material_query_run(const abbe_material_table *table,
                                    const abbe_material_query *query, size_t **rows, size_t *count,
                                    abbe_error *error) {
  *rows = NULL;
  *count = 0;
  if ((int)query->sort < 0 || query->sort >= ABBE_MATERIAL_KEY_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no key %d to sort by",
                          (int)query->sort);
  place *places = malloc((table->count + 1) * sizeof *places);
  char *name = query->name != NULL ? lower(query->name) : NULL;
  char *source = query->source != NULL ? lower(query->source) : NULL;
  bool no_memory = places == NULL || (query->name != NULL && name == NULL) ||
                   (query->source != NULL && source == NULL);
  size_t found = no_memory ? 0 : choose(table, query, name, source, places, &no_memory);
  if (found > 0) *rows = malloc(found * sizeof **rows);
  no_memory = no_memory || (found > 0 && *rows == NULL);
  for (size_t i = 0; i < found && !no_memory; i++) (*rows)[i] = places[i].row;
  free(places);
  free(name);
  free(source);
  if (no_memory) {
    free(*rows);
    *rows = NULL;
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to choose rows");
  }
  *count = found;
  return ABBE_OK;
}
