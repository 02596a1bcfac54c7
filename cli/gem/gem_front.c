/* Designs from the most of a measure to the most fire, by derivatives of every tier. */
#include "cli/gem/gem.h"

#include "base/maths.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "colorimetry/plot/chart.h"
#include "validation/measure/gem/gem_ascent.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

/* What a degree between the lines F and C counts, as a share of light. */
static const double weights[] = {0, 0.1, 0.3, 1};
enum { POINTS = 1 + sizeof weights / sizeof *weights }; /* the design itself is the first */

typedef struct front {
  abbe_gem_number value[POINTS], fire[POINTS];
} front;

/* Whether none of the others has more of both. */
static bool is_best(const front *f, bool least, int i) {
  for (int k = 0; k < POINTS; k++) {
    const double gain = f->value[k].value - f->value[i].value;
    if ((least ? gain < 0 : gain > 0) && f->fire[k].value > f->fire[i].value) return false;
  }
  return true;
}

static abbe_result judge_fire(const abbe_gem_stone_input *s, const abbe_gem_optimum_desc *search,
                              const abbe_cut *cut, const abbe_cut_polyhedron *p,
                              abbe_gem_number *out, abbe_error *error) {
  const abbe_gem_tilts_desc desc = {
      .steps = 5, .head_rad = search->view.head_rad, .side = 12, .threads = search->view.threads};
  abbe_gem_stone stone;
  abbe_gem_tilts tilts = {0};
  ABBE_TRY(abbe_gem_stone_make(cut, p, s->in.material, &s->wavelengths, s->width_m, &stone, error));
  abbe_result result = ABBE_OK;
  if (abbe_vector_length(s->axes.z) > 0) result = abbe_gem_stone_turn(&stone, &s->axes, error);
  if (result == ABBE_OK) result = abbe_gem_tilts_make(&stone, &s->weights, &desc, &tilts, error);
  if (result == ABBE_OK) *out = tilts.mean[ABBE_GEM_TILT_FIRE];
  abbe_gem_tilts_free(&tilts);
  abbe_gem_stone_free(&stone);
  return result;
}

/* best.asc becomes best-3.asc. */
static abbe_result write_point(abbe_gem_stone_input *s, const char *out, int point,
                               const abbe_gem_ascent *a, abbe_error *error) {
  char path[4096];
  const char *dot = strrchr(out, '.');
  if (snprintf(path, sizeof path, "%.*s-%d%s", (int)(dot - out), out, point, dot) >=
      (int)sizeof path)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "'%s' is too long a name", out);
  return abbe_gem_output_write(path, &a->cut, &a->polyhedron, 1, NULL, &s->in.report, error);
}

/* Each search but the first goes on from where the one before came to. */
static abbe_result search_all(abbe_gem_stone_input *s, const abbe_gem_optimum_desc *search,
                              const char *out, front *f, abbe_progress *progress,
                              abbe_error *error) {
  const double n_d = abbe_dispersion_describe(&s->in.material->dispersion).n_d;
  const double v_d = abbe_dispersion_describe(&s->in.material->dispersion).v_d;
  abbe_gem_ascent last = {.cut = s->in.cut, .polyhedron = s->in.stone};
  abbe_result result = judge_fire(s, search, &s->in.cut, &s->in.stone, &f->fire[0], error);
  for (int i = 1; i < POINTS && result == ABBE_OK; i++) {
    abbe_gem_ascent_desc desc = {.search = *search,
                                 .tiers = true,
                                 .near = i > 1,
                                 .fire = weights[i - 1],
                                 .spread = (n_d - 1) / v_d};
    abbe_gem_ascent next;
    desc.search.progress = NULL; /* which is of this loop */
    result = abbe_gem_ascent_make(&last.cut, &last.polyhedron, s->in.material, &s->wavelengths,
                                  &s->weights, &desc, &next, error);
    if (result != ABBE_OK) break;
    if (i == 1) f->value[0] = next.design;
    if (i > 1) abbe_gem_ascent_free(&last);
    last = next;
    f->value[i] = last.value;
    result = judge_fire(s, search, &last.cut, &last.polyhedron, &f->fire[i], error);
    if (result == ABBE_OK && out != NULL) result = write_point(s, out, i, &last, error);
    if (result == ABBE_OK && !abbe_progress_update(progress, (double)i / (POINTS - 1)))
      result = abbe_error_set(error, ABBE_CANCELLED, "the search was given up");
  }
  if (last.cut.tier != s->in.cut.tier) abbe_gem_ascent_free(&last);
  return result;
}

static abbe_result plot(const char *path, const abbe_gem_stone_input *s, const char *measure,
                        const front *f, abbe_error *error) {
  double x[POINTS], y[POINTS], low[POINTS], high[POINTS];
  char title[300], label[64];
  for (int i = 0; i < POINTS; i++) {
    x[i] = 100 * f->value[i].value;
    y[i] = 100 * f->fire[i].value;
    low[i] = y[i] - 100 * f->fire[i].error;
    high[i] = y[i] + 100 * f->fire[i].error;
  }
  snprintf(title, sizeof title, "%s in %s", abbe_gem_input_title(&s->in), s->in.material->name);
  snprintf(label, sizeof label, "%s, %%", measure);
  const abbe_chart_series series[2] = {{.label = "best of all tiers",
                                        .style = ABBE_CHART_POINTS,
                                        .count = POINTS - 1,
                                        .x = x + 1,
                                        .y = y + 1,
                                        .low = low + 1,
                                        .high = high + 1},
                                       {.label = "the design",
                                        .style = ABBE_CHART_POINTS,
                                        .count = 1,
                                        .x = x,
                                        .y = y,
                                        .low = low,
                                        .high = high}};
  const abbe_chart chart = {.title = title,
                            .x = {.label = label},
                            .y = {.label = "fire, %"},
                            .series_count = 2,
                            .series = series};
  return abbe_chart_write(path, &chart, 1, 720, 540, error);
}

static abbe_result print_json(const front *f, bool least, abbe_error *error) {
  cJSON *root = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(root, "designs");
  for (int i = 0; i < POINTS; i++) {
    cJSON *one = cJSON_CreateObject();
    if (i > 0) cJSON_AddNumberToObject(one, "weight", weights[i - 1]);
    cJSON_AddNumberToObject(one, "value", f->value[i].value);
    cJSON_AddNumberToObject(one, "error", f->value[i].error);
    cJSON_AddNumberToObject(one, "fire", f->fire[i].value);
    cJSON_AddNumberToObject(one, "fire_error", f->fire[i].error);
    cJSON_AddBoolToObject(one, "front", is_best(f, least, i));
    cJSON_AddItemToArray(list, one);
  }
  return abbe_command_print_json(root, true, error);
}

abbe_result abbe_gem_optimise_front(abbe_gem_stone_input *s, const char *measure,
                                    const abbe_gem_optimum_desc *search, const char *out,
                                    const char *plot_path, abbe_error *error) {
  front f = {0};
  abbe_progress progress;
  abbe_progress_begin(&progress, "searching", s->in.quiet);
  abbe_result result = search_all(s, search, out, &f, &progress, error);
  abbe_progress_end(&progress);
  if (result == ABBE_OK && plot_path != NULL) result = plot(plot_path, s, measure, &f, error);
  if (result == ABBE_OK && s->in.json) return print_json(&f, search->least, error);
  if (result != ABBE_OK) return result;
  printf("%s in %s: %s against fire\n\n%-8s %9s %8s %9s %8s\n", s->in.path, s->in.material->name,
         measure, "", "value", "error", "fire", "error");
  for (int i = 0; i < POINTS; i++) {
    char name[16] = "design";
    if (i > 0) snprintf(name, sizeof name, "%d", i);
    printf("%-8s %7.2f %% %8.2f %7.2f %% %8.2f%s\n", name, 100 * f.value[i].value,
           100 * f.value[i].error, 100 * f.fire[i].value, 100 * f.fire[i].error,
           is_best(&f, search->least, i) ? "  front" : "");
  }
  return ABBE_OK;
}
