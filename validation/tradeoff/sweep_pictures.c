#include "validation/tradeoff/sweep_pictures.h"

#include "base/number.h"
#include "validation/tradeoff/pareto_front.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A setting that gives up paths sooner is no preset: a scene may be made of what it leaves out. */
static const double most_share = 0.01;

#define ABBE_NAME_OF(code, name, profile) name,
#define ABBE_PROFILE_OF(code, name, profile) profile,
static const char *const names[] = {ABBE_PICTURE_TOOLS(ABBE_NAME_OF)};
static const char *const profiles[] = {ABBE_PICTURE_TOOLS(ABBE_PROFILE_OF)};

const char *abbe_picture_tool_name(abbe_picture_tool tool) {
  return (unsigned)tool < ABBE_PICTURE_TOOL_COUNT ? names[tool] : "unknown";
}

abbe_picture_tool abbe_picture_tool_of(const abbe_sweep_setting *setting) {
  int tool = 0;
  while (tool < ABBE_PICTURE_TOOL_COUNT && strcmp(setting->profile, profiles[tool]) != 0) tool++;
  return (abbe_picture_tool)tool;
}

/* A setting that all sweeps of the class have. */
typedef struct point {
  const abbe_sweep_setting *setting;
  abbe_picture_tool tool;
  double ms, error, least;
} point;

/* The class: its tables, and in each what the yardstick takes and says of its own error. */
typedef struct group {
  const abbe_sweep_table **table; /* [count] */
  double *base_ms, *base_error;   /* [count] */
  size_t count;
  double mean_ms, mean_error; /* geometric */
  abbe_sweep_number number;
} group;

static const abbe_sweep_row *find_yardstick(const abbe_sweep_table *table) {
  for (size_t i = 0; i < table->count; i++) {
    const abbe_sweep_setting *s = &table->row[i].setting;
    if (strcmp(s->profile, ABBE_SWEEP_TRACE) == 0 && s->passes == ABBE_PICTURE_YARDSTICK_PASSES &&
        s->photons == ABBE_PICTURE_YARDSTICK_PHOTONS)
      return &table->row[i];
  }
  return NULL;
}

/* False where a table has no yardstick, or there is no table. */
static bool fill_group(const abbe_sweep_table *tables, size_t count, const char *of, group *g) {
  g->count = 0;
  g->mean_ms = g->mean_error = 0;
  for (size_t i = 0; i < count; i++) {
    if (strcmp(tables[i].fact[ABBE_SWEEP_FACT_CLASS], of) != 0) continue;
    if (!abbe_sweep_table_tells(&tables[i], g->number)) continue;
    const abbe_sweep_row *base = find_yardstick(&tables[i]);
    if (base == NULL || !(base->number[ABBE_SWEEP_FRAME_MS] > 0) ||
        !(base->number[ABBE_SWEEP_OWN_DE] > 0))
      return false;
    g->table[g->count] = &tables[i];
    g->base_ms[g->count] = base->number[ABBE_SWEEP_FRAME_MS];
    g->base_error[g->count] = base->number[ABBE_SWEEP_OWN_DE];
    g->mean_ms += log(g->base_ms[g->count]);
    g->mean_error += log(g->base_error[g->count++]);
  }
  g->mean_ms = exp(g->mean_ms / (double)g->count);
  g->mean_error = exp(g->mean_error / (double)g->count);
  return g->count > 0;
}

/* A table's time and error of a setting, as what the class has in common: the tracer's error is
 * measured by its yardstick's, as times are; the renderer's is as it is. False where it does not
 * have both. */
static bool get_common(const group *g, size_t table, const abbe_sweep_setting *setting, double *ms,
                       double *error) {
  const abbe_sweep_row *row = abbe_sweep_table_find(g->table[table], setting);
  if (row == NULL || !(row->number[ABBE_SWEEP_WARM_MS] > 0) || !isfinite(row->number[g->number]))
    return false;
  const bool traced = abbe_sweep_setting_is_traced(setting);
  *ms = row->number[ABBE_SWEEP_WARM_MS] / g->base_ms[table] * g->mean_ms;
  *error = row->number[g->number] * (traced ? g->mean_error / g->base_error[table] : 1);
  return true;
}

/* False where a table does not have the setting whole. */
static bool gather(const group *g, const abbe_sweep_setting *setting, abbe_picture_tool tool,
                   point *out) {
  *out = (point){.setting = setting, .tool = tool, .least = INFINITY};
  if (abbe_picture_tool_of(setting) != tool || setting->share > most_share ||
      abbe_sweep_setting_has_history(setting))
    return false;
  for (size_t i = 0; i < g->count; i++) {
    double ms, error;
    if (!get_common(g, i, setting, &ms, &error)) return false;
    out->ms = fmax(out->ms, ms);
    out->error = fmax(out->error, error);
    out->least = fmin(out->least, error);
  }
  return true;
}

/* What a promise is widened by: the worst that leaving one scene out would have been wrong by. */
typedef struct margins {
  double error, time;
} margins;

static void leave_out(const group *g, size_t table, const point *p, margins *m) {
  double ms = 0, error = 0, own_ms = 0, own_error = 0;
  for (size_t i = 0; i < g->count; i++) {
    double other_ms = 0, other_error = 0;
    get_common(g, i, p->setting, &other_ms, &other_error);
    if (i == table) {
      own_ms = other_ms;
      own_error = other_error;
    } else {
      ms = fmax(ms, other_ms);
      error = fmax(error, other_error);
    }
  }
  if (error > 0) m->error = fmax(m->error, own_error / error);
  m->time = fmax(m->time, own_ms / ms);
}

static void write_point(FILE *out, const point *p) {
  const abbe_sweep_setting *s = p->setting;
  char share[ABBE_NUMBER_TEXT_SIZE];
  fprintf(out, "      - {photons: %zu, ", s->photons);
  if (p->tool == ABBE_PICTURE_RENDER)
    fprintf(out,
            "wavelengths: %zu, map: %zu, samples: %zu, upsample: %zu, fill: %s,\n         exits: "
            "%zu, share: %s, model: %s, ",
            s->wavelengths, s->map, s->samples, s->upsample, s->fill, s->exits,
            abbe_number_text(s->share, share), s->model);
  else
    fprintf(out, "passes: %zu, ", s->passes);
  abbe_number_write(out, "ms: %.1f, error: %.4g, least: %.4g}\n", p->ms, p->error, p->least);
}

/* Memory for the points of one table. */
typedef struct front {
  point *point;
  size_t *order;
  double *cost, *error;
} front;

/* The points of a tool, of which f->order[returned] is the front. */
static size_t find_front(const group *g, abbe_picture_tool tool, front *f) {
  size_t count = 0;
  for (size_t i = 0; i < g->table[0]->count; i++)
    if (gather(g, &g->table[0]->row[i].setting, tool, &f->point[count])) count++;
  for (size_t i = 0; i < count; i++) {
    f->cost[i] = f->point[i].ms;
    f->error[i] = f->point[i].error;
  }
  return abbe_pareto_front_order(f->cost, f->error, count, f->order);
}

static void widen(const group *g, const front *f, size_t on_front, margins *m) {
  for (size_t i = 0; i < g->count && g->count > 1; i++)
    for (size_t k = 0; k < on_front; k++) leave_out(g, i, &f->point[f->order[k]], m);
}

static void write_tool(FILE *out, const group *g, abbe_picture_tool tool, front *f,
                       const margins *widest) {
  margins m = {1, 1};
  const size_t on_front = find_front(g, tool, f);
  widen(g, f, on_front, &m);
  if (g->count < 2) m = *widest;
  if (on_front == 0) return;
  abbe_number_write(out, "    %s:\n      margin: %.4g\n      time_margin: %.4g\n      front:\n",
                    names[tool], m.error, m.time);
  for (size_t i = 0; i < on_front; i++) write_point(out, &f->point[f->order[i]]);
}

/* The widest margins of each tool over the classes that have scenes enough. */
static void find_widest(const abbe_sweep_table *tables, size_t count, group *g, front *f,
                        margins widest[ABBE_PICTURE_TOOL_COUNT]) {
  for (int k = 0; k < ABBE_PICTURE_TOOL_COUNT; k++) widest[k] = (margins){1, 1};
  for (size_t i = 0; i < count; i++) {
    const char *of = tables[i].fact[ABBE_SWEEP_FACT_CLASS];
    size_t first = 0;
    while (strcmp(tables[first].fact[ABBE_SWEEP_FACT_CLASS], of) != 0) first++;
    if (first < i || !fill_group(tables, count, of, g)) continue;
    for (int k = 0; k < ABBE_PICTURE_TOOL_COUNT; k++)
      widen(g, f, find_front(g, (abbe_picture_tool)k, f), &widest[k]);
  }
}

abbe_result abbe_sweep_pictures_write(FILE *out, const abbe_sweep_table *tables, size_t count,
                                      const char *of, abbe_sweep_number number, abbe_error *error) {
  group g = {.number = number};
  margins widest[ABBE_PICTURE_TOOL_COUNT];
  size_t most = 1;
  for (size_t i = 0; i < count; i++) most = tables[i].count > most ? tables[i].count : most;
  g.table = calloc(count + 1, sizeof *g.table);
  g.base_ms = calloc(2 * count + 1, sizeof *g.base_ms);
  g.base_error = g.base_ms != NULL ? g.base_ms + count : NULL;
  front f = {.point = calloc(most, sizeof *f.point),
             .order = calloc(most, sizeof *f.order),
             .cost = calloc(2 * most, sizeof *f.cost)};
  f.error = f.cost != NULL ? f.cost + most : NULL;
  abbe_result result = ABBE_OK;
  if (!g.table || !g.base_ms || !f.point || !f.order || !f.cost) {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the pictures' front");
  } else {
    find_widest(tables, count, &g, &f, widest);
    if (fill_group(tables, count, of, &g)) {
      abbe_number_write(out,
                        "  pictures:\n    base_ms: %.2f\n    base_error: %.4g\n"
                        "    margin_scenes: %zu\n",
                        g.mean_ms, g.mean_error, g.count > 1 ? g.count : 0);
      for (int i = 0; i < ABBE_PICTURE_TOOL_COUNT; i++)
        write_tool(out, &g, (abbe_picture_tool)i, &f, &widest[i]);
    }
  }
  free(g.table);
  free(g.base_ms);
  free(f.point);
  free(f.order);
  free(f.cost);
  return result;
}
