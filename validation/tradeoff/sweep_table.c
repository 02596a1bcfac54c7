#include "validation/tradeoff/sweep_table.h"

#include "base/file.h"
#include "base/number.h"
#include "validation/tradeoff/pareto_front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An error that is not above the reference's own noise by this much shows nothing of settings. */
static const double most_noise = 0.9;

enum { MAX_BYTES = 16 << 20, MAX_CELLS = 64 };

static const char *const number_names[] = {
#define NAME(code, column, text) column,
    ABBE_SWEEP_NUMBERS(NAME)
#undef NAME
};
static const char *const number_texts[] = {
#define TEXT(code, column, text) text,
    ABBE_SWEEP_NUMBERS(TEXT)
#undef TEXT
};
static const char *const fact_names[] = {
#define NAME(code, name) name,
    ABBE_SWEEP_FACTS(NAME)
#undef NAME
};

static const char *const setting_columns[] = {
    "profile", "wavelengths", "photons",  "map",    "samples", "fill",     "exits",
    "share",   "model",       "upsample", "passes", "history", "polygons", "direction"};
enum {
  SETTING_COLUMNS = sizeof setting_columns / sizeof *setting_columns,
  COLUMNS = SETTING_COLUMNS + ABBE_SWEEP_NUMBER_COUNT + 1
};

const char *abbe_sweep_number_name(abbe_sweep_number number) {
  return (unsigned)number < ABBE_SWEEP_NUMBER_COUNT ? number_names[number] : "unknown";
}

const char *abbe_sweep_number_text(abbe_sweep_number number) {
  return (unsigned)number < ABBE_SWEEP_NUMBER_COUNT ? number_texts[number] : "unknown";
}

abbe_sweep_number abbe_sweep_number_find(const char *column) {
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++)
    if (strcmp(column, number_names[i]) == 0) return (abbe_sweep_number)i;
  return ABBE_SWEEP_NUMBER_COUNT;
}

bool abbe_sweep_number_is_error(abbe_sweep_number number) {
  return number >= ABBE_SWEEP_MAP_RMSE && number < ABBE_SWEEP_NUMBER_COUNT &&
         number != ABBE_SWEEP_SCALE && number != ABBE_SWEEP_MAP_ENERGY &&
         strstr(number_names[number], "_noise") == NULL;
}

const abbe_sweep_number abbe_sweep_shown[ABBE_SWEEP_SHOWN] = {
    ABBE_SWEEP_FRAME_MS,     ABBE_SWEEP_WARM_MS,  ABBE_SWEEP_COLD_MS,    ABBE_SWEEP_CAUSTIC_DE,
    ABBE_SWEEP_CAUSTIC_RMSE, ABBE_SWEEP_MAP_RMSE, ABBE_SWEEP_MAP_ENERGY, ABBE_SWEEP_PICTURE_DE};

const char *abbe_sweep_number_short(double value, char out[ABBE_SWEEP_SHORT]) {
  if (!isfinite(value)) return "-";
  abbe_number_format(out, ABBE_SWEEP_SHORT, fabs(value) >= 1000 ? "%.0f" : "%.3g", value);
  return out;
}

const abbe_sweep_number abbe_sweep_times[ABBE_SWEEP_TIMES] = {
    ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_CAMERA_MS, ABBE_SWEEP_WARM_MS, ABBE_SWEEP_COLD_MS};

const char *abbe_sweep_fact_name(abbe_sweep_fact fact) {
  return (unsigned)fact < ABBE_SWEEP_FACT_COUNT ? fact_names[fact] : "unknown";
}

/* Settings */

bool abbe_sweep_setting_is_traced(const abbe_sweep_setting *setting) {
  return strcmp(setting->profile, ABBE_SWEEP_TRACE) == 0 ||
         strcmp(setting->profile, ABBE_SWEEP_TRACE_FILTER) == 0;
}

bool abbe_sweep_setting_has_history(const abbe_sweep_setting *setting) {
  return setting->history > 1;
}

bool abbe_sweep_setting_same(const abbe_sweep_setting *a, const abbe_sweep_setting *b) {
  return strcmp(a->profile, b->profile) == 0 && strcmp(a->fill, b->fill) == 0 &&
         strcmp(a->model, b->model) == 0 && a->wavelengths == b->wavelengths &&
         a->photons == b->photons && a->map == b->map && a->samples == b->samples &&
         a->upsample == b->upsample && a->exits == b->exits && a->share == b->share &&
         a->passes == b->passes && a->history == b->history &&
         strcmp(a->polygons, b->polygons) == 0 && strcmp(a->direction, b->direction) == 0;
}

void abbe_sweep_setting_label(const abbe_sweep_setting *s, char *out, size_t size) {
  bool plain = strcmp(s->profile, "default") == 0;
  char exits[24] = "", share[48] = "", model[24] = "", number[ABBE_NUMBER_TEXT_SIZE];
  char upsample[24] = "", fill[48] = "", history[24] = "";
  if (abbe_sweep_setting_is_traced(s)) {
    snprintf(out, size, "%s %zu x p%zu", s->profile, s->passes, s->photons);
    return;
  }
  if (s->upsample > 1) snprintf(upsample, sizeof upsample, "/%zu", s->upsample);
  if (plain && s->exits < 4) snprintf(exits, sizeof exits, " e%zu", s->exits);
  if (plain && s->share != 0.01)
    snprintf(share, sizeof share, " share %s", abbe_number_text(s->share, number));
  if (plain && strcmp(s->model, "auto") != 0) snprintf(model, sizeof model, " %s", s->model);
  if (strcmp(s->fill, "none") == 0)
    snprintf(fill, sizeof fill, " no fill");
  else if (strncmp(s->profile, "wyman2006", 9) == 0)
    snprintf(fill, sizeof fill, " %s", s->fill);
  if (abbe_sweep_setting_has_history(s)) snprintf(history, sizeof history, " h%zu", s->history);
  snprintf(out, size, "%s%sw%zu p%zu m%zu s%zu%s%s%s%s%s%s%s%s%s%s", plain ? "" : s->profile,
           plain ? "" : " ", s->wavelengths, s->photons, s->map, s->samples, upsample, fill, exits,
           share, model, history, *s->polygons != '\0' ? " " : "", s->polygons,
           *s->direction != '\0' ? " " : "", s->direction);
}

/* The table */

void abbe_sweep_table_free(abbe_sweep_table *table) {
  if (table == NULL) return;
  free(table->row);
  *table = (abbe_sweep_table){0};
}

void abbe_sweep_table_set(abbe_sweep_table *table, abbe_sweep_fact fact, const char *text) {
  char *out = table->fact[fact];
  snprintf(out, sizeof table->fact[fact], "%s", text);
  for (; *out != '\0'; out++)
    if ((unsigned char)*out < ' ') *out = ' ';
}

const abbe_sweep_row *abbe_sweep_table_find(const abbe_sweep_table *table,
                                            const abbe_sweep_setting *setting) {
  for (size_t i = 0; i < table->count; i++)
    if (abbe_sweep_setting_same(&table->row[i].setting, setting)) return &table->row[i];
  return NULL;
}

abbe_result abbe_sweep_table_add(abbe_sweep_table *table, const abbe_sweep_row *row,
                                 abbe_error *error) {
  if (abbe_sweep_table_find(table, &row->setting) != NULL) {
    char text[64];
    abbe_sweep_setting_label(&row->setting, text, sizeof text);
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the setting '%s' is there twice", text);
  }
  if (table->count == ABBE_SWEEP_MAX_ROWS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a sweep holds at most %d settings",
                          ABBE_SWEEP_MAX_ROWS);
  if (table->count == table->room) {
    size_t room = table->room == 0 ? 32 : 2 * table->room;
    abbe_sweep_row *more = realloc(table->row, room * sizeof *more);
    if (more == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the sweep");
    table->row = more;
    table->room = room;
  }
  table->row[table->count++] = *row;
  return ABBE_OK;
}

bool abbe_sweep_table_tells(const abbe_sweep_table *table, abbe_sweep_number number) {
  for (size_t i = 0; i < table->count; i++) {
    const abbe_sweep_row *row = &table->row[i];
    if (strcmp(row->setting.profile, "default") != 0) continue;
    if (row->number[number + 1] > most_noise * row->number[number]) return false;
  }
  return true;
}

static int compare_numbers(const void *a, const void *b) {
  const double *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

double abbe_sweep_table_unrest(const abbe_sweep_table *table) {
  double *unrest = calloc(table->count + 1, sizeof *unrest), result = 0;
  size_t known = 0;
  for (size_t i = 0; unrest != NULL && i < table->count; i++) {
    const double *n = table->row[i].number;
    double over = n[ABBE_SWEEP_FRAME_MS] / n[ABBE_SWEEP_FASTEST_MS] - 1;
    if (isfinite(over) && over > 0) unrest[known++] = over;
  }
  if (known > 0) {
    qsort(unrest, known, sizeof *unrest, compare_numbers);
    result = unrest[known / 2];
  }
  free(unrest);
  return result;
}

abbe_result abbe_sweep_table_mark(abbe_sweep_table *table, abbe_sweep_number time,
                                  abbe_sweep_number number, const char *profile,
                                  abbe_error *error) {
  size_t count = table->count;
  double *cost = calloc(2 * count + 1, sizeof *cost);
  bool *on = calloc(count + 1, sizeof *on);
  if (cost == NULL || on == NULL) {
    free(cost);
    free(on);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the sweep's front");
  }
  for (size_t i = 0; i < count; i++) {
    const abbe_sweep_row *row = &table->row[i];
    bool counts = !abbe_sweep_setting_has_history(&row->setting) &&
                  (profile == NULL || strcmp(profile, row->setting.profile) == 0);
    cost[i] = counts ? row->number[time] : NAN;
    cost[count + i] = row->number[number];
  }
  abbe_pareto_front_mark(cost, cost + count, count, on);
  for (size_t i = 0; i < count; i++) table->row[i].front = on[i];
  free(cost);
  free(on);
  return ABBE_OK;
}

size_t *abbe_sweep_table_front(const abbe_sweep_table *table, abbe_sweep_number time,
                               size_t *out_count) {
  size_t count = 0;
  size_t *order = calloc(table->count + 1, sizeof *order);
  for (size_t i = 0; order != NULL && i < table->count; i++) {
    if (!table->row[i].front) continue;
    size_t at = count++;
    double ms = table->row[i].number[time];
    for (; at > 0 && table->row[order[at - 1]].number[time] > ms; at--) order[at] = order[at - 1];
    order[at] = i;
  }
  *out_count = count;
  return order;
}

abbe_result abbe_sweep_table_agree(const abbe_sweep_table *a, const char *name,
                                   const abbe_sweep_table *b, abbe_error *error) {
  static const abbe_sweep_fact must[] = {ABBE_SWEEP_FACT_PROGRAM, ABBE_SWEEP_FACT_SCENE_HASH,
                                         ABBE_SWEEP_FACT_SIZE,    ABBE_SWEEP_FACT_REFERENCE_HASH,
                                         ABBE_SWEEP_FACT_MODEL,   ABBE_SWEEP_FACT_DEVICE,
                                         ABBE_SWEEP_FACT_MACHINE};
  for (size_t i = 0; i < sizeof must / sizeof *must; i++) {
    if (strcmp(a->fact[must[i]], b->fact[must[i]]) == 0) continue;
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its rows were measured with the %s '%.200s', and now it is "
                          "'%.200s'; they do not compare, so give another file or remove it",
                          name, fact_names[must[i]], a->fact[must[i]], b->fact[must[i]]);
  }
  return ABBE_OK;
}

/* An error that says which table it is of. */
static abbe_result add_rows(const abbe_sweep_table *from, const char *name, abbe_sweep_table *to,
                            abbe_error *error) {
  for (size_t i = 0; i < from->count; i++) {
    abbe_error own = {0};
    const abbe_result result = abbe_sweep_table_add(to, &from->row[i], &own);
    if (result != ABBE_OK) return abbe_error_set(error, result, "%s: %s", name, own.text);
  }
  return ABBE_OK;
}

abbe_result abbe_sweep_table_join(const abbe_sweep_table *tables, const char *const *names,
                                  size_t count, abbe_sweep_table *out, abbe_error *error) {
  *out = (abbe_sweep_table){0};
  if (count == 0) return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no tables to join");
  memcpy(out->fact, tables[0].fact, sizeof out->fact);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    result = abbe_sweep_table_agree(&tables[i], names[i], &tables[0], error);
    if (result == ABBE_OK) result = add_rows(&tables[i], names[i], out, error);
  }
  if (result != ABBE_OK) abbe_sweep_table_free(out);
  return result;
}

/* What the model leaves out */

static const char *const model_form = "caustic_de %lg (%lg), map_rmse %lg (%lg), map_energy %lg";

void abbe_sweep_model_write(const abbe_sweep_model *m, abbe_sweep_table *table) {
  const double value[] = {m->de, m->de_noise, m->map, m->map_noise, m->energy};
  char number[5][ABBE_NUMBER_TEXT_SIZE], text[200];
  for (int i = 0; i < 5; i++) abbe_number_text(value[i], number[i]);
  snprintf(text, sizeof text, "caustic_de %s (%s), map_rmse %s (%s), map_energy %s", number[0],
           number[1], number[2], number[3], number[4]);
  abbe_sweep_table_set(table, ABBE_SWEEP_FACT_MODEL, text);
}

bool abbe_sweep_model_read(const abbe_sweep_table *table, abbe_sweep_model *out) {
  abbe_sweep_model m;
  locale_t host = abbe_number_enter();
  const int read = sscanf(table->fact[ABBE_SWEEP_FACT_MODEL], model_form, &m.de, &m.de_noise,
                          &m.map, &m.map_noise, &m.energy);
  abbe_number_leave(host);
  if (read != 5) return false;
  *out = m;
  return true;
}

/* Writing */

static void write_row(FILE *to, const abbe_sweep_row *row) {
  const abbe_sweep_setting *s = &row->setting;
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, "%s,%zu,%zu,%zu,%zu,%s,%zu,%s,%s,%zu,%zu,%zu,%s,%s", s->profile, s->wavelengths,
          s->photons, s->map, s->samples, s->fill, s->exits, abbe_number_text(s->share, text),
          s->model, s->upsample, s->passes, s->history, s->polygons, s->direction);
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) {
    bool known = isfinite(row->number[i]);
    fprintf(to, ",%s", known ? abbe_number_text(row->number[i], text) : "");
  }
  fprintf(to, ",%s\n", row->front ? "yes" : "");
}

abbe_result abbe_sweep_table_save(const abbe_sweep_table *table, const char *path,
                                  abbe_error *error) {
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  for (int i = 0; i < ABBE_SWEEP_FACT_COUNT; i++)
    if (table->fact[i][0] != '\0')
      fprintf(writer.stream, "# %s: %s\n", fact_names[i], table->fact[i]);
  for (size_t i = 0; i < SETTING_COLUMNS; i++) fprintf(writer.stream, "%s,", setting_columns[i]);
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) fprintf(writer.stream, "%s,", number_names[i]);
  fprintf(writer.stream, "front\n");
  for (size_t i = 0; i < table->count; i++) write_row(writer.stream, &table->row[i]);
  return abbe_file_writer_commit(&writer, error);
}

/* Reading */

typedef struct reader {
  const char *name;
  size_t line;
  char *cell[MAX_CELLS];
  size_t cells;
} reader;

static size_t split(char *line, char **cell) {
  size_t count = 0;
  for (char *at = line; at != NULL && count < MAX_CELLS; count++) {
    cell[count] = at;
    at = strchr(at, ',');
    if (at != NULL) *at++ = '\0';
  }
  return count;
}

static const char *column_name(size_t column) {
  if (column < SETTING_COLUMNS) return setting_columns[column];
  column -= SETTING_COLUMNS;
  return column < ABBE_SWEEP_NUMBER_COUNT ? number_names[column] : "front";
}

static abbe_result check_header(const reader *r, abbe_error *error) {
  for (size_t i = 0; i < COLUMNS || i < r->cells; i++) {
    const char *is = i < r->cells ? r->cell[i] : "", *right = i < COLUMNS ? column_name(i) : "";
    if (strcmp(is, right) != 0)
      return abbe_error_set(error, ABBE_PARSE,
                            "%s:%zu: column %zu is '%.40s' where a sweep has '%s'; it is no table "
                            "of this version's 'abbe sweep'",
                            r->name, r->line, i + 1, is, right);
  }
  return ABBE_OK;
}

static abbe_result wrong(const reader *r, size_t column, const char *right, abbe_error *error) {
  return abbe_error_set(error, ABBE_PARSE, "%s:%zu: %s '%.40s' is not %s", r->name, r->line,
                        column_name(column), r->cell[column], right);
}

static abbe_result read_number(const reader *r, size_t column, double *out, abbe_error *error) {
  const char *text = r->cell[column], *end;
  *out = NAN;
  if (*text == '\0') return ABBE_OK;
  if (!abbe_number_read(text, &end, out) || *end != '\0' || !isfinite(*out))
    return wrong(r, column, "a number", error);
  return ABBE_OK;
}

static abbe_result read_count(const reader *r, size_t column, size_t *out, abbe_error *error) {
  double value;
  abbe_result result = read_number(r, column, &value, error);
  if (result != ABBE_OK) return result;
  if (!(value >= 0 && value <= 1e9) || value != floor(value))
    return wrong(r, column, "a whole number from 0 to 1e9", error);
  *out = (size_t)value;
  return ABBE_OK;
}

/* One that is long enough for several words may be empty. */
static abbe_result read_text(const reader *r, size_t column, size_t size, char *out,
                             abbe_error *error) {
  const size_t length = strlen(r->cell[column]), least = size == ABBE_SWEEP_WORD;
  char wanted[48];
  snprintf(wanted, sizeof wanted, "a word of %zu to %zu letters", least, size - 1);
  if (length < least || length >= size) return wrong(r, column, wanted, error);
  memcpy(out, r->cell[column], length + 1);
  return ABBE_OK;
}

static abbe_result read_row(const reader *r, abbe_sweep_row *row, abbe_error *error) {
  abbe_sweep_setting *s = &row->setting;
  *row = (abbe_sweep_row){0};
  if (r->cells != COLUMNS)
    return abbe_error_set(error, ABBE_PARSE, "%s:%zu: the row has %zu cells, not %d", r->name,
                          r->line, r->cells, (int)COLUMNS);
  size_t *const counts[] = {NULL,       &s->wavelengths, &s->photons, &s->map, &s->samples,
                            NULL,       &s->exits,       NULL,        NULL,    &s->upsample,
                            &s->passes, &s->history,     NULL,        NULL};
  abbe_result result = read_text(r, 0, sizeof s->profile, s->profile, error);
  if (result == ABBE_OK) result = read_text(r, 5, sizeof s->fill, s->fill, error);
  if (result == ABBE_OK) result = read_text(r, 8, sizeof s->model, s->model, error);
  if (result == ABBE_OK) result = read_text(r, 12, sizeof s->polygons, s->polygons, error);
  if (result == ABBE_OK) result = read_text(r, 13, sizeof s->direction, s->direction, error);
  if (result == ABBE_OK) result = read_number(r, 7, &s->share, error);
  if (result == ABBE_OK && !(s->share > 0)) result = wrong(r, 7, "a share above 0", error);
  for (size_t i = 0; i < SETTING_COLUMNS && result == ABBE_OK; i++)
    if (counts[i] != NULL) result = read_count(r, i, counts[i], error);
  for (size_t i = 0; i < ABBE_SWEEP_NUMBER_COUNT && result == ABBE_OK; i++)
    result = read_number(r, SETTING_COLUMNS + i, &row->number[i], error);
  row->front = strcmp(r->cell[COLUMNS - 1], "yes") == 0;
  return result;
}

static void read_fact(const char *line, abbe_sweep_table *table) {
  const char *colon = strstr(line, ": ");
  if (strncmp(line, "# ", 2) != 0 || colon == NULL) return;
  size_t length = (size_t)(colon - line) - 2;
  for (int i = 0; i < ABBE_SWEEP_FACT_COUNT; i++)
    if (strlen(fact_names[i]) == length && strncmp(line + 2, fact_names[i], length) == 0)
      abbe_sweep_table_set(table, (abbe_sweep_fact)i, colon + 2);
}

static abbe_result read_line(reader *r, char *line, bool *header, abbe_sweep_table *out,
                             abbe_error *error) {
  size_t length = strlen(line);
  if (length > 0 && line[length - 1] == '\r') line[length - 1] = '\0';
  if (line[0] == '\0') return ABBE_OK;
  if (line[0] == '#') return read_fact(line, out), ABBE_OK;
  r->cells = split(line, r->cell);
  if (!*header) {
    *header = true;
    return check_header(r, error);
  }
  abbe_sweep_row row;
  abbe_error why = {0};
  abbe_result result = read_row(r, &row, error);
  if (result == ABBE_OK && abbe_sweep_table_add(out, &row, &why) != ABBE_OK)
    result = abbe_error_set(error, why.code == ABBE_NO_MEMORY ? why.code : ABBE_PARSE,
                            "%s:%zu: %.300s", r->name, r->line, why.text);
  return result;
}

abbe_result abbe_sweep_table_parse(const char *text, size_t size, const char *name,
                                   abbe_sweep_table *out, abbe_error *error) {
  reader r = {.name = name};
  bool header = false;
  *out = (abbe_sweep_table){0};
  char *copy = malloc(size + 1);
  if (copy == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to read it", name);
  memcpy(copy, text, size);
  copy[size] = '\0';
  abbe_result result = ABBE_OK;
  if (strlen(copy) != size)
    result = abbe_error_set(error, ABBE_PARSE, "%s: it holds a zero byte; it is no text", name);
  for (char *line = copy; line != NULL && result == ABBE_OK;) {
    char *end = strchr(line, '\n');
    if (end != NULL) *end = '\0';
    r.line++;
    result = read_line(&r, line, &header, out, error);
    line = end != NULL ? end + 1 : NULL;
  }
  if (result == ABBE_OK && !header)
    result = abbe_error_set(error, ABBE_PARSE, "%s: it has no line of column names", name);
  free(copy);
  if (result != ABBE_OK) abbe_sweep_table_free(out);
  return result;
}

abbe_result abbe_sweep_table_load(const char *path, abbe_sweep_table *out, abbe_error *error) {
  char *text = NULL;
  size_t size = 0;
  *out = (abbe_sweep_table){0};
  abbe_result result = abbe_file_read_text(path, MAX_BYTES, &text, &size, error);
  if (result == ABBE_OK) result = abbe_sweep_table_parse(text, size, path, out, error);
  free(text);
  return result;
}
