#include "cli/sweep/sweep_report.h"

#include "cli/base/command.h"

#include "validation/tradeoff/baseline_comparison.h"
#include "validation/tradeoff/error_decomposition.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARAGRAPH = 2000 };

static void print_row(const abbe_sweep_row *row) {
  char label[64], text[ABBE_SWEEP_SHORT];
  abbe_sweep_setting_label(&row->setting, label, sizeof label);
  printf("%-34s", label);
  for (int k = 0; k < ABBE_SWEEP_SHOWN; k++)
    printf(" %12s", abbe_sweep_number_short(row->number[abbe_sweep_shown[k]], text));
  printf("\n");
}

static abbe_result print_baseline(const abbe_sweep_table *table, const char *profile,
                                  abbe_sweep_number time, abbe_sweep_number number,
                                  abbe_error *error) {
  abbe_baseline_comparison c;
  char a[ABBE_SWEEP_SHORT], b[ABBE_SWEEP_SHORT];
  abbe_result result = abbe_baseline_comparison_make(table, profile, time, number, &c, error);
  if (result != ABBE_OK || c.front == 0) return result;
  printf("\n%s, by %s", abbe_baseline_text(profile), abbe_sweep_number_name(time));
  if (c.baseline != NULL) {
    printf(", at its own settings:\n");
    print_row(c.baseline);
    printf("the default profile at its error: %s times as fast; in its time: %s of its error",
           abbe_sweep_number_short(c.equal_error_speedup, a),
           abbe_sweep_number_short(c.equal_time_error_ratio, b));
  }
  printf("\nagainst its own Pareto front of %zu settings: at least %s times as fast; at most %s of "
         "its "
         "error; %zu are beaten in both\n",
         c.front, abbe_sweep_number_short(c.front_speedup, a),
         abbe_sweep_number_short(c.front_ratio, b), c.beaten);
  return ABBE_OK;
}

static void print_histories(const abbe_sweep_table *table) {
  static const abbe_sweep_number numbers[] = {ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_AFTER_1,
                                              ABBE_SWEEP_AFTER_2, ABBE_SWEEP_AFTER_4,
                                              ABBE_SWEEP_AFTER_8};
  enum { COUNT = sizeof numbers / sizeof *numbers };
  char label[64], text[ABBE_SWEEP_SHORT];
  bool begun = false;
  for (size_t i = 0; i < table->count; i++) {
    const abbe_sweep_row *row = &table->row[i];
    if (!abbe_sweep_setting_has_history(&row->setting)) continue;
    if (!begun) printf("\nframes that follow one another, the scene at rest:\n%-34s", "");
    for (int k = 0; k < COUNT && !begun; k++)
      printf(" %12s%s", abbe_sweep_number_name(numbers[k]), k + 1 == COUNT ? "\n" : "");
    begun = true;
    abbe_sweep_setting_label(&row->setting, label, sizeof label);
    printf("%-34s", label);
    for (int k = 0; k < COUNT; k++)
      printf(" %12s", abbe_sweep_number_short(row->number[numbers[k]], text));
    printf("\n");
  }
}

abbe_result abbe_sweep_report_print(const abbe_sweep_table *table, abbe_sweep_number time,
                                    abbe_sweep_number number, abbe_error *error) {
  size_t count, *order = abbe_sweep_table_front(table, time, &count);
  char text[ABBE_SWEEP_SHORT];
  if (order == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the front");
  printf("%s, %s: %zu settings, %zu on the Pareto front of %s and %s\n\n%-34s",
         table->fact[ABBE_SWEEP_FACT_SCENE], table->fact[ABBE_SWEEP_FACT_SIZE], table->count, count,
         abbe_sweep_number_name(time), abbe_sweep_number_name(number), "");
  for (int k = 0; k < ABBE_SWEEP_SHOWN; k++)
    printf(" %12s", abbe_sweep_number_name(abbe_sweep_shown[k]));
  printf("\n");
  for (size_t i = 0; i < count; i++) print_row(&table->row[order[i]]);
  if (count > 0)
    printf("the reference's own noise: %s of %s\n",
           abbe_sweep_number_short(table->row[order[0]].number[number + 1], text),
           abbe_sweep_number_name(number));
  free(order);
  abbe_result result = ABBE_OK;
  for (int i = 0; i < ABBE_BASELINE_COUNT; i++)
    for (int k = 0; k < ABBE_SWEEP_TIMES && result == ABBE_OK; k++)
      result = print_baseline(table, abbe_baselines[i], abbe_sweep_times[k], number, error);
  print_histories(table);
  const double unrest = abbe_sweep_table_unrest(table);
  if (unrest > ABBE_SWEEP_QUIET)
    printf("\nnote: the machine was busy: the median frame of half of the settings took more than "
           "%.0f %% longer than their fastest; measure again when it is quiet\n",
           100 * unrest);
  abbe_error_decomposition d;
  char words[PARAGRAPH];
  abbe_error_decomposition_make(table, &d);
  abbe_error_decomposition_say(&d, words, sizeof words);
  if (isfinite(d.rest)) printf("\n%s\n", words);
  return result;
}

/* Promises */

static void print_promise(const abbe_sweep_promise *p) {
  char label[64], e[ABBE_SWEEP_SHORT], ms[ABBE_SWEEP_SHORT];
  abbe_sweep_setting_label(&p->row->setting, label, sizeof label);
  printf("%-9s %-24s error %.3g promised, %s met", p->preset, label, p->error,
         abbe_sweep_number_short(p->error_met, e));
  printf("%s; %.0f ms promised, %s met\n", p->error_met <= p->error ? "" : " (MORE)", p->ms,
         abbe_sweep_number_short(p->ms_met, ms));
}

void abbe_sweep_report_print_promises(const abbe_sweep_promises *p) {
  if (p->front == NULL) return;
  printf("\npresets, %s, made on %s; margin %.3g for the error, %.3g for the time:\n",
         p->presets.error_text, p->front->scenes, p->front->margin, p->front->time_margin);
  for (size_t i = 0; i < p->count; i++) print_promise(&p->promise[i]);
}

/* JSON */

static void add_number(cJSON *object, const char *name, double value) {
  if (isfinite(value))
    cJSON_AddNumberToObject(object, name, value);
  else
    cJSON_AddNullToObject(object, name);
}

static cJSON *describe_row(const abbe_sweep_row *row) {
  const abbe_sweep_setting *s = &row->setting;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "profile", s->profile);
  cJSON_AddNumberToObject(o, "wavelengths", (double)s->wavelengths);
  cJSON_AddNumberToObject(o, "photons", (double)s->photons);
  cJSON_AddNumberToObject(o, "map", (double)s->map);
  cJSON_AddNumberToObject(o, "samples", (double)s->samples);
  cJSON_AddNumberToObject(o, "upsample", (double)s->upsample);
  cJSON_AddStringToObject(o, "fill", s->fill);
  cJSON_AddNumberToObject(o, "exits", (double)s->exits);
  cJSON_AddNumberToObject(o, "share", s->share);
  cJSON_AddStringToObject(o, "model", s->model);
  cJSON_AddNumberToObject(o, "passes", (double)s->passes);
  cJSON_AddNumberToObject(o, "history", (double)s->history);
  cJSON_AddStringToObject(o, "polygons", s->polygons);
  cJSON_AddStringToObject(o, "direction", s->direction);
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++)
    add_number(o, abbe_sweep_number_name((abbe_sweep_number)i), row->number[i]);
  cJSON_AddBoolToObject(o, "front", row->front);
  return o;
}

/* "equal_error_speedup" against the thesis profile, "vs_fair_..." against its method in units,
 * "vs_trace_..." against the tracer, "vs_shah2007_..." against caustics mapping; with "camera_"
 * before it of frames after a camera's move, with "warm_" and "cold_" of whole processes. */
static abbe_result describe_baseline(const abbe_sweep_table *table, const char *profile,
                                     abbe_sweep_number time, abbe_sweep_number number, cJSON *root,
                                     abbe_error *error) {
  abbe_baseline_comparison d;
  abbe_result result = abbe_baseline_comparison_make(table, profile, time, number, &d, error);
  if (result != ABBE_OK) return result;
  const struct {
    const char *name;
    double value;
  } all[] = {{"equal_error_speedup", d.equal_error_speedup},
             {"equal_time_error_ratio", d.equal_time_error_ratio},
             {"front_speedup", d.front_speedup},
             {"front_ratio", d.front_ratio},
             {"front_points", (double)d.front},
             {"front_points_beaten", (double)d.beaten}};
  const char *before = abbe_baseline_key(profile);
  const char *of = time == ABBE_SWEEP_CAMERA_MS ? "camera_"
                   : time == ABBE_SWEEP_WARM_MS ? "warm_"
                   : time == ABBE_SWEEP_COLD_MS ? "cold_"
                                                : "";
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    char name[64];
    snprintf(name, sizeof name, "%s%s%s", of, before, all[i].name);
    add_number(root, name, all[i].value);
  }
  return ABBE_OK;
}

static void describe_decomposition(const abbe_sweep_table *table, cJSON *root) {
  abbe_error_decomposition s;
  char words[PARAGRAPH];
  abbe_error_decomposition_make(table, &s);
  if (s.row == NULL) return;
  abbe_error_decomposition_say(&s, words, sizeof words);
  cJSON *o = cJSON_AddObjectToObject(root, "decomposition");
  add_number(o, "total", s.total);
  add_number(o, "model", s.model);
  add_number(o, "sampling_and_reconstruction", s.rest);
  add_number(o, "with_fill", s.with_fill);
  add_number(o, "without_fill", s.without_fill);
  cJSON_AddStringToObject(o, "words", words);
}

abbe_result abbe_sweep_report_print_json(const abbe_sweep_table *table, abbe_sweep_number time,
                                         abbe_sweep_number number, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  abbe_result result = ABBE_OK;
  for (int i = 0; i < ABBE_SWEEP_FACT_COUNT; i++)
    cJSON_AddStringToObject(root, abbe_sweep_fact_name((abbe_sweep_fact)i), table->fact[i]);
  cJSON_AddStringToObject(root, "time", abbe_sweep_number_name(time));
  cJSON_AddStringToObject(root, "error", abbe_sweep_number_name(number));
  for (int i = 0; i < ABBE_BASELINE_COUNT; i++)
    for (int k = 0; k < ABBE_SWEEP_TIMES && result == ABBE_OK; k++)
      result =
          describe_baseline(table, abbe_baselines[i], abbe_sweep_times[k], number, root, error);
  add_number(root, "unrest", abbe_sweep_table_unrest(table));
  describe_decomposition(table, root);
  cJSON *rows = cJSON_AddArrayToObject(root, "rows");
  for (size_t i = 0; i < table->count; i++)
    cJSON_AddItemToArray(rows, describe_row(&table->row[i]));
  if (result == ABBE_OK) result = abbe_command_print_json(root, error);
  cJSON_Delete(root);
  return result;
}
