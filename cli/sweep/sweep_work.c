#include "cli/sweep/sweep_work.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/base/scene_input.h"

#include "colorimetry/image/exr.h"
#include "gl/accuracy/preset.h"
#include "scenes/import/scene_file.h"
#include "validation/sweep/sweep_growth.h"
#include "validation/tracer/reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#ifndef ABBE_VERSION
#error "the build defines ABBE_VERSION"
#endif

enum { PATH_SIZE = 1024, DEFAULT_TEXELS = 256 };

/* Says for which scene and request a reference was traced, so that no other takes it. */
static const char *const stamp_name = "abbe:sweep";

/* A reference, its files, and the stamp of those that the sweep traces itself. */
typedef struct traced {
  abbe_image picture, map;
  char picture_path[PATH_SIZE], map_path[PATH_SIZE], checkpoint_path[PATH_SIZE];
  char stamp[256];
} traced;

/* All that is loaded or made on the way. */
typedef struct work {
  const abbe_sweep_request *q;
  abbe_scene scene;
  abbe_context *context;
  traced full, matched; /* matched: where the split is asked for */
  abbe_sweep_model model;
  abbe_sweep sweep;
  abbe_sweep_setting *setting;
  size_t setting_count;
  abbe_sweep_table table;
} work;

static void close_work(work *w) {
  free(w->setting);
  traced *const all[] = {&w->full, &w->matched};
  for (int i = 0; i < 2; i++) {
    abbe_image_free(&all[i]->picture);
    abbe_image_free(&all[i]->map);
  }
  abbe_context_free(w->context);
  abbe_scene_free(&w->scene);
}

/* The reference */

/* Beside the table: STEM-reference.exr, STEM-matched.exr, their maps and checkpoints. */
static abbe_result name_files(work *w, abbe_error *error) {
  const char *csv = w->q->csv, *dot = strrchr(csv, '.'), *slash = strrchr(csv, '/');
  int stem = dot != NULL && (slash == NULL || dot > slash) ? (int)(dot - csv) : (int)strlen(csv);
  if (stem > PATH_SIZE - 64)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the path '%.80s…' is too long", csv);
  for (int i = 0; i < 2; i++) {
    traced *t = i == 0 ? &w->full : &w->matched;
    const char *kind = i == 0 ? "reference" : "matched";
    snprintf(t->picture_path, PATH_SIZE, "%.*s-%s.exr", stem, csv, kind);
    snprintf(t->map_path, PATH_SIZE, "%.*s-%s-map.exr", stem, csv, kind);
    snprintf(t->checkpoint_path, PATH_SIZE, "%.*s-%s.checkpoint", stem, csv, kind);
    if (w->q->reference != NULL || w->q->reference_map != NULL || (i > 0 && !w->q->split)) continue;
    const char *const kept[] = {t->picture_path, t->map_path, t->checkpoint_path};
    for (int k = 0; k < 3; k++)
      abbe_arguments_add(w->q->program, ABBE_ARGUMENT_WRITES, "the traced file", kept[k]);
  }
  return ABBE_OK;
}

static size_t passes_of(const abbe_sweep_request *q) {
  return q->passes > 0 ? q->passes : ABBE_REFERENCE_PASSES;
}

static bool is_stamped(const char *path, const char *stamp, abbe_image *image) {
  if (access(path, F_OK) != 0 || abbe_exr_read(path, image, NULL) != ABBE_OK) return false;
  const char *text = abbe_image_attribute_text(image, stamp_name);
  if (text != NULL && strcmp(text, stamp) == 0) return true;
  abbe_image_free(image);
  return false;
}

/* Written and read again, so that every run has the same image to the bit. */
static abbe_result keep(abbe_image *image, const char *stamp, const char *path, abbe_error *error) {
  abbe_result result = abbe_image_set_attribute(image, stamp_name, stamp, error);
  if (result == ABBE_OK) result = abbe_exr_write(path, image, error);
  if (result != ABBE_OK) return result;
  abbe_image_free(image);
  return abbe_exr_read(path, image, error);
}

static abbe_result trace_reference(work *w, bool matched, traced *to, abbe_error *error) {
  const abbe_sweep_request *q = w->q;
  abbe_map_layout layout;
  abbe_progress progress;
  abbe_reference_desc desc = {.trace = {.width = q->width, .height = q->height},
                              .passes = passes_of(q),
                              .checkpoint = to->checkpoint_path,
                              .progress = abbe_progress_update,
                              .user = &progress,
                              .stop = abbe_progress_stopped()};
  abbe_result result = abbe_sweep_fit_layout(w->context, &w->scene, 0, &layout, error);
  if (result != ABBE_OK) return result;
  desc.trace.layout = &layout;
  desc.trace.photons = q->photons;
  desc.trace.bands = ABBE_SWEEP_BANDS;
  /* Noise of its own: what the two have in common must not cancel. */
  desc.trace.seed = matched && q->split ? 1 : 0;
  desc.trace.map_width = desc.trace.map_height = q->texels > 0 ? q->texels : DEFAULT_TEXELS;
  if (matched) {
    abbe_plan plan;
    result = abbe_plan_make(&w->scene, NULL, &plan, error);
    if (result != ABBE_OK) return result;
    desc.trace.physics = (abbe_physics){true, plan.desc.exits, plan.desc.energy_share,
                                        plan.eye_exits, plan.eye_share};
    abbe_plan_free(&plan);
  }
  abbe_progress_begin(&progress, matched ? "matched" : "reference", q->quiet);
  result = abbe_reference_trace(&w->scene, &desc, &to->picture, &to->map, error);
  abbe_progress_end(&progress);
  if (result == ABBE_OK) result = keep(&to->picture, to->stamp, to->picture_path, error);
  if (result == ABBE_OK) result = keep(&to->map, to->stamp, to->map_path, error);
  if (result == ABBE_OK) unlink(to->checkpoint_path);
  return result;
}

/* A reference that this scene and request left before is taken; else it is traced. */
static abbe_result find_reference(work *w, bool matched, traced *to, abbe_error *error) {
  const abbe_sweep_request *q = w->q;
  size_t width = q->width > 0 ? q->width : w->scene.camera.width;
  size_t height = q->height > 0 ? q->height : w->scene.camera.height;
  snprintf(
      to->stamp, sizeof to->stamp,
      "scene %016llx, %zu x %zu pixels, %zu texels a side, %d bands, %zu passes of %zu photons, %s",
      abbe_sweep_hash_scene(&w->scene), width, height,
      q->texels > 0 ? q->texels : (size_t)DEFAULT_TEXELS, ABBE_SWEEP_BANDS, passes_of(q),
      q->photons, matched ? "matched" : "full");
  if (is_stamped(to->picture_path, to->stamp, &to->picture)) {
    if (is_stamped(to->map_path, to->stamp, &to->map)) {
      unlink(to->checkpoint_path); /* a kill may have left it, and another request refuses it */
      return ABBE_OK;
    }
    abbe_image_free(&to->picture);
  }
  return trace_reference(w, matched, to, error);
}

/* Files that the user names: what is not named is not compared. */
static abbe_result load_reference(work *w, abbe_error *error) {
  const abbe_sweep_request *q = w->q;
  abbe_result result = ABBE_OK;
  snprintf(w->full.picture_path, PATH_SIZE, "%s", q->reference != NULL ? q->reference : "");
  snprintf(w->full.map_path, PATH_SIZE, "%s", q->reference_map != NULL ? q->reference_map : "");
  if (q->reference != NULL) result = abbe_exr_read(q->reference, &w->full.picture, error);
  if (result == ABBE_OK && q->reference_map != NULL)
    result = abbe_exr_read(q->reference_map, &w->full.map, error);
  const char *light = abbe_image_attribute_text(&w->full.map, "abbe:map_light");
  abbe_map_layout layout;
  if (result == ABBE_OK && q->reference_map != NULL)
    result = abbe_map_layout_read(&w->full.map, q->reference_map, &layout, error);
  if (result == ABBE_OK && light != NULL)
    result = abbe_scene_find_light(&w->scene, light, &w->sweep.light, error);
  return result;
}

static abbe_result get_reference(work *w, abbe_error *error) {
  const abbe_sweep_request *q = w->q;
  bool named = q->reference != NULL || q->reference_map != NULL;
  abbe_result result =
      named ? load_reference(w, error) : find_reference(w, q->matched, &w->full, error);
  if (result == ABBE_OK && q->split) result = find_reference(w, true, &w->matched, error);
  if (result != ABBE_OK) return result;
  if (w->full.picture.data != NULL) w->sweep.picture = &w->full.picture;
  if (w->full.map.data != NULL) w->sweep.map = &w->full.map;
  if (!q->split) return ABBE_OK;
  w->sweep.matched_picture = &w->matched.picture;
  w->sweep.matched_map = &w->matched.map;
  return abbe_sweep_model_measure(&w->sweep, &w->model, error);
}

/* What the table belongs to */

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

static void state_facts(work *w, abbe_sweep_table *t) {
  char text[256];
  struct tm day;
  time_t now = time(NULL);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_PROGRAM, "abbe " ABBE_VERSION);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_SCENE, w->q->scene);
  snprintf(text, sizeof text, "%016llx", abbe_sweep_hash_scene(&w->scene));
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_SCENE_HASH, text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_CLASS, class_of(&w->scene));
  size_t width = w->scene.camera.width, height = w->scene.camera.height;
  snprintf(text, sizeof text, "%zux%zu",
           w->full.picture.data != NULL ? w->full.picture.width : width,
           w->full.picture.data != NULL ? w->full.picture.height : height);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_SIZE, text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_REFERENCE, w->full.picture_path);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_REFERENCE_MAP, w->full.map_path);
  snprintf(text, sizeof text, "%016llx", abbe_sweep_hash_images(w->sweep.picture, w->sweep.map));
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_REFERENCE_HASH, text);
  if (w->q->split) abbe_sweep_model_write(&w->model, t);
  snprintf(text, sizeof text, "%zu", w->sweep.frames);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_FRAMES, text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_DEVICE, abbe_context_description(w->context));
  describe_machine(text, sizeof text);
  abbe_sweep_table_set(t, ABBE_SWEEP_FACT_MACHINE, text);
  if (gmtime_r(&now, &day) != NULL && strftime(text, sizeof text, "%Y-%m-%d", &day) > 0)
    abbe_sweep_table_set(t, ABBE_SWEEP_FACT_DATE, text);
}

/* Takes up the rows of an earlier run, if they belong to this one. */
static abbe_result open_table(work *w, abbe_error *error) {
  abbe_sweep_table now = {0};
  state_facts(w, &now);
  if (access(w->q->csv, F_OK) != 0) {
    w->table = now;
    return ABBE_OK;
  }
  abbe_result result = abbe_sweep_table_load(w->q->csv, &w->table, error);
  if (result == ABBE_OK) result = abbe_sweep_table_agree(&w->table, w->q->csv, &now, error);
  return result;
}

/* The rows */

/* The settings of the presets' front for this scene. */
static abbe_result get_preset_settings(work *w, abbe_error *error) {
  abbe_presets presets = {0};
  const abbe_preset_front *front = NULL;
  abbe_plan plan;
  abbe_result result = abbe_plan_make(&w->scene, NULL, &plan, error);
  if (result != ABBE_OK) return result;
  result = abbe_presets_load(w->q->presets_file, &presets, error);
  if (result == ABBE_OK) result = abbe_presets_find(&presets, &plan, &front, error);
  abbe_plan_free(&plan);
  if (result == ABBE_OK) w->setting = calloc(front->count, sizeof *w->setting);
  if (result == ABBE_OK && w->setting == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the presets");
  for (size_t i = 0; result == ABBE_OK && i < front->count; i++)
    abbe_sweep_setting_of(&front->point[i].desc, &w->setting[w->setting_count++]);
  abbe_presets_free(&presets);
  return result;
}

static abbe_result get_settings(work *w, abbe_error *error) {
  if (w->q->presets) return get_preset_settings(w, error);
  size_t refused;
  abbe_error why = {0};
  abbe_result result = abbe_sweep_grid_expand(&w->scene, w->q->grid, w->q->grid_count, &w->setting,
                                              &w->setting_count, &refused, &why, error);
  if (result == ABBE_OK && refused > 0 && !w->q->quiet)
    fprintf(stderr, "note: %zu settings of the grid are left out; the first: %s\n", refused,
            why.text);
  return result;
}

/* One frame's progress within the whole sweep's. */
typedef struct step {
  abbe_progress *progress;
  double done, share;
} step;

static bool step_on(void *user, double done) {
  const step *s = user;
  return abbe_progress_update(s->progress, s->done + s->share * done);
}

static abbe_result measure(work *w, const abbe_sweep_setting *setting, step *s, abbe_error *error) {
  abbe_sweep_row row;
  char text[200];
  abbe_error why = {0};
  abbe_result result = abbe_sweep_measure(&w->sweep, setting, step_on, s, &row, NULL, &why);
  abbe_sweep_setting_describe(setting, text, sizeof text);
  if (result != ABBE_OK) return abbe_error_set(error, result, "%s: %.700s", text, why.text);
  result = abbe_sweep_table_add(&w->table, &row, error);
  if (result == ABBE_OK) result = abbe_sweep_table_mark(&w->table, w->q->error, NULL, error);
  return result == ABBE_OK ? abbe_sweep_table_save(&w->table, w->q->csv, error) : result;
}

static abbe_result run(work *w, abbe_error *error) {
  abbe_progress progress;
  size_t missing = 0, done = 0;
  for (size_t i = 0; i < w->setting_count; i++)
    missing += abbe_sweep_table_find(&w->table, &w->setting[i]) == NULL;
  abbe_progress_begin(&progress, "sweep", w->q->quiet);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < w->setting_count && result == ABBE_OK; i++) {
    if (abbe_sweep_table_find(&w->table, &w->setting[i]) != NULL) continue;
    step s = {&progress, (double)done / (double)missing, 1 / (double)missing};
    result = measure(w, &w->setting[i], &s, error);
    done += result == ABBE_OK;
  }
  abbe_progress_end(&progress);
  if (result == ABBE_CANCELLED)
    return abbe_error_set(error, result,
                          "stopped; %zu of %zu settings are in %s, and the same command goes on",
                          w->table.count, w->setting_count, w->q->csv);
  /* The front is of the error that is asked for now. */
  if (result == ABBE_OK) result = abbe_sweep_table_mark(&w->table, w->q->error, NULL, error);
  return result == ABBE_OK ? abbe_sweep_table_save(&w->table, w->q->csv, error) : result;
}

static abbe_result list(const work *w) {
  char text[200];
  for (size_t i = 0; i < w->setting_count; i++) {
    abbe_sweep_setting_describe(&w->setting[i], text, sizeof text);
    printf("%s\n", text);
  }
  return ABBE_OK;
}

static abbe_result work_on(work *w, abbe_error *error) {
  abbe_result result =
      abbe_scene_input_load(w->q->program, w->q->scene, w->q->materials, &w->scene, error);
  if (result == ABBE_OK) result = get_settings(w, error);
  if (result == ABBE_OK && w->q->list) return list(w);
  if (result == ABBE_OK) result = name_files(w, error);
  if (result == ABBE_OK) result = abbe_context_make(w->q->backend, &w->context, error);
  w->sweep = (abbe_sweep){.context = w->context, .scene = &w->scene, .frames = w->q->frames};
  if (result == ABBE_OK) result = get_reference(w, error);
  if (result == ABBE_CANCELLED)
    return abbe_error_set(error, result,
                          "stopped while the reference was traced; what is done is kept, and the "
                          "same command goes on");
  if (result != ABBE_OK || w->q->trace_only) return result;
  result = open_table(w, error);
  return result == ABBE_OK ? run(w, error) : result;
}

abbe_result abbe_sweep_work(const abbe_sweep_request *q, abbe_sweep_table *out, abbe_error *error) {
  work w = {.q = q};
  abbe_result result = work_on(&w, error);
  close_work(&w);
  if (result == ABBE_OK)
    *out = w.table;
  else
    abbe_sweep_table_free(&w.table);
  return result;
}

abbe_result abbe_sweep_grow(const abbe_sweep_request *q, abbe_error *error) {
  abbe_scene scene = {0};
  abbe_context *context = NULL;
  abbe_sweep_growth growth;
  abbe_progress progress;
  abbe_result result = abbe_scene_input_load(q->program, q->scene, q->materials, &scene, error);
  if (result == ABBE_OK) result = abbe_context_make(q->backend, &context, error);
  if (result == ABBE_OK) {
    const abbe_sweep sweep = {.context = context, .scene = &scene, .frames = q->frames};
    abbe_progress_begin(&progress, "growth", q->quiet);
    result = abbe_sweep_growth_measure(&sweep, &scene, q->width > 0 ? q->width : 256,
                                       abbe_progress_update, &progress, &growth, error);
    abbe_progress_end(&progress);
  }
  if (result == ABBE_OK) result = abbe_sweep_growth_save(&growth, q->csv, error);
  if (result == ABBE_OK && q->plot != NULL)
    result = abbe_sweep_growth_plot(&growth, q->plot, error);
  if (result == ABBE_OK) abbe_sweep_growth_print(&growth, stdout);
  abbe_context_free(context);
  abbe_scene_free(&scene);
  return result;
}
