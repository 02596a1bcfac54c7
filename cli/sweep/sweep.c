#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/base/rank_job.h"
#include "cli/options/own_context.h"
#include "cli/options/scene_input.h"
#include "cli/sweep/sweep_options.h"
#include "cli/sweep/sweep_report.h"

#include "library/choice/sweep_setting.h"
#include "validation/landing/estimator_study.h"
#include "validation/sweep/ranks/ranked_sweep.h"
#include "validation/sweep/scaling_study.h"
#include "validation/sweep/studies/transport_table.h"
#include "validation/sweep/sweep_page.h"
#include "validation/tradeoff/sweep_plot.h"
#include "validation/tradeoff/sweep_presets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef ABBE_VERSION
#error "the build defines ABBE_VERSION"
#endif

/* One bar after another, for what is in progress. */
typedef struct bar {
  abbe_progress progress;
  const char *what;
  bool quiet;
} bar;

static bool update(void *user, const char *what, double done) {
  bar *b = user;
  if (b->what == NULL || strcmp(b->what, what) != 0) {
    if (b->what != NULL) abbe_progress_end(&b->progress);
    abbe_progress_begin(&b->progress, what, b->quiet);
    b->what = what;
  }
  return abbe_progress_update(&b->progress, done);
}

/* ---- a scene ---- */

static abbe_result get_settings(const abbe_sweep_options *q, const abbe_scene *scene,
                                abbe_sweep_setting **out, size_t *count, abbe_error *error) {
  const abbe_sweep_grid *part = &q->list;
  size_t parts = 1, refused;
  abbe_error why = {0};
  const char *grid = q->grid != NULL ? q->grid : "quick";
  if (strcmp(grid, "presets") == 0)
    return abbe_sweep_preset_settings(scene, q->presets, out, count, error);
  for (size_t i = 0; !q->listed && i < q->grids->count; i++) {
    if (strcmp(q->grids->grid[i].name, grid) != 0) continue;
    part = q->grids->grid[i].part;
    parts = q->grids->grid[i].count;
  }
  abbe_result result =
      abbe_sweep_grid_expand(scene, part, parts, out, count, &refused, &why, error);
  if (result == ABBE_OK && refused > 0 && !q->quiet)
    fprintf(stderr, "note: %zu settings of the grid are left out; the first: %s\n", refused,
            why.text);
  return result;
}

/* The settings of the part, from the front on. */
static abbe_result keep_part(const abbe_command_part *part, abbe_sweep_setting *setting,
                             size_t *count, abbe_error *error) {
  size_t kept = 0;
  for (size_t i = 0; i < *count; i++)
    if (abbe_command_part_has(part, i)) setting[kept++] = setting[i];
  if (kept == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "--part %zu/%zu has none of %zu settings",
                          part->part, part->parts, *count);
  *count = kept;
  return ABBE_OK;
}

/* Files that are written beside the table may be none that is read or written for something else.
 */
static abbe_result claim_references(const abbe_sweep_options *q, abbe_error *error) {
  const abbe_sweep_request *w = &q->work;
  for (int i = w->reference != NULL || w->reference_map != NULL; i < (w->decompose ? 2 : 1); i++) {
    abbe_sweep_reference r = {0};
    abbe_result result = abbe_sweep_reference_name(w->table, i == 1, &r, error);
    if (result != ABBE_OK) return result;
    const char *const kept[] = {r.picture_path, r.map_path, r.checkpoint_path};
    for (int k = 0; k < 3; k++)
      abbe_arguments_add(q->program, ABBE_ARGUMENT_WRITES, "the traced file", kept[k]);
  }
  return ABBE_OK;
}

static void print_settings(const abbe_sweep_setting *setting, size_t count) {
  char text[200];
  for (size_t i = 0; i < count; i++) {
    abbe_sweep_setting_describe(&setting[i], text, sizeof text);
    printf("%s\n", text);
  }
}

/* Ranks that could not begin (`before`) end all of them. */
static abbe_result measure(const abbe_sweep_options *q, const abbe_scene *scene,
                           const abbe_sweep_setting *setting, size_t count, abbe_result before,
                           abbe_sweep_table *out, abbe_error *error) {
  bar b = {.quiet = q->quiet};
  abbe_context *context = NULL;
  abbe_sweep_request work = q->work;
  work.program = "abbe " ABBE_VERSION;
  work.scene_path = q->scene;
  work.setting = setting;
  work.setting_count = count;
  work.materials = q->materials;
  work.backend = abbe_context_backend_name(q->backend);
  char own[4096] = "";
  if (q->processes && readlink("/proc/self/exe", own, sizeof own - 1) > 0) work.run = own;
  work.progress = update;
  work.user = &b;
  work.stop = abbe_progress_stopped();
  abbe_result result = before == ABBE_OK ? claim_references(q, error) : before;
  if (result == ABBE_OK) result = abbe_own_context_make(q->backend, q->quiet, &context, error);
  result = abbe_rank_job_agree(q->job, result, error);
  if (result == ABBE_OK)
    result = q->job != NULL ? abbe_ranked_sweep(&q->job->ranks, context, scene, &work, out, error)
                            : abbe_sweep_run(context, scene, &work, out, error);
  if (b.what != NULL) abbe_progress_end(&b.progress);
  abbe_context_free(context);
  return result;
}

static abbe_result sweep_scene(const abbe_sweep_options *q, abbe_sweep_table *out,
                               abbe_error *error) {
  abbe_scene scene = {0};
  abbe_sweep_setting *setting = NULL;
  size_t count = 0;
  abbe_result result = abbe_scene_input_load(q->program, q->scene, q->materials, &scene, error);
  if (result == ABBE_OK) result = get_settings(q, &scene, &setting, &count, error);
  if (result == ABBE_OK) result = keep_part(&q->part, setting, &count, error);
  if (result == ABBE_OK && q->list_only)
    print_settings(setting, count);
  else if (result == ABBE_OK || q->job != NULL)
    result = measure(q, &scene, setting, count, result, out, error);
  free(setting);
  abbe_scene_free(&scene);
  return result;
}

static abbe_result study_scaling(const abbe_sweep_options *q, abbe_error *error) {
  abbe_scene scene = {0};
  abbe_context *context = NULL;
  abbe_scaling_study study;
  abbe_progress progress;
  abbe_result result = abbe_scene_input_load(q->program, q->scene, q->materials, &scene, error);
  if (result == ABBE_OK) result = abbe_own_context_make(q->backend, q->quiet, &context, error);
  if (result == ABBE_OK) {
    const size_t width = q->work.traced.width;
    const abbe_sweep sweep = {.context = context, .scene = &scene, .frames = q->work.frames};
    abbe_progress_begin(&progress, "scaling", q->quiet);
    result = abbe_scaling_study_measure(&sweep, &scene, width > 0 ? width : 256,
                                        abbe_progress_update, &progress, &study, error);
    abbe_progress_end(&progress);
  }
  if (result == ABBE_OK) result = abbe_scaling_study_save(&study, q->work.table, error);
  if (result == ABBE_OK && q->plot != NULL)
    result = abbe_scaling_study_plot(&study, q->plot, error);
  if (result == ABBE_OK) abbe_scaling_study_print(&study, stdout);
  abbe_context_free(context);
  abbe_scene_free(&scene);
  return result;
}

static abbe_result study_estimators(const abbe_sweep_options *q, abbe_error *error) {
  const size_t side = q->list.map.count > 0 ? q->list.map.value[0] : 768;
  const size_t grid = q->list.photons.count > 0 ? q->list.photons.value[0] : 128;
  abbe_scene scene = {0};
  abbe_estimator_study *study = calloc(1, sizeof *study);
  if (study == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the study");
  abbe_result result = abbe_scene_input_load(q->program, q->scene, q->materials, &scene, error);
  if (result == ABBE_OK) result = abbe_estimator_study_make(&scene, side, grid, study, error);
  if (result == ABBE_OK && q->work.table != NULL)
    result = abbe_estimator_study_save(study, q->work.table, error);
  if (result == ABBE_OK) abbe_estimator_study_print(study, stdout);
  abbe_scene_free(&scene);
  free(study);
  return result;
}

static abbe_result study_transports(const abbe_sweep_options *q, abbe_error *error) {
  abbe_transport_contestant list[ABBE_TRANSPORT_STUDY_MOST];
  const size_t count = abbe_transport_study_contestants(q->grid, list);
  abbe_scene scene = {0};
  abbe_context *context = NULL;
  abbe_sweep_reference reference = {0};
  abbe_transport_study *study = calloc(1, sizeof *study);
  abbe_progress progress;
  abbe_error why = {0};
  char file[ABBE_SWEEP_PATH];
  size_t refused = 0, light;
  snprintf(file, sizeof file, "%.900s-volume.exr", q->work.table);
  abbe_arguments_add(q->program, ABBE_ARGUMENT_WRITES, "the volume", file);
  abbe_result result =
      study != NULL ? abbe_scene_input_load(q->program, q->scene, q->materials, &scene, error)
                    : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the study");
  if (result == ABBE_OK)
    result = abbe_sweep_reference_load(&scene, q->work.reference, NULL, &reference, &light, error);
  if (result == ABBE_OK) result = abbe_own_context_make(q->backend, q->quiet, &context, error);
  if (result == ABBE_OK) {
    const abbe_sweep sweep = {.context = context,
                              .scene = &scene,
                              .frames = q->work.frames,
                              .picture = &reference.picture};
    abbe_progress_begin(&progress, q->grid, q->quiet);
    result = abbe_transport_study_measure(&sweep, list, count, file, abbe_progress_update,
                                          &progress, study, &refused, &why, error);
    abbe_progress_end(&progress);
  }
  if (result == ABBE_OK && refused > 0 && !q->quiet)
    fprintf(stderr, "note: %zu of %zu ways are left out; the first: %s\n", refused, count,
            why.text);
  if (result == ABBE_OK) result = abbe_transport_table_save(study, q->work.table, error);
  if (result == ABBE_OK) abbe_transport_table_print(study, stdout);
  abbe_context_free(context);
  abbe_sweep_reference_free(&reference);
  abbe_scene_free(&scene);
  free(study);
  return result;
}

/* ---- tables ---- */

/* What a report draws again. */
static void protect_sources(const abbe_sweep_options *q, const abbe_sweep_table *table) {
  static const abbe_sweep_fact sources[] = {ABBE_SWEEP_FACT_SCENE, ABBE_SWEEP_FACT_REFERENCE,
                                            ABBE_SWEEP_FACT_REFERENCE_MAP};
  for (size_t i = 0; i < sizeof sources / sizeof *sources; i++)
    abbe_arguments_add(q->program, ABBE_ARGUMENT_READS, "the table's source",
                       table->fact[sources[i]]);
}

static abbe_result load_tables(const abbe_sweep_options *q, abbe_sweep_table *tables,
                               abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < q->argument_count && result == ABBE_OK; i++) {
    result = abbe_sweep_table_load(q->argument[i], &tables[i], error);
    if (result == ABBE_OK) protect_sources(q, &tables[i]);
    if (result == ABBE_OK)
      result = abbe_sweep_table_mark(&tables[i], q->work.time, q->work.error, NULL, error);
  }
  return result;
}

/* All rows into one table. */
static abbe_result join_tables(const abbe_sweep_options *q, abbe_sweep_table *tables, size_t *count,
                               abbe_error *error) {
  abbe_sweep_table all = {0};
  abbe_result result = abbe_sweep_table_join(tables, q->argument, *count, &all, error);
  if (result == ABBE_OK)
    result = abbe_sweep_table_mark(&all, q->work.time, q->work.error, NULL, error);
  if (result == ABBE_OK) result = abbe_sweep_table_save(&all, q->work.table, error);
  if (result != ABBE_OK) {
    abbe_sweep_table_free(&all);
    return result;
  }
  for (size_t i = 0; i < *count; i++) abbe_sweep_table_free(&tables[i]);
  tables[0] = all;
  *count = 1;
  return ABBE_OK;
}

/* ---- what is shown of both ---- */

static abbe_result write_page(const abbe_sweep_options *q, const abbe_sweep_table *tables,
                              size_t count, abbe_error *error) {
  abbe_context *context = NULL;
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < ABBE_SWEEP_PAGE_PICTURES; k++) {
      char own[ABBE_SWEEP_PATH];
      abbe_sweep_page_picture(q->report, tables, i, k, own);
      abbe_arguments_add(q->program, ABBE_ARGUMENT_WRITES, "the report's picture", own);
    }
  abbe_result result = abbe_own_context_make(q->backend, q->quiet, &context, error);
  if (result == ABBE_OK)
    result = abbe_sweep_page_write(context, q->report, tables, count, q->work.time, q->work.error,
                                   error);
  abbe_context_free(context);
  return result;
}

static abbe_result write_files(const abbe_sweep_options *q, const abbe_sweep_table *tables,
                               size_t count, abbe_error *error) {
  const abbe_sweep_number number = q->work.error;
  abbe_result result = ABBE_OK;
  if (q->plot != NULL && count > 1)
    result = abbe_sweep_plot_scenes(q->plot, tables, count, number, error);
  else if (q->plot != NULL)
    result = abbe_sweep_plot(q->plot, &tables[0], q->work.time, &number, 1, error);
  if (result == ABBE_OK && q->report != NULL) result = write_page(q, tables, count, error);
  if (result == ABBE_OK && q->write_presets != NULL)
    result = abbe_sweep_presets_write(q->write_presets, tables, q->argument, count, number,
                                      abbe_sweep_setting_is_fine, error);
  return result;
}

static abbe_result print_promises(const abbe_sweep_options *q, const abbe_sweep_table *table,
                                  abbe_error *error) {
  abbe_sweep_promises promises;
  abbe_result result = abbe_sweep_promises_make(table, q->presets, &promises, error);
  if (result != ABBE_OK) return result;
  abbe_sweep_report_print_promises(&promises);
  abbe_sweep_promises_free(&promises);
  return ABBE_OK;
}

static abbe_result show(const abbe_sweep_options *q, const abbe_sweep_table *tables, size_t count,
                        abbe_error *error) {
  abbe_result result = write_files(q, tables, count, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = q->json ? abbe_sweep_report_print_json(&tables[i], q->work.time, q->work.error, error)
                     : abbe_sweep_report_print(&tables[i], q->work.time, q->work.error, error);
  bool of_presets = q->grid != NULL && strcmp(q->grid, "presets") == 0;
  bool promised = (of_presets || q->presets != NULL) && !q->json;
  for (size_t i = 0; i < count && promised && result == ABBE_OK; i++)
    result = print_promises(q, &tables[i], error);
  return result;
}

static abbe_result run(const abbe_sweep_options *q, abbe_error *error) {
  const char *const targets[] = {q->work.table, q->plot, q->report};
  abbe_result result =
      abbe_rank_job_agree(q->job, abbe_command_check_targets(targets, 3, error), error);
  if (result != ABBE_OK) return result;
  if (q->scaling) return study_scaling(q, error);
  if (q->estimators) return study_estimators(q, error);
  if (abbe_sweep_options_compares_transports(q)) return study_transports(q, error);
  size_t count = q->scene == NULL ? q->argument_count : 1;
  abbe_sweep_table *tables = calloc(count, sizeof *tables);
  if (tables == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the tables");
  result = q->scene == NULL ? load_tables(q, tables, error) : sweep_scene(q, &tables[0], error);
  if (result == ABBE_OK && q->scene == NULL && q->work.table != NULL)
    result = join_tables(q, tables, &count, error);
  if (result == ABBE_OK && !q->list_only && !q->work.trace_only && !abbe_rank_job_is_silent(q->job))
    result = show(q, tables, count, error);
  for (size_t i = 0; i < count; i++) abbe_sweep_table_free(&tables[i]);
  free(tables);
  return result;
}

static int run_command(int argc, char **argv, abbe_rank_job *job) {
  abbe_error error = {0};
  abbe_sweep_grids grids;
  abbe_sweep_options q = {.program = argv[0], .grids = &grids, .job = job};
  q.work.frames = 5;
  q.work.time = ABBE_SWEEP_FRAME_MS;
  q.work.error = ABBE_SWEEP_CAUSTIC_DE;
  abbe_result result = abbe_sweep_grids_load(NULL, &grids, &error);
  if (result == ABBE_OK) {
    abbe_arguments_parse(&abbe_sweep_options_argp, ABBE_ARGUMENT_READS, argc, argv, &q);
    if (job != NULL) job->ready();
    q.quiet = q.quiet || abbe_rank_job_is_silent(job);
    if (q.listed && q.list.profiles.count == 0) {
      q.list.profiles.count = ABBE_SWEEP_PROFILE_COUNT;
      for (size_t i = 0; i < ABBE_SWEEP_PROFILE_COUNT; i++) q.list.profiles.value[i] = i;
    }
    result = run(&q, &error);
  } else if (job != NULL) {
    job->alone = true;
  }
  abbe_sweep_grids_free(&grids);
  return abbe_rank_job_end(job, argv[0], result, &error);
}

int abbe_command_sweep(int argc, char **argv) {
  return run_command(argc, argv, NULL);
}

int abbe_sweep_by_ranks(int argc, char **argv, abbe_rank_job *job) {
  return run_command(argc, argv, job);
}
