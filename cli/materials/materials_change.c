#include "cli/materials/materials.h"

#include "spectral/materials/material_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool abbe_change_option(abbe_change *change, int key, const char *arg) {
  if (key == ABBE_MATERIALS_KEY_TABLE) change->table = arg;
  if (key == ABBE_CHANGE_KEY_DRY_RUN) change->dry_run = true;
  return key == ABBE_MATERIALS_KEY_TABLE || key == ABBE_CHANGE_KEY_DRY_RUN;
}

abbe_result abbe_change_check_table(const char *table, abbe_error *error) {
  size_t size;
  if (abbe_material_table_shipped(table, &size) == NULL) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the table '%s' is compiled in and cannot be edited; 'abbe materials export "
      "--table %s --to yaml -o FILE' makes a copy of it, 'abbe materials add NAME "
      "--from %s --table FILE --create' of one record",
      table, table, table);
}

abbe_result abbe_change_open(abbe_change *change, abbe_error *error) {
  if (change->table == NULL)
    abbe_materials_wrong_use(change->program, "which table? Name its file with --table FILE");
  abbe_result result = abbe_change_check_table(change->table, error);
  if (result != ABBE_OK) return result;
  return abbe_table_edit_open(change->table, &change->edit, error);
}

static bool is_text(const char *key) {
  static const char *const keys[] = {"description", "source",         "warning",
                                     "comment",     "catalogue.code", "catalogue.status"};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    if (strcmp(key, keys[i]) == 0) return true;
  return false;
}

abbe_result abbe_change_assign(abbe_table_edit *edit, const char *name, const char *assignment,
                               abbe_error *error) {
  const char *equals = strchr(assignment, '=');
  if (equals == NULL || equals == assignment)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "'%.80s' sets nothing; write KEY=VALUE, such as temperature_c=20",
                          assignment);
  char *key = strndup(assignment, (size_t)(equals - assignment));
  if (key == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for an argument");
  abbe_result result;
  if (strcmp(key, "name") == 0)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "a name is changed by 'abbe materials set %.80s name=NEW'", name);
  else if (equals[1] == '\0')
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "'%.80s' has no value; to take the key out, say --unset %.80s",
                            assignment, key);
  else if (is_text(key))
    result = abbe_table_edit_set_text(edit, name, key, equals + 1, error);
  else
    result = abbe_table_edit_set(edit, name, key, equals + 1, error);
  free(key);
  return result;
}

/* ---- what is printed ---- */

static bool numbers_of(const char *text, size_t size, const char *name,
                       abbe_dispersion_numbers *out) {
  abbe_material_table table;
  const abbe_material *m = NULL;
  bool good = abbe_material_table_parse(text, size, "", &table, NULL) == ABBE_OK &&
              abbe_material_table_find(&table, name, &m, NULL) == ABBE_OK &&
              !abbe_material_is_conductor(m);
  if (good) *out = abbe_materials_numbers(m);
  abbe_material_table_free(&table);
  return good;
}

static void say(const abbe_change *change, const char *what, const char *name,
                const abbe_dispersion_numbers *before) {
  abbe_dispersion_numbers now;
  size_t size = 0;
  const char *text = abbe_table_edit_text(change->edit, &size);
  printf("%s: %s\n", change->table, what);
  if (name == NULL || !numbers_of(text, size, name, &now)) return;
  char t[4][32];
  const char *n_d = abbe_materials_number(t[0], sizeof t[0], "%.6f", now.n_d);
  const char *v_d = abbe_materials_number(t[1], sizeof t[1], "%.3f", now.v_d);
  bool same = before != NULL && memcmp(before, &now, sizeof now) == 0;
  if (before == NULL || same) {
    printf("  n_d %s, V_d %s%s\n", n_d, v_d, same ? ", as before" : "");
    return;
  }
  const char *old_n_d = abbe_materials_number(t[2], sizeof t[2], "%.6f", before->n_d);
  const char *old_v_d = abbe_materials_number(t[3], sizeof t[3], "%.3f", before->v_d);
  printf("  n_d %s -> %s, V_d %s -> %s\n", old_n_d, n_d, old_v_d, v_d);
}

static abbe_result show(const abbe_change *change, abbe_error *error) {
  char *diff = NULL;
  abbe_result result = abbe_table_edit_diff(change->edit, &diff, error);
  if (result == ABBE_OK) fputs(diff, stdout);
  free(diff);
  return result;
}

int abbe_change_end(abbe_change *change, abbe_result result, const char *what, const char *name,
                    abbe_error *error) {
  abbe_dispersion_numbers before;
  bool known = false;
  if (result == ABBE_OK) {
    size_t size = 0, new_size = 0;
    const char *old = abbe_table_edit_original(change->edit, &size);
    const char *new = abbe_table_edit_text(change->edit, &new_size);
    if (size == new_size && memcmp(old, new, size) == 0)
      what = "it says so already; nothing is changed";
    known = name != NULL && numbers_of(old, size, name, &before);
    result = abbe_table_edit_allow(change->edit, error);
  }
  if (result == ABBE_OK)
    result = change->dry_run ? show(change, error) : abbe_table_edit_save(change->edit, error);
  if (result == ABBE_OK && !change->dry_run) say(change, what, name, known ? &before : NULL);
  abbe_error left = {0};
  if (result == ABBE_OK && abbe_table_edit_check(change->edit, &left) != ABBE_OK)
    fprintf(stderr, "%s: the file is not yet a table that can be used: %s\n", change->program,
            left.text);
  abbe_table_edit_free(change->edit);
  return abbe_command_end(change->program, result, error);
}
