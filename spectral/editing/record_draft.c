#include "spectral/editing/record_draft.h"

#include "base/number.h"
#include "spectral/editing/table_edit.h"
#include "spectral/materials/material_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_STATES = 1000, MAX_FIELDS = 16 + ABBE_DISPERSION_MAX_COEFFICIENTS };

/* A list of fields as the record has them at one time. */
typedef struct field_list {
  size_t count;
  abbe_draft_field field[MAX_FIELDS];
} field_list;

struct abbe_record_draft {
  abbe_table_edit *file;  /* the table's */
  char *file_name;        /* the record's name there */
  abbe_table_edit *alone; /* a table of this record and no other */
  field_list fields, saved;
  char *state[MAX_STATES]; /* texts of `alone`, oldest first */
  size_t state_count, now;
  abbe_material_table table, original; /* holding one material, or none */
  abbe_error trouble;
};

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to edit a record");
}

/* ---- fields ---- */

static void free_fields(field_list *list) {
  for (size_t i = 0; i < list->count; i++) free(list->field[i].text);
  *list = (field_list){0};
}

static const char *name_of(const abbe_record_draft *d) {
  return d->fields.field[0].text;
}

/* "[380, 780]" as "380 780". */
static void strip_brackets(char *text) {
  char *to = text;
  for (const char *c = text; *c != '\0'; c++) {
    bool dropped = *c == '[' || *c == ']' || *c == ',' || *c == '\n' || *c == '\r';
    if (dropped || (*c == ' ' && (to == text || to[-1] == ' '))) continue;
    *to++ = *c;
  }
  while (to > text && to[-1] == ' ') to--;
  *to = '\0';
}

static abbe_result add_field(const abbe_table_edit *alone, const char *name, const char *key,
                             bool number, bool required, field_list *out, abbe_error *error) {
  char *text = NULL;
  abbe_result result = abbe_table_edit_get(alone, name, key, &text, error);
  if (result != ABBE_OK) return result;
  if (text == NULL) text = strdup("");
  if (text == NULL) return no_memory(error);
  if (strcmp(key, "range_nm") == 0) strip_brackets(text);
  abbe_draft_field *f = &out->field[out->count++];
  *f = (abbe_draft_field){.text = text, .number = number, .required = required};
  snprintf(f->key, sizeof f->key, "%s", key);
  return ABBE_OK;
}

static abbe_result add_coefficients(const abbe_table_edit *alone, const char *name, field_list *out,
                                    abbe_error *error) {
  for (int i = 0; i < ABBE_DISPERSION_MAX_COEFFICIENTS; i++) {
    char key[32], *text = NULL;
    snprintf(key, sizeof key, "coefficients.%d", i);
    abbe_result result = abbe_table_edit_get(alone, name, key, &text, error);
    bool there = text != NULL;
    free(text);
    if (result != ABBE_OK || !there) return result;
    result = add_field(alone, name, key, true, true, out, error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

static abbe_result read_fields(const abbe_table_edit *alone, const char *name, field_list *out,
                               abbe_error *error) {
  static const struct {
    const char *key;
    bool number, required;
  } rows[] = {{"name", false, true},
              {"description", false, false},
              {"model", false, true},
              {"coefficients", false, false},
              {"interpolation", false, false},
              {"range_nm", false, false},
              {"temperature_c", true, false},
              {"extrapolate", false, false},
              {"density_g_cm3", true, false},
              {"n_d", true, false},
              {"v_d", true, false},
              {"source", false, true},
              {"warning", false, false},
              {"comment", false, false}};
  *out = (field_list){0};
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof rows / sizeof rows[0] && result == ABBE_OK; i++)
    result =
        strcmp(rows[i].key, "coefficients") == 0
            ? add_coefficients(alone, name, out, error)
            : add_field(alone, name, rows[i].key, rows[i].number, rows[i].required, out, error);
  if (result != ABBE_OK) free_fields(out);
  return result;
}

static const abbe_draft_field *find_field(const field_list *list, const char *key) {
  for (size_t i = 0; i < list->count; i++)
    if (strcmp(list->field[i].key, key) == 0) return &list->field[i];
  return NULL;
}

static void mark_changes(abbe_record_draft *d) {
  for (size_t i = 0; i < d->fields.count; i++) {
    abbe_draft_field *f = &d->fields.field[i];
    const abbe_draft_field *saved = find_field(&d->saved, f->key);
    f->changed = saved == NULL || strcmp(saved->text, f->text) != 0;
  }
}

/* ---- the record alone ---- */

static abbe_result make_alone(const char *record, abbe_table_edit **out, abbe_error *error) {
  static const char none[] = "materials:\n";
  abbe_result result = abbe_table_edit_parse(none, strlen(none), "the record", out, error);
  if (result == ABBE_OK) result = abbe_table_edit_add(*out, record, error);
  return result;
}

/* Fields and material from the text of `alone` as it now is. */
static abbe_result refresh(abbe_record_draft *d, const char *name, abbe_error *error) {
  field_list fields;
  abbe_result result = read_fields(d->alone, name, &fields, error);
  if (result != ABBE_OK) return result;
  free_fields(&d->fields);
  d->fields = fields;
  mark_changes(d);
  size_t size = 0;
  const char *text = abbe_table_edit_text(d->alone, &size);
  abbe_material_table_free(&d->table);
  d->trouble = (abbe_error){0};
  result = abbe_material_table_parse(text, size, "the record", &d->table, &d->trouble);
  if (result != ABBE_NO_MEMORY) return ABBE_OK; /* other trouble is the user's, to be shown */
  if (error != NULL) *error = d->trouble;
  return result;
}

/* Puts a text in the place of `alone`; on failure all is as it was. */
static abbe_result show_text(abbe_record_draft *d, const char *text, const char *name,
                             abbe_error *error) {
  abbe_table_edit *fresh = NULL, *before = d->alone;
  abbe_result result = abbe_table_edit_parse(text, strlen(text), "the record", &fresh, error);
  if (result != ABBE_OK) return result;
  d->alone = fresh;
  result = refresh(d, name, error);
  if (result != ABBE_OK) d->alone = before;
  abbe_table_edit_free(result == ABBE_OK ? before : fresh);
  return result;
}

/* The name of the only record of a text. */
static char *only_name(const char *text) {
  abbe_table_edit *edit = NULL;
  char *name = NULL;
  if (abbe_table_edit_parse(text, strlen(text), "", &edit, NULL) == ABBE_OK)
    name = abbe_table_edit_first_name(edit);
  abbe_table_edit_free(edit);
  return name;
}

/* Remembers the text as the state after the present one; what was undone is forgotten. */
static abbe_result push_state(abbe_record_draft *d, abbe_error *error) {
  size_t size = 0;
  char *copy = strdup(abbe_table_edit_text(d->alone, &size));
  if (copy == NULL) return no_memory(error);
  while (d->state_count > d->now + 1) free(d->state[--d->state_count]);
  if (d->state_count == MAX_STATES) {
    free(d->state[0]);
    memmove(d->state, d->state + 1, (MAX_STATES - 1) * sizeof *d->state);
    d->state_count--;
  }
  d->state[d->state_count++] = copy;
  d->now = d->state_count - 1;
  return ABBE_OK;
}

static bool go_to(abbe_record_draft *d, size_t state) {
  char *name = only_name(d->state[state]);
  bool good = name != NULL && show_text(d, d->state[state], name, NULL) == ABBE_OK;
  free(name);
  if (good) d->now = state;
  return good;
}

bool abbe_record_draft_undo(abbe_record_draft *d) {
  return d->now > 0 && go_to(d, d->now - 1);
}

bool abbe_record_draft_redo(abbe_record_draft *d) {
  return d->now + 1 < d->state_count && go_to(d, d->now + 1);
}

/* ---- changes ---- */

static abbe_result read_range(const char *text, double range[2], abbe_error *error) {
  const char *end = text;
  char joined[64];
  snprintf(joined, sizeof joined, "%s", text);
  for (char *c = joined; *c != '\0'; c++)
    if (strchr("[],:", *c) != NULL) *c = ' ';
  bool good = abbe_number_read(joined, &end, &range[0]) && abbe_number_read(end, &end, &range[1]);
  while (good && *end == ' ') end++;
  if (good && *end == '\0' && strlen(text) < sizeof joined) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "'%.40s' is no range such as 380 780", text);
}

static abbe_result check_number(const char *key, const char *text, abbe_error *error) {
  const char *end = text;
  double value = 0;
  if (abbe_number_read(text, &end, &value) && *end == '\0' && isfinite(value) && *text != ' ')
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "'%s' wants a number, not '%.40s'", key,
                        text);
}

/* Whose value is one of YAML's own words or the format's: quotes would make it a text. */
static bool is_word(const char *key) {
  return strcmp(key, "model") == 0 || strcmp(key, "interpolation") == 0 ||
         strcmp(key, "extrapolate") == 0;
}

/* Carries one field into an edit, of the record alone or of the file. */
static abbe_result put_field(abbe_table_edit *edit, const char *name, const abbe_draft_field *f,
                             const char *text, abbe_error *error) {
  double range[2];
  char *old = NULL;
  if (*text == '\0') {
    if (f->required)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "'%s' cannot be empty", f->key);
    abbe_result result = abbe_table_edit_get(edit, name, f->key, &old, error);
    bool there = old != NULL;
    free(old);
    return result == ABBE_OK && there ? abbe_table_edit_unset(edit, name, f->key, error) : result;
  }
  if (strcmp(f->key, "name") == 0) return abbe_table_edit_rename(edit, name, text, error);
  if (strcmp(f->key, "range_nm") == 0) {
    abbe_result result = read_range(text, range, error);
    if (result != ABBE_OK) return result;
    return abbe_table_edit_set_numbers(edit, name, f->key, range, 2, error);
  }
  if (is_word(f->key)) return abbe_table_edit_set(edit, name, f->key, text, error);
  if (!f->number) return abbe_table_edit_set_text(edit, name, f->key, text, error);
  abbe_result result = check_number(f->key, text, error);
  return result == ABBE_OK ? abbe_table_edit_set(edit, name, f->key, text, error) : result;
}

abbe_result abbe_record_draft_set(abbe_record_draft *d, size_t index, const char *text,
                                  abbe_error *error) {
  if (index >= d->fields.count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no field number %zu", index);
  abbe_draft_field *f = &d->fields.field[index];
  if (strcmp(f->text, text) == 0) return ABBE_OK;
  char *name = strdup(index == 0 ? text : name_of(d));
  if (name == NULL) return no_memory(error);
  abbe_result result = ABBE_OK;
  if (index == 0) result = abbe_material_check_name(text, error);
  if (result == ABBE_OK) result = put_field(d->alone, name_of(d), f, text, error);
  if (result == ABBE_OK) result = refresh(d, name, error);
  if (result == ABBE_OK) result = push_state(d, error);
  free(name);
  return result;
}

static size_t coefficients_of(const field_list *list, double *value) {
  size_t count = 0;
  for (size_t i = 0; i < list->count; i++) {
    const char *end;
    if (strncmp(list->field[i].key, "coefficients.", 13) != 0) continue;
    if (!abbe_number_read(list->field[i].text, &end, &value[count])) value[count] = 0;
    count++;
  }
  return count;
}

/* A list of numbers keeps the bytes of those that stay, as typing them one by one would. */
static abbe_result put_value(abbe_table_edit *edit, const char *name, const char *key,
                             const char *value, abbe_error *error) {
  double number[ABBE_DISPERSION_MAX_COEFFICIENTS];
  size_t count = 0;
  const char *at = value + 1;
  bool list = value[0] == '[';
  for (; list && count < ABBE_DISPERSION_MAX_COEFFICIENTS; at += *at == ',') {
    list = abbe_number_read(at, &at, &number[count++]);
    if (*at != ',') break;
  }
  if (list && strcmp(at, "]") == 0)
    return abbe_table_edit_set_numbers(edit, name, key, number, count, error);
  return abbe_table_edit_set(edit, name, key, value, error);
}

abbe_result abbe_record_draft_put(abbe_record_draft *d, const char *key, const char *value,
                                  abbe_error *error) {
  if (find_field(&d->fields, key) == NULL && strcmp(key, "coefficients") != 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "'%.60s' is not edited here; 'set' and 'check --fix' do it", key);
  char *name = strdup(name_of(d));
  if (name == NULL) return no_memory(error);
  abbe_result result = put_value(d->alone, name, key, value, error);
  if (result == ABBE_OK) result = refresh(d, name, error);
  if (result == ABBE_OK) result = push_state(d, error);
  free(name);
  return result;
}

abbe_result abbe_record_draft_resize(abbe_record_draft *d, bool more, abbe_error *error) {
  double value[ABBE_DISPERSION_MAX_COEFFICIENTS + 1] = {0};
  size_t count = coefficients_of(&d->fields, value);
  if (count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "this record has no coefficients; its points are edited in the file");
  if (more ? count == ABBE_DISPERSION_MAX_COEFFICIENTS : count == 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a record has 1 to %d coefficients",
                          ABBE_DISPERSION_MAX_COEFFICIENTS);
  if (more) value[count] = 0;
  count = more ? count + 1 : count - 1;
  char *name = strdup(name_of(d));
  if (name == NULL) return no_memory(error);
  abbe_result result =
      abbe_table_edit_set_numbers(d->alone, name, "coefficients", value, count, error);
  if (result == ABBE_OK) result = refresh(d, name, error);
  if (result == ABBE_OK) result = push_state(d, error);
  free(name);
  return result;
}

abbe_result abbe_record_draft_try(const abbe_record_draft *d, size_t index, const char *text,
                                  abbe_material *out, abbe_error *error) {
  *out = (abbe_material){0};
  abbe_table_edit *copy = NULL;
  abbe_material_table table = {0};
  size_t size = 0;
  const char *now = abbe_table_edit_text(d->alone, &size);
  abbe_result result = abbe_table_edit_parse(now, size, "the record", &copy, error);
  if (result == ABBE_OK && index < d->fields.count)
    result = put_field(copy, name_of(d), &d->fields.field[index], text, error);
  if (result == ABBE_OK) {
    now = abbe_table_edit_text(copy, &size);
    result = abbe_material_table_parse(now, size, "the record", &table, error);
  }
  if (result == ABBE_OK) { /* taken out of its table */
    *out = table.material[0];
    table.material[0] = (abbe_material){0};
  }
  abbe_material_table_free(&table);
  abbe_table_edit_free(copy);
  return result;
}

/* ---- opening and saving ---- */

abbe_result abbe_record_draft_open(const char *path, const char *name, abbe_record_draft **out,
                                   abbe_error *error) {
  *out = NULL;
  abbe_record_draft *d = calloc(1, sizeof *d);
  if (d == NULL) return no_memory(error);
  char *record = NULL;
  abbe_result result = abbe_table_edit_open(path, &d->file, error);
  if (result == ABBE_OK) result = abbe_table_edit_record(d->file, name, &record, error);
  if (result == ABBE_OK) result = make_alone(record, &d->alone, error);
  if (result == ABBE_OK) {
    d->file_name = abbe_table_edit_first_name(d->alone); /* in the file's own letters */
    if (d->file_name == NULL) result = no_memory(error);
  }
  if (result == ABBE_OK) result = read_fields(d->alone, name, &d->saved, error);
  if (result == ABBE_OK) result = refresh(d, d->file_name, error);
  if (result == ABBE_OK) result = push_state(d, error);
  free(record);
  if (result != ABBE_OK) {
    abbe_record_draft_free(d);
    return result;
  }
  size_t size = 0;
  const char *text = abbe_table_edit_text(d->alone, &size);
  abbe_material_table_parse(text, size, "the record", &d->original, NULL);
  *out = d;
  return ABBE_OK;
}

void abbe_record_draft_free(abbe_record_draft *d) {
  if (d == NULL) return;
  abbe_table_edit_free(d->file);
  abbe_table_edit_free(d->alone);
  free_fields(&d->fields);
  free_fields(&d->saved);
  for (size_t i = 0; i < d->state_count; i++) free(d->state[i]);
  abbe_material_table_free(&d->table);
  abbe_material_table_free(&d->original);
  free(d->file_name);
  free(d);
}

/* All fields that differ, into the file's text; coefficients as a whole where their number does. */
static abbe_result carry(abbe_record_draft *d, abbe_error *error) {
  double now[ABBE_DISPERSION_MAX_COEFFICIENTS], before[ABBE_DISPERSION_MAX_COEFFICIENTS];
  size_t count = coefficients_of(&d->fields, now);
  bool resized = count != coefficients_of(&d->saved, before);
  abbe_result result = ABBE_OK;
  if (resized)
    result = abbe_table_edit_set_numbers(d->file, d->file_name, "coefficients", now, count, error);
  for (size_t i = 1; i < d->fields.count && result == ABBE_OK; i++) {
    const abbe_draft_field *f = &d->fields.field[i];
    bool coefficient = strncmp(f->key, "coefficients.", 13) == 0;
    if (f->changed && !(coefficient && resized))
      result = put_field(d->file, d->file_name, f, f->text, error);
  }
  if (result == ABBE_OK && d->fields.field[0].changed)
    result = abbe_table_edit_rename(d->file, d->file_name, name_of(d), error);
  return result;
}

abbe_result abbe_record_draft_save(abbe_record_draft *d, abbe_error *error) {
  if (d->table.count == 0)
    return abbe_error_set(error, ABBE_SCHEMA, "not saved: %s", abbe_record_draft_trouble(d));
  char *name = strdup(name_of(d));
  field_list saved;
  if (name == NULL) return no_memory(error);
  abbe_result result = read_fields(d->alone, name, &saved, error);
  if (result != ABBE_OK) {
    free(name);
    return result;
  }
  result = carry(d, error);
  if (result == ABBE_OK) result = abbe_table_edit_save(d->file, error);
  if (result != ABBE_OK) {
    abbe_table_edit_revert(d->file, NULL);
    free_fields(&saved);
    free(name);
    return result;
  }
  free_fields(&d->saved);
  free(d->file_name);
  d->saved = saved;
  d->file_name = name;
  mark_changes(d);
  return ABBE_OK;
}

/* ---- what there is to see ---- */

size_t abbe_record_draft_count(const abbe_record_draft *d) {
  return d->fields.count;
}

const abbe_draft_field *abbe_record_draft_field(const abbe_record_draft *d, size_t index) {
  return &d->fields.field[index];
}

const abbe_material *abbe_record_draft_material(const abbe_record_draft *d) {
  return d->table.count > 0 ? &d->table.material[0] : NULL;
}

/* Lines are the record's own and mean nothing to its editor. */
const char *abbe_record_draft_trouble(const abbe_record_draft *d) {
  static const char lead[] = "the record:";
  const char *text = d->trouble.text;
  if (strncmp(text, lead, strlen(lead)) != 0) return text;
  text += strlen(lead);
  text += strspn(text, "0123456789");
  return *text == ':' ? text + 2 : d->trouble.text;
}

const abbe_material *abbe_record_draft_original(const abbe_record_draft *d) {
  return d->original.count > 0 ? &d->original.material[0] : NULL;
}

bool abbe_record_draft_is_changed(const abbe_record_draft *d) {
  if (d->fields.count != d->saved.count) return true;
  for (size_t i = 0; i < d->fields.count; i++)
    if (d->fields.field[i].changed) return true;
  return false;
}
