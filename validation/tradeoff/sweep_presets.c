#include "validation/tradeoff/sweep_presets.h"

#include "base/file.h"
#include "base/number.h"
#include "base/yaml/yaml_quote.h"
#include "validation/tradeoff/pareto_front.h"
#include "validation/tradeoff/sweep_pictures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How far above the least error of its kind the accurate preset may be: within it more time buys
 * nothing that one sees. */
static const double slack = 0.02;

/* Settings that give up paths sooner than the default does are no presets: what they leave out may
 * be all that a scene that was not swept is made of, as a rainbow is of light reflected inside. */
static const double most_share = 0.01;

/* A setting that all sweeps of a class have. */
typedef struct point {
  const abbe_sweep_setting *setting;
  double light_ms, eye_ms, error, least;
} point;

typedef struct front {
  const abbe_sweep_table *tables;
  size_t count; /* tables */
  const char *of;
  abbe_sweep_number number;
  point *point;
  size_t points, *order, on_front;
  double *cost, *error; /* of all points, then of the front's */
  size_t cheapest;      /* the point that costs are relative to */
  bool (*is_fine)(const abbe_sweep_setting *setting);
} front;

/* What a promise is widened by: the worst that leaving one scene out would have been wrong by. */
typedef struct margins {
  double error, time;
  size_t scenes; /* 0: too few to know */
} margins;

static const char *class_of(const abbe_sweep_table *table) {
  return table->fact[ABBE_SWEEP_FACT_CLASS];
}

static bool is_of(const front *f, size_t table) {
  return strcmp(class_of(&f->tables[table]), f->of) == 0 &&
         abbe_sweep_table_tells(&f->tables[table], f->number);
}

static bool is_known(const abbe_sweep_row *row, abbe_sweep_number number) {
  return row->number[ABBE_SWEEP_LIGHT_MS] > 0 && row->number[ABBE_SWEEP_EYE_MS] > 0 &&
         isfinite(row->number[number]);
}

/* The setting's point over all sweeps of the class; false where one does not have it. */
static bool gather(const front *f, const abbe_sweep_setting *setting, point *out) {
  size_t tables = 0;
  *out = (point){.setting = setting, .error = 0, .least = INFINITY};
  for (size_t i = 0; i < f->count; i++) {
    if (!is_of(f, i)) continue;
    const abbe_sweep_row *row = abbe_sweep_table_find(&f->tables[i], setting);
    if (row == NULL || !is_known(row, f->number)) return false;
    out->light_ms += log(row->number[ABBE_SWEEP_LIGHT_MS]);
    out->eye_ms += log(row->number[ABBE_SWEEP_EYE_MS]);
    out->error = fmax(out->error, row->number[f->number]);
    out->least = fmin(out->least, row->number[f->number]);
    tables++;
  }
  if (tables == 0) return false;
  out->light_ms = exp(out->light_ms / (double)tables);
  out->eye_ms = exp(out->eye_ms / (double)tables);
  return true;
}

/* Costs as they are promised: what the cheapest setting takes, times the worst of the scenes'
 * ratios to it. */
static void make_costs_the_worst(front *f) {
  size_t base = 0;
  for (size_t i = 1; i < f->points; i++)
    if (f->point[i].light_ms + f->point[i].eye_ms < f->point[base].light_ms + f->point[base].eye_ms)
      base = i;
  const point cheapest = f->point[base];
  f->cheapest = base;
  for (size_t k = 0; k < f->points; k++) {
    double light = 0, eye = 0;
    for (size_t i = 0; i < f->count; i++) {
      if (!is_of(f, i)) continue;
      const double *own = abbe_sweep_table_find(&f->tables[i], f->point[k].setting)->number;
      const double *least = abbe_sweep_table_find(&f->tables[i], cheapest.setting)->number;
      light = fmax(light, own[ABBE_SWEEP_LIGHT_MS] / least[ABBE_SWEEP_LIGHT_MS]);
      eye = fmax(eye, own[ABBE_SWEEP_EYE_MS] / least[ABBE_SWEEP_EYE_MS]);
    }
    f->point[k].light_ms = cheapest.light_ms * light;
    f->point[k].eye_ms = cheapest.eye_ms * eye;
  }
}

static void close_front(front *f) {
  free(f->point);
  free(f->order);
  free(f->cost);
}

/* The points and the front of the class of tables[first]. */
static abbe_result open_front(const abbe_sweep_table *tables, size_t count, size_t first,
                              abbe_sweep_number number, front *f, abbe_error *error) {
  const abbe_sweep_table *own = &tables[first];
  *f = (front){.tables = tables, .count = count, .of = class_of(own), .number = number};
  f->point = calloc(own->count + 1, sizeof *f->point);
  f->order = calloc(own->count + 1, sizeof *f->order);
  f->cost = calloc(2 * own->count + 1, sizeof *f->cost);
  if (f->point == NULL || f->order == NULL || f->cost == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the presets");
  f->error = f->cost + own->count;
  for (size_t i = 0; i < own->count; i++) {
    const abbe_sweep_setting *setting = &own->row[i].setting;
    if (strcmp(setting->profile, "default") != 0 || setting->share > most_share ||
        abbe_sweep_setting_has_history(setting))
      continue;
    f->points += gather(f, setting, &f->point[f->points]);
  }
  make_costs_the_worst(f);
  for (size_t i = 0; i < f->points; i++) {
    f->cost[i] = f->point[i].light_ms + f->point[i].eye_ms;
    f->error[i] = f->point[i].error;
  }
  f->on_front = abbe_pareto_front_order(f->cost, f->error, f->points, f->order);
  /* In the order of cost, so in place: what is overwritten may still be needed. */
  for (size_t i = 0; i < f->on_front; i++) {
    const point *p = &f->point[f->order[i]];
    f->cost[i] = p->light_ms + p->eye_ms;
    f->error[i] = p->error;
  }
  return ABBE_OK;
}

/* Times of a scene's light's and eye's passes for a point, over those for the cheapest. */
static void get_ratios(const front *f, size_t table, const point *p, double out[2]) {
  const abbe_sweep_table *t = &f->tables[table];
  const double *own = abbe_sweep_table_find(t, p->setting)->number;
  const double *least = abbe_sweep_table_find(t, f->point[f->cheapest].setting)->number;
  out[0] = own[ABBE_SWEEP_LIGHT_MS] / least[ABBE_SWEEP_LIGHT_MS];
  out[1] = own[ABBE_SWEEP_EYE_MS] / least[ABBE_SWEEP_EYE_MS];
}

/* One scene's error and time at a point against what the other scenes alone would have promised. */
static void leave_out(const front *f, size_t table, const point *p, margins *m) {
  const double *own = abbe_sweep_table_find(&f->tables[table], p->setting)->number;
  const double *base =
      abbe_sweep_table_find(&f->tables[table], f->point[f->cheapest].setting)->number;
  double error = 0, most[2] = {0, 0};
  for (size_t i = 0; i < f->count; i++) {
    double ratio[2];
    if (i == table || !is_of(f, i)) continue;
    error = fmax(error, abbe_sweep_table_find(&f->tables[i], p->setting)->number[f->number]);
    get_ratios(f, i, p, ratio);
    for (int k = 0; k < 2; k++) most[k] = fmax(most[k], ratio[k]);
  }
  double promised_ms = base[ABBE_SWEEP_LIGHT_MS] * most[0] + base[ABBE_SWEEP_EYE_MS] * most[1];
  double ms = own[ABBE_SWEEP_LIGHT_MS] + own[ABBE_SWEEP_EYE_MS];
  if (error > 0) m->error = fmax(m->error, own[f->number] / error);
  m->time = fmax(m->time, ms / promised_ms);
}

/* Over the front's points: those are what is promised. */
static void find_margins(const front *f, margins *out) {
  *out = (margins){1, 1, 0};
  for (size_t i = 0; i < f->count; i++) out->scenes += is_of(f, i);
  if (out->scenes < 2) {
    out->scenes = 0;
    return;
  }
  for (size_t i = 0; i < f->count; i++)
    for (size_t k = 0; k < f->on_front && is_of(f, i); k++)
      leave_out(f, i, &f->point[f->order[k]], out);
}

static void write_point(FILE *out, const point *p) {
  const abbe_sweep_setting *s = p->setting;
  char share[ABBE_NUMBER_TEXT_SIZE];
  abbe_number_write(
      out,
      "  - {wavelengths: %zu, photons: %zu, map: %zu, samples: %zu, upsample: %zu, fill: %s, "
      "exits: %zu, "
      "share: %s,\n     model: %s, light_ms: %.2f, eye_ms: %.2f, error: %.4g, least: %.4g}\n",
      s->wavelengths, s->photons, s->map, s->samples, s->upsample, s->fill, s->exits,
      abbe_number_text(s->share, share), s->model, p->light_ms, p->eye_ms, p->error, p->least);
}

/* Among the front's points that are finer than the defaults, the cheapest that is as good as the
 * best; on_front where there is none. */
static size_t find_accurate(const front *f) {
  double least = INFINITY;
  for (size_t i = 0; i < f->on_front; i++)
    if (f->is_fine(f->point[f->order[i]].setting)) least = fmin(least, f->error[i]);
  size_t at = 0;
  while (at < f->on_front &&
         !(f->is_fine(f->point[f->order[at]].setting) && f->error[at] <= (1 + slack) * least))
    at++;
  return at;
}

static void write_class(FILE *out, const front *f, const margins *widest) {
  margins own;
  char scenes[512] = "";
  size_t used = 0;
  for (size_t i = 0; i < f->count && used < sizeof scenes / 2; i++) {
    if (!is_of(f, i)) continue;
    const char *scene = abbe_file_name(f->tables[i].fact[ABBE_SWEEP_FACT_SCENE]);
    used += (size_t)snprintf(scenes + used, sizeof scenes - used, "%s%.*s", used > 0 ? ", " : "",
                             (int)strcspn(scene, "."), scene);
  }
  fprintf(out, "- class: ");
  abbe_yaml_quote_write(f->of, out);
  fprintf(out, "\n  scenes: ");
  abbe_yaml_quote_write(scenes, out);
  find_margins(f, &own);
  if (own.scenes == 0) own = (margins){widest->error, widest->time, 0};
  abbe_number_write(out, "\n  margin: %.4g\n  time_margin: %.4g\n  margin_scenes: %zu", own.error,
                    own.time, own.scenes);
  size_t accurate = find_accurate(f);
  bool has_one = accurate < f->on_front;
  size_t last = has_one ? accurate : abbe_pareto_front_accurate(f->error, f->on_front, slack);
  fprintf(out, "\n  draft: 0\n  balanced: %zu\n",
          abbe_pareto_front_knee(f->cost, f->error, last + 1));
  if (has_one)
    fprintf(out, "  accurate: %zu\n  front:\n", accurate);
  else
    fprintf(out, "  # accurate: no setting that is finer than the defaults is on the front\n"
                 "  front:\n");
  for (size_t i = 0; i < f->on_front; i++) write_point(out, &f->point[f->order[i]]);
}

static void write_head(FILE *out, const abbe_sweep_table *t, abbe_sweep_number number) {
  static const abbe_sweep_fact run[] = {ABBE_SWEEP_FACT_DATE, ABBE_SWEEP_FACT_PROGRAM,
                                        ABBE_SWEEP_FACT_MACHINE, ABBE_SWEEP_FACT_DEVICE,
                                        ABBE_SWEEP_FACT_SIZE};
  char text[1536] = "";
  size_t used = 0;
  for (size_t i = 0; i < sizeof run / sizeof *run; i++)
    used += (size_t)snprintf(text + used, sizeof text - used, "%.200s; ", t->fact[run[i]]);
  snprintf(text + used, sizeof text - used, "medians of %.20s frames",
           t->fact[ABBE_SWEEP_FACT_FRAMES]);
  fprintf(out,
          "# Settings that are worth their time, read off sweeps; made by\n"
          "#   abbe sweep SWEEP.csv... --write-presets FILE\n"
          "# and not by hand. Times are the cheapest setting's, geometric means over the scenes,\n"
          "# times the worst of the scenes' ratios to it; error is the worst of\n"
          "# them and least the best; draft, balanced and accurate count the points from 0.\n"
          "# What is promised of another scene is error times margin, and the time times\n"
          "# time_margin: the most by which a scene of margin_scenes was worse than the others\n"
          "# had promised (0: the class has too few, and the widest of the others is taken).\n"
          "error: ");
  abbe_yaml_quote_write(abbe_sweep_number_name(number), out);
  fprintf(out, "\nwhat: ");
  abbe_yaml_quote_write(abbe_sweep_number_text(number), out);
  fprintf(out, "\nrun: ");
  abbe_yaml_quote_write(text, out);
  fprintf(out, "\n");
}

/* Sweeps whose reference should be traced for longer. */
static void write_noisy(FILE *out, const abbe_sweep_table *tables, size_t count,
                        abbe_sweep_number number) {
  for (size_t i = 0; i < count; i++)
    if (!abbe_sweep_table_tells(&tables[i], number))
      fprintf(out, "# left out, for its reference's noise explains its errors: %s\n",
              abbe_file_name(tables[i].fact[ABBE_SWEEP_FACT_SCENE]));
  fprintf(out, "classes:\n");
}

static abbe_result check(const abbe_sweep_table *tables, const char *const *names, size_t count,
                         abbe_error *error) {
  static const abbe_sweep_fact same[] = {ABBE_SWEEP_FACT_PROGRAM, ABBE_SWEEP_FACT_MACHINE,
                                         ABBE_SWEEP_FACT_DEVICE, ABBE_SWEEP_FACT_SIZE};
  if (count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no sweep to read presets off");
  for (size_t i = 0; i < count; i++) {
    if (class_of(&tables[i])[0] == '\0')
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: it does not name its scene's class; sweep the scene again",
                            names[i]);
    for (size_t k = 0; k < sizeof same / sizeof *same; k++)
      if (strcmp(tables[i].fact[same[k]], tables[0].fact[same[k]]) != 0)
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "%s and %s are of different %ss, '%.150s' and '%.150s'; presets are "
                              "read off sweeps of one run",
                              names[0], names[i], abbe_sweep_fact_name(same[k]),
                              tables[0].fact[same[k]], tables[i].fact[same[k]]);
  }
  return ABBE_OK;
}

/* The first of its class that has errors above noise, so that a class is written once. */
static bool opens_class(const abbe_sweep_table *tables, size_t count, size_t index,
                        abbe_sweep_number number) {
  size_t first = count;
  for (size_t i = count; i-- > 0;)
    if (strcmp(class_of(&tables[i]), class_of(&tables[index])) == 0 &&
        (first == count || abbe_sweep_table_tells(&tables[i], number) ||
         !abbe_sweep_table_tells(&tables[first], number)))
      first = i;
  return first == index;
}

/* The widest margins of the classes that have scenes enough. */
static abbe_result find_widest(const abbe_sweep_table *tables, size_t count,
                               abbe_sweep_number number, margins *out, abbe_error *error) {
  abbe_result result = ABBE_OK;
  *out = (margins){1, 1, 0};
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    front f;
    margins own;
    if (!opens_class(tables, count, i, number)) continue;
    result = open_front(tables, count, i, number, &f, error);
    if (result == ABBE_OK && f.on_front > 0) {
      find_margins(&f, &own);
      *out = (margins){fmax(out->error, own.error), fmax(out->time, own.time), 0};
    }
    close_front(&f);
  }
  return result;
}

static abbe_result write_all(FILE *out, const abbe_sweep_table *tables, const char *const *names,
                             size_t count, abbe_sweep_number number,
                             bool (*is_fine)(const abbe_sweep_setting *setting),
                             abbe_error *error) {
  margins widest;
  abbe_result result = find_widest(tables, count, number, &widest, error);
  write_head(out, &tables[0], number);
  write_noisy(out, tables, count, number);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    front f;
    if (!opens_class(tables, count, i, number)) continue;
    result = open_front(tables, count, i, number, &f, error);
    if (result == ABBE_OK && f.on_front == 0)
      result =
          abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                         "%s: its class, %s, has no setting of the default profile whose %s is "
                         "known in all its sweeps",
                         names[i], f.of, abbe_sweep_number_name(number));
    f.is_fine = is_fine;
    if (result == ABBE_OK) write_class(out, &f, &widest);
    if (result == ABBE_OK)
      result = abbe_sweep_pictures_write(out, tables, count, f.of, number, error);
    close_front(&f);
  }
  return result;
}

abbe_result abbe_sweep_presets_write(const char *path, const abbe_sweep_table *tables,
                                     const char *const *names, size_t count,
                                     abbe_sweep_number number,
                                     bool (*is_fine)(const abbe_sweep_setting *setting),
                                     abbe_error *error) {
  abbe_file_writer writer = {0};
  abbe_result result = check(tables, names, count, error);
  if (result == ABBE_OK) result = abbe_file_writer_open(&writer, path, error);
  if (result == ABBE_OK)
    result = write_all(writer.stream, tables, names, count, number, is_fine, error);
  return abbe_file_writer_end(&writer, result, error);
}
