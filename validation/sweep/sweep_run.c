#include "validation/sweep/sweep_run.h"

#include "gl/accuracy/preset.h"
#include "library/choice/sweep_setting.h"
#include "validation/sweep/sweep_grid.h"
#include "validation/sweep/sweep_hash.h"
#include "validation/sweep/sweep_measure.h"
#include "validation/sweep/sweep_process.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* All that is loaded or made on the way. */
typedef struct work {
  const abbe_sweep_request *q;
  const abbe_scene *scene;
  abbe_sweep_reference full, matched; /* matched: where the error is decomposed */
  abbe_sweep_model model;
  abbe_sweep sweep;
  abbe_sweep_table table;
  const char *what;   /* in progress */
  double done, share; /* share of it: before this row, and the row's */
} work;

static bool go_on(void *user, double done) {
  const work *w = user;
  return w->q->progress == NULL || w->q->progress(w->q->user, w->what, w->done + w->share * done);
}

/* ---- the references ---- */

static abbe_result find(work *w, bool matched, abbe_sweep_reference *out, abbe_error *error) {
  abbe_sweep_reference_desc desc = w->q->traced;
  desc.matched = matched;
  /* Noise of its own: what the two have in common must not cancel. */
  desc.seed = matched && w->q->decompose ? 1 : 0;
  desc.progress = go_on;
  desc.user = w;
  desc.stop = w->q->stop;
  w->what = matched ? "matched" : "reference";
  w->share = 1;
  const char *beside = w->q->references != NULL ? w->q->references : w->q->table;
  abbe_result result = abbe_sweep_reference_name(beside, out == &w->matched, out, error);
  if (result == ABBE_OK)
    result = abbe_sweep_reference_find(w->sweep.context, w->scene, &desc, out, error);
  if (result != ABBE_CANCELLED) return result;
  return abbe_error_set(error, result,
                        "stopped while the reference was traced; what is done is kept, and the "
                        "same command goes on");
}

static abbe_result get_references(work *w, abbe_error *error) {
  const abbe_sweep_request *q = w->q;
  abbe_result result = q->reference != NULL || q->reference_map != NULL
                           ? abbe_sweep_reference_load(w->scene, q->reference, q->reference_map,
                                                       &w->full, &w->sweep.light, error)
                           : find(w, q->traced.matched, &w->full, error);
  if (result == ABBE_OK && q->decompose) result = find(w, true, &w->matched, error);
  if (result != ABBE_OK) return result;
  if (w->full.picture.data != NULL) w->sweep.picture = &w->full.picture;
  if (w->full.map.data != NULL) w->sweep.map = &w->full.map;
  if (!q->decompose) return ABBE_OK;
  w->sweep.matched_picture = &w->matched.picture;
  w->sweep.matched_map = &w->matched.map;
  return abbe_sweep_model_measure(&w->sweep, &w->model, error);
}

/* ---- what the table belongs to ---- */

static void describe_machine(char *out, size_t size) {
  char line[256], name[200] = "unknown processor";
  FILE *file = fopen("/proc/cpuinfo", "r");
  while (file != NULL && fgets(line, sizeof line, file) != NULL)
    if (strncmp(line, "model name", 10) == 0 && sscanf(line, "%*[^:]: %199[^\n]", name) == 1) break;
  if (file != NULL) fclose(file);
  snprintf(out, size, "%s, %ld threads", name, sysconf(_SC_NPROCESSORS_ONLN));
}

static const char *class_of(const abbe_scene *scene) {
  abbe_plan plan;
  if (abbe_plan_make(scene, NULL, &plan, NULL) != ABBE_OK) return "";
  abbe_preset_class of = abbe_preset_class_of(&plan);
  abbe_plan_free(&plan);
  return abbe_preset_class_name(of);
}

static void state_facts(const work *w, abbe_sweep_table *t) {
  char text[256];
  struct tm day;
  time_t now = time(NULL);
  const abbe_image *picture = w->sweep.picture;
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_PROGRAM, w->q->program);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_SCENE, w->q->scene_path);
  snprintf(text, sizeof text, "%016llx", abbe_sweep_hash_scene(w->scene));
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_SCENE_HASH, text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_CLASS, class_of(w->scene));
  snprintf(text, sizeof text, "%zux%zu", picture != NULL ? picture->width : w->scene->camera.width,
           picture != NULL ? picture->height : w->scene->camera.height);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_SIZE, text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_REFERENCE, w->full.picture_path);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_REFERENCE_MAP, w->full.map_path);
  snprintf(text, sizeof text, "%016llx", abbe_sweep_hash_images(picture, w->sweep.map));
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_REFERENCE_HASH, text);
  if (w->q->decompose) abbe_sweep_model_write(&w->model, t);
  snprintf(text, sizeof text, "%zu", w->sweep.frames);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_FRAMES, text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_DEVICE, abbe_context_description(w->sweep.context));
  describe_machine(text, sizeof text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_MACHINE, text);
  if (gmtime_r(&now, &day) != NULL && strftime(text, sizeof text, "%Y-%m-%d", &day) > 0)
    abbe_sweep_table_set(t, ABBE_SWEEP_FACT_DATE, text);
}

/* Takes up the rows of an earlier run, if they belong to this one. */
static abbe_result open_table(work *w, abbe_error *error) {
  abbe_sweep_table now = {0};
  state_facts(w, &now);
  if (access(w->q->table, F_OK) != 0) {
    w->table = now;
    return ABBE_OK;
  }
  abbe_result result = abbe_sweep_table_load(w->q->table, &w->table, error);
  if (result == ABBE_OK) result = abbe_sweep_table_agree(&w->table, w->q->table, &now, error);
  return result;
}

/* ---- the rows ---- */

static abbe_result keep_table(work *w, abbe_error *error) {
  abbe_result result = abbe_sweep_table_mark(&w->table, w->q->time, w->q->error, NULL, error);
  return result == ABBE_OK ? abbe_sweep_table_save(&w->table, w->q->table, error) : result;
}

static abbe_result measure(work *w, const abbe_sweep_setting *setting, abbe_error *error) {
  abbe_sweep_row row;
  char text[200];
  abbe_error why = {0};
  abbe_result result = abbe_sweep_measure(&w->sweep, setting, go_on, w, &row, NULL, &why);
  abbe_sweep_setting_describe(setting, text, sizeof text);
  if (result != ABBE_OK) return abbe_error_set(error, result, "%s: %.700s", text, why.text);
  result = abbe_sweep_table_add(&w->table, &row, error);
  return result == ABBE_OK ? keep_table(w, error) : result;
}

static abbe_result measure_all(work *w, abbe_error *error) {
  const abbe_sweep_request *q = w->q;
  size_t missing = 0, done = 0;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < q->setting_count; i++)
    missing += abbe_sweep_table_find(&w->table, &q->setting[i]) == NULL;
  w->what = "sweep";
  w->share = 1 / (double)(missing > 0 ? missing : 1);
  for (size_t i = 0; i < q->setting_count && result == ABBE_OK; i++) {
    if (abbe_sweep_table_find(&w->table, &q->setting[i]) != NULL) continue;
    w->done = (double)done++ * w->share;
    result = measure(w, &q->setting[i], error);
  }
  if (result == ABBE_CANCELLED)
    return abbe_error_set(error, result,
                          "stopped; %zu of %zu settings are in %s, and the same command goes on",
                          w->table.count, q->setting_count, q->table);
  /* The front is of the error that is requested now. */
  return result == ABBE_OK ? keep_table(w, error) : result;
}

/* ---- whole processes ---- */

/* Lists the rows of each contestant's own front of that error. */
static abbe_result list_fronts(work *w, abbe_sweep_number number, bool *listed, abbe_error *error) {
  abbe_sweep_table *t = &w->table;
  abbe_result result = ABBE_OK;
  for (int k = 0; k < ABBE_SWEEP_PROFILE_COUNT && result == ABBE_OK; k++) {
    result = abbe_sweep_table_mark(t, ABBE_SWEEP_FRAME_MS, number, abbe_sweep_profiles[k], error);
    for (size_t i = 0; i < t->count; i++) listed[i] |= t->row[i].front;
  }
  return result;
}

/* Cold ones take long and differ little, so they are run for the fronts alone. */
static bool is_timed(const abbe_sweep_row *row, bool cold) {
  if (abbe_sweep_setting_has_history(&row->setting)) return true; /* a process draws one frame */
  return isfinite(row->number[ABBE_SWEEP_WARM_MS]) &&
         (!cold || isfinite(row->number[ABBE_SWEEP_COLD_MS]));
}

static abbe_result time_rows(work *w, abbe_sweep_process *process, const bool *cold,
                             abbe_error *error) {
  size_t missing = 0, done = 0;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < w->table.count; i++) missing += !is_timed(&w->table.row[i], cold[i]);
  w->what = "processes";
  w->share = 1 / (double)(missing > 0 ? missing : 1);
  for (size_t i = 0; i < w->table.count && result == ABBE_OK; i++) {
    abbe_sweep_row *row = &w->table.row[i];
    if (is_timed(row, cold[i])) continue;
    w->done = (double)done++ * w->share;
    if (!go_on(w, 0)) return abbe_error_set(error, ABBE_CANCELLED, "stopped");
    result = abbe_sweep_process_measure(process, cold[i], row, error);
    if (result == ABBE_OK) result = keep_table(w, error);
  }
  return result;
}

static abbe_result time_processes(work *w, const bool *cold, abbe_error *error) {
  const abbe_image *picture = w->sweep.picture;
  abbe_sweep_process *process = NULL;
  const abbe_sweep_process_desc desc = {.program = w->q->run,
                                        .scene = w->q->scene_path,
                                        .materials = w->q->materials,
                                        .backend = w->q->backend,
                                        .width = picture != NULL ? picture->width : 0,
                                        .height = picture != NULL ? picture->height : 0};
  abbe_result result = abbe_sweep_process_make(&desc, &process, error);
  if (result == ABBE_OK) result = time_rows(w, process, cold, error);
  abbe_sweep_process_free(process);
  if (result != ABBE_CANCELLED) return result;
  return abbe_error_set(error, result,
                        "stopped while whole processes were timed; what is done is in %s, and the "
                        "same command goes on",
                        w->q->table);
}

static abbe_result measure_processes(work *w, abbe_error *error) {
  if (w->q->run == NULL) return ABBE_OK;
  bool *cold = calloc(w->table.count + 1, sizeof *cold);
  if (cold == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the processes");
  abbe_result result = list_fronts(w, ABBE_SWEEP_CAUSTIC_DE, cold, error);
  if (result == ABBE_OK) result = list_fronts(w, ABBE_SWEEP_CAUSTIC_RMSE, cold, error);
  if (result == ABBE_OK) result = time_processes(w, cold, error);
  free(cold);
  return result == ABBE_OK ? keep_table(w, error) : result;
}

abbe_result abbe_sweep_run(abbe_context *context, const abbe_scene *scene,
                           const abbe_sweep_request *request, abbe_sweep_table *out,
                           abbe_error *error) {
  work w = {.q = request, .scene = scene};
  w.sweep = (abbe_sweep){.context = context, .scene = scene, .frames = request->frames};
  *out = (abbe_sweep_table){0};
  abbe_result result = get_references(&w, error);
  if (result == ABBE_OK && !request->trace_only) {
    result = open_table(&w, error);
    if (result == ABBE_OK) result = measure_all(&w, error);
    if (result == ABBE_OK) result = measure_processes(&w, error);
  }
  abbe_sweep_reference_free(&w.full);
  abbe_sweep_reference_free(&w.matched);
  if (result == ABBE_OK)
    *out = w.table;
  else
    abbe_sweep_table_free(&w.table);
  return result;
}

abbe_result abbe_sweep_preset_settings(const abbe_scene *scene, const char *presets,
                                       abbe_sweep_setting **out, size_t *out_count,
                                       abbe_error *error) {
  abbe_presets all = {0};
  const abbe_preset_front *front = NULL;
  abbe_plan plan;
  *out = NULL;
  *out_count = 0;
  abbe_result result = abbe_plan_make(scene, NULL, &plan, error);
  if (result != ABBE_OK) return result;
  result = abbe_presets_load(presets, &all, error);
  if (result == ABBE_OK) result = abbe_presets_find(&all, &plan, &front, error);
  abbe_plan_free(&plan);
  if (result == ABBE_OK) *out = calloc(front->count, sizeof **out);
  if (result == ABBE_OK && *out == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the presets");
  for (size_t i = 0; result == ABBE_OK && i < front->count; i++)
    abbe_sweep_setting_of(&front->point[i].desc, &(*out)[(*out_count)++]);
  abbe_presets_free(&all);
  return result;
}
