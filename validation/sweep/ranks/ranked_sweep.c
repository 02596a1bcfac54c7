#include "validation/sweep/ranks/ranked_sweep.h"

#include "validation/ranks/rank_files.h"

#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Adds the rows that are not there yet: a rank's table begins with what was known before. */
static abbe_result add_new(const abbe_sweep_table *from, abbe_sweep_table *to, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < from->count && result == ABBE_OK; i++)
    if (abbe_sweep_table_find(to, &from->row[i].setting) == NULL)
      result = abbe_sweep_table_add(to, &from->row[i], error);
  return result;
}

/* An empty table takes the other's facts; with facts they must agree. */
static abbe_result take(const char *path, abbe_sweep_table *to, abbe_error *error) {
  abbe_sweep_table from = {0};
  abbe_result result = abbe_sweep_table_load(path, &from, error);
  if (result == ABBE_OK && to->fact[ABBE_SWEEP_FACT_PROGRAM][0] == '\0')
    memcpy(to->fact, from.fact, sizeof to->fact);
  if (result == ABBE_OK) result = abbe_sweep_table_agree(&from, path, to, error);
  if (result == ABBE_OK) result = add_new(&from, to, error);
  abbe_sweep_table_free(&from);
  return result;
}

/* The whole table's rows, where there is one, into `whole`; those of ranks' tables into `parts`,
 * which are under its facts. */
static abbe_result take_all(const char *path, abbe_sweep_table *whole, abbe_sweep_table *parts,
                            abbe_error *error) {
  size_t *rank = NULL, count = 0;
  abbe_result result = access(path, F_OK) == 0 ? take(path, whole, error) : ABBE_OK;
  memcpy(parts->fact, whole->fact, sizeof parts->fact);
  if (result == ABBE_OK) result = abbe_rank_files_find(path, &rank, &count, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    char *name = NULL;
    result = abbe_rank_files_name(path, rank[i], &name, error);
    if (result == ABBE_OK) result = take(name, parts, error);
    free(name);
  }
  free(rank);
  return result;
}

/* All rows that are known, in the order in which one process has them: those of the whole table,
 * then the settings requested, then what ranks were asked before. */
static abbe_result put_together(const abbe_sweep_request *q, abbe_sweep_table *out,
                                abbe_error *error) {
  abbe_sweep_table parts = {0};
  *out = (abbe_sweep_table){0};
  abbe_result result = take_all(q->table, out, &parts, error);
  memcpy(out->fact, parts.fact, sizeof out->fact);
  for (size_t i = 0; i < q->setting_count && result == ABBE_OK; i++) {
    const abbe_sweep_row *row = abbe_sweep_table_find(&parts, &q->setting[i]);
    if (row != NULL && abbe_sweep_table_find(out, &q->setting[i]) == NULL)
      result = abbe_sweep_table_add(out, row, error);
  }
  if (result == ABBE_OK) result = add_new(&parts, out, error);
  abbe_sweep_table_free(&parts);
  if (result != ABBE_OK) abbe_sweep_table_free(out);
  return result;
}

/* This rank's settings: every count-th of those that no table has. */
static abbe_result choose(const abbe_ranks *r, const abbe_sweep_request *q,
                          const abbe_sweep_table *known, abbe_sweep_setting **out, size_t *count,
                          abbe_error *error) {
  size_t missing = 0;
  *count = 0;
  *out = calloc(q->setting_count + 1, sizeof **out);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the settings");
  for (size_t i = 0; i < q->setting_count; i++)
    if (abbe_sweep_table_find(known, &q->setting[i]) == NULL && missing++ % r->count == r->rank)
      (*out)[(*count)++] = q->setting[i];
  return ABBE_OK;
}

/* Rank 0 looks at the tables that are there, whose rows may be of something else, even where it has
 * nothing to measure. */
static abbe_result measure(const abbe_ranks *r, abbe_context *context, const abbe_scene *scene,
                           const abbe_sweep_request *q, const abbe_sweep_table *known,
                           abbe_error *error) {
  abbe_sweep_request own = *q;
  abbe_sweep_setting *setting = NULL;
  abbe_sweep_table table = {0};
  char *name = NULL;
  own.references = q->references != NULL ? q->references : q->table;
  abbe_result result = abbe_rank_files_name(q->table, r->rank, &name, error);
  if (result == ABBE_OK) result = choose(r, q, known, &setting, &own.setting_count, error);
  own.table = name;
  own.setting = setting;
  if (result == ABBE_OK && (own.setting_count > 0 || r->rank == 0)) {
    const bool fresh = access(name, F_OK) != 0;
    if (known->count > 0) result = abbe_sweep_table_save(known, name, error);
    if (result == ABBE_OK) result = abbe_sweep_run(context, scene, &own, &table, error);
    if (result == ABBE_INVALID_ARGUMENT && fresh) unlink(name);
  }
  abbe_sweep_table_free(&table);
  free(setting);
  free(name);
  return result;
}

/* By rank 0, for all; the others find them. */
static abbe_result trace_references(abbe_context *context, const abbe_scene *scene,
                                    const abbe_sweep_request *q, abbe_error *error) {
  abbe_sweep_request own = *q;
  abbe_sweep_table none = {0};
  if (q->reference != NULL || q->reference_map != NULL) return ABBE_OK;
  own.trace_only = true;
  const abbe_result result = abbe_sweep_run(context, scene, &own, &none, error);
  abbe_sweep_table_free(&none);
  return result;
}

abbe_result abbe_ranked_sweep(const abbe_ranks *ranks, abbe_context *context,
                              const abbe_scene *scene, const abbe_sweep_request *request,
                              abbe_sweep_table *out, abbe_error *error) {
  assert(ranks->most && request->table);
  const bool first = ranks->rank == 0;
  abbe_sweep_table known;
  *out = (abbe_sweep_table){0};
  abbe_result result = put_together(request, &known, error);
  if (result == ABBE_OK && first) result = trace_references(context, scene, request, error);
  result = abbe_ranks_agree(ranks, result, error);
  if (result == ABBE_OK) {
    result = measure(ranks, context, scene, request, &known, error);
    result = abbe_ranks_agree(ranks, result, error);
  }
  abbe_sweep_table_free(&known);
  if (result != ABBE_OK) return result;
  if (first) {
    result = put_together(request, out, error);
    if (result == ABBE_OK)
      result = abbe_sweep_table_mark(out, request->time, request->error, NULL, error);
    if (result == ABBE_OK) result = abbe_sweep_table_save(out, request->table, error);
    if (result == ABBE_OK) abbe_rank_files_remove(request->table);
  }
  result = abbe_ranks_agree(ranks, result, error);
  if (result != ABBE_OK) abbe_sweep_table_free(out);
  return result;
}
