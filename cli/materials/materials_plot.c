#include "cli/materials/materials.h"

#include "colorimetry/plot/chart.h"
#include "colorimetry/plot/material_chart.h"
#include "spectral/formats/material_import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CURVE = 801 };

/* The numbers of the picture, in one piece of memory. */
typedef struct figures {
  double *memory;
  double *x, *n, *off, *low, *high; /* [count]: the points, and their residuals' error bars */
  double *curve_x, *curve_n;        /* [CURVE] */
  size_t count;
} figures;

static abbe_result open_figures(const abbe_index_points *points, const abbe_fit *fit, figures *f,
                                abbe_error *error) {
  size_t all = points->count;
  *f = (figures){.memory = calloc(5 * all + 2 * (size_t)CURVE, sizeof(double))};
  if (f->memory == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a picture");
  f->x = f->memory;
  f->n = f->x + all;
  f->off = f->n + all;
  f->low = f->off + all;
  f->high = f->low + all;
  f->curve_x = f->high + all;
  f->curve_n = f->curve_x + CURVE;
  for (size_t i = 0; i < all; i++) {
    double lambda_nm = points->lambda_nm[i];
    if (lambda_nm < fit->min_nm || lambda_nm > fit->max_nm) continue;
    size_t k = f->count++;
    double bar = points->uncertainty != NULL ? points->uncertainty[i] : 0;
    f->x[k] = lambda_nm;
    f->n[k] = points->n[i];
    f->off[k] = points->n[i] - abbe_dispersion_n(&fit->dispersion, lambda_nm);
    f->low[k] = f->off[k] - bar;
    f->high[k] = f->off[k] + bar;
  }
  for (int i = 0; i < CURVE; i++) {
    f->curve_x[i] = fit->min_nm + (fit->max_nm - fit->min_nm) * i / (CURVE - 1);
    f->curve_n[i] = abbe_dispersion_n(&fit->dispersion, f->curve_x[i]);
  }
  return ABBE_OK;
}

abbe_result abbe_materials_fit_plot(const char *path, const char *of,
                                    const abbe_index_points *points, const abbe_fit *fit,
                                    abbe_error *error) {
  figures f;
  char title[400];
  ABBE_TRY(open_figures(points, fit, &f, error));
  abbe_chart_style style = points->exact ? ABBE_CHART_LINE : ABBE_CHART_POINTS;
  bool bars = points->uncertainty != NULL;
  snprintf(title, sizeof title, "%s form of %zu coefficients, fitted to %s: rms %.2g, largest %.2g",
           abbe_dispersion_model_name(fit->dispersion.model), fit->free, of, fit->rms,
           fit->max_error);
  const double ends[] = {fit->min_nm, fit->max_nm}, zero[] = {0, 0};
  const abbe_chart_series above[] = {
      {.label = of, .style = style, .count = f.count, .x = f.x, .y = f.n, .colour = 1},
      {.label = "fit",
       .style = ABBE_CHART_DASHED,
       .count = CURVE,
       .x = f.curve_x,
       .y = f.curve_n,
       .colour = 2}};
  const abbe_chart_series below[] = {
      {.style = style,
       .count = f.count,
       .x = f.x,
       .y = f.off,
       .low = bars ? f.low : NULL,
       .high = bars ? f.high : NULL,
       .colour = 1},
      {.style = ABBE_CHART_DASHED, .count = 2, .x = ends, .y = zero, .colour = 2}};
  const abbe_chart charts[] = {
      {.title = title, .y = {.label = "n"}, .series_count = 2, .series = above, .share = 1.6},
      {.x = {.label = "wavelength, nm"},
       .y = {.label = "n - fit"},
       .series_count = 2,
       .series = below}};
  abbe_result result = abbe_chart_write(path, charts, 2, 0, 0, error);
  free(f.memory);
  return result;
}

enum { MAX_TABLES = ABBE_MATERIAL_MAP_MAX_TABLES, MAX_NAMES = ABBE_MATERIAL_CHART_MAX };
enum { KEY_TABLE = ABBE_MATERIALS_KEY_OWN, KEY_SIZE };

typedef struct request {
  const char *program, *out, *points;
  const char *table[MAX_TABLES], *name[MAX_NAMES];
  size_t table_count, name_count, width, height;
  double from, to;
  bool map, fits;
} request;

static const abbe_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES, "the picture; .png or .svg", 0,
     ABBE_TAKE_TEXT(request, out)},
    {"table", KEY_TABLE, "FILE", ABBE_ARGUMENT_READS | ABBE_ARGUMENT_REPEATS,
     "a table file, or default or thesis; without it, default. May be repeated: names are looked "
     "up in all, the map shows each in a colour of its own",
     0, ABBE_TAKE_BY_KEY},
    {"map", 0, NULL, 0, "n_d over V_d of all materials; NAMEs are marked", 0,
     ABBE_TAKE_FLAG(request, map)},
    {"range", 0, "FROM:TO", 0, "wavelengths, nm; without it, 380:780", 0,
     ABBE_TAKE_RANGE(request, from, to)},
    {"fits", 0, NULL, 0, "the recorded fits too, and their residuals below", 0,
     ABBE_TAKE_FLAG(request, fits)},
    {"points", 0, "FILE.csv", ABBE_ARGUMENT_READS,
     "measured points too (wavelength, n, uncertainty), and below them how far the first NAME is "
     "from them",
     0, ABBE_TAKE_TEXT(request, points)},
    {"size", KEY_SIZE, "WxH", 0, "of the picture; without it, 960x600", 0, ABBE_TAKE_BY_KEY},
    {0}};

static void read_size(request *r, const char *text) {
  char rest;
  if (sscanf(text, "%5zux%5zu%c", &r->width, &r->height, &rest) == 2 && r->width > 0 &&
      r->height > 0 && text[0] != '-' && strstr(text, "x-") == NULL)
    return;
  char sentence[120];
  snprintf(sentence, sizeof sentence,
           "--size '%.40s' is not WIDTHxHEIGHT in pixels, such as 960x600", text);
  abbe_materials_wrong_use(r->program, sentence);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case KEY_TABLE:
    if (r->table_count == MAX_TABLES) argp_error(state, "more than %d tables", MAX_TABLES);
    r->table[r->table_count++] = arg;
    return 0;
  case KEY_SIZE:
    read_size(r, arg);
    return 0;
  case ARGP_KEY_ARG:
    if (r->name_count == MAX_NAMES) argp_error(state, "more than %d materials", MAX_NAMES);
    r->name[r->name_count++] = arg;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "NAME… -o FILE\n--map [NAME…] -o FILE",
    .doc = "Draws the index of materials over wavelength, or the map of glasses.\v"
           "Examples:\n"
           "  abbe materials plot n-bk7 f2 sf11 -o glasses.png\n"
           "  abbe materials plot diamond --range 230:1000 -o diamond.svg\n"
           "  abbe materials plot n-bk7 --fits -o fits.png\n"
           "  abbe materials plot k5 --table my.yaml --points measured.csv -o k5.png\n"
           "  abbe materials plot --map n-bk7 --table default --table my.yaml -o map.png\n\n"
           "A curve is drawn through where its data reach, dashed where its record allows it to be "
           "continued, and not at all beyond.",
};

static const char *wrong(const request *r) {
  if (!r->map && r->name_count == 0)
    return "plot what? Name materials, or say --map; 'abbe materials list' has the names";
  if (r->out == NULL) return "where to? Give the picture's name with -o FILE.png or FILE.svg";
  if (r->map && (r->fits || r->points != NULL || r->to > 0))
    return "--map goes without --fits, --points and --range";
  return NULL;
}

/* ---- what is drawn ---- */

/* The name in the first table that has it; the complaint is the first table's. */
static abbe_result find(const abbe_material_table *table, size_t count, const char *name,
                        const abbe_material **out, abbe_error *error) {
  for (size_t i = 1; i < count; i++)
    if (abbe_material_table_find(&table[0], name, out, NULL) != ABBE_OK &&
        abbe_material_table_find(&table[i], name, out, NULL) == ABBE_OK)
      return ABBE_OK;
  return abbe_material_table_find(&table[0], name, out, error);
}

static abbe_result draw_map(const request *r, const abbe_material_table *table, size_t count,
                            const abbe_material **named, abbe_error *error) {
  const abbe_material_table *tables[MAX_TABLES];
  for (size_t i = 0; i < count; i++) tables[i] = &table[i];
  abbe_material_map map = {.table_count = count,
                           .table = tables,
                           .marked_count = r->name_count,
                           .marked = named,
                           .width = r->width,
                           .height = r->height};
  size_t left_out = 0;
  ABBE_TRY(abbe_material_map_write(r->out, &map, &left_out, error));
  if (left_out > 0)
    fprintf(stderr, "%s: left out %zu without n_d and a finite V_d in their range\n", r->program,
            left_out);
  return ABBE_OK;
}

static abbe_result draw_curves(const request *r, const abbe_material **named, abbe_error *error) {
  ABBE_OWNED(abbe_index_points, points) = {0};
  if (r->points != NULL) ABBE_TRY(abbe_index_points_load(r->points, &points, error));
  abbe_material_chart chart = {.count = r->name_count,
                               .material = named,
                               .min_nm = r->from,
                               .max_nm = r->to,
                               .fits = r->fits,
                               .points = r->points != NULL ? &points : NULL,
                               .width = r->width,
                               .height = r->height};
  return abbe_material_chart_write(r->out, &chart, error);
}

int abbe_materials_plot(int argc, char **argv) {
  request r = {.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  if (wrong(&r) != NULL) abbe_materials_wrong_use(argv[0], wrong(&r));
  if (r.table_count == 0) r.table[r.table_count++] = "default";
  abbe_material_table table[MAX_TABLES] = {{0}};
  const abbe_material *named[MAX_NAMES];
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r.table_count && result == ABBE_OK; i++)
    result =
        r.map ? abbe_material_table_load(r.table[i], &table[i], &error)
              : abbe_material_table_load_named(r.table[i], r.name, r.name_count, &table[i], &error);
  for (size_t i = 0; i < r.name_count && result == ABBE_OK; i++)
    result = find(table, r.table_count, r.name[i], &named[i], &error);
  if (result == ABBE_OK)
    result =
        r.map ? draw_map(&r, table, r.table_count, named, &error) : draw_curves(&r, named, &error);
  for (size_t i = 0; i < r.table_count; i++) abbe_material_table_free(&table[i]);
  return abbe_command_end(r.program, result, &error);
}
