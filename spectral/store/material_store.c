#include "spectral/store/material_store.h"

#include "base/text.h"
#include "spectral/materials/absorption.h"
#include "spectral/store/material_store_columns.h"

#include <fcntl.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_ROW = 4 << 20 };

#define NAMED(name, type) ", " #name
#define SELECT "SELECT id" ABBE_STORE_COLUMNS(NAMED) " FROM materials"

/* ---- whether it is one ---- */

bool abbe_material_store_is(const char *path) {
  static const char magic[16] = "SQLite format 3"; /* with its zero */
  char head[sizeof magic];
  struct stat status;
  int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a pipe is opened without waiting */
  if (fd < 0) return false;
  bool found = fstat(fd, &status) == 0 && S_ISREG(status.st_mode) &&
               pread(fd, head, sizeof head, 0) == (ssize_t)sizeof head &&
               memcmp(head, magic, sizeof magic) == 0;
  close(fd);
  return found;
}

/* ---- reading ---- */

typedef struct reader {
  sqlite3 *db;
  sqlite3_stmt *q;
  const char *path;
  const char *const *names; /* [count]; NULL: all rows */
  size_t count;
  bool names_only;
  abbe_report *unread; /* NULL: a row that cannot be read is an error */
  abbe_material_table *out;
  abbe_material *material; /* the row */
  abbe_error *error;       /* what is wrong with it */
} reader;

static abbe_result damaged(reader *r, abbe_store_column column, const char *what) {
  static const char *const names[] = {
#define NAMED_AS(name, type) #name,
      ABBE_STORE_COLUMNS(NAMED_AS)
#undef NAMED_AS
  };
  return abbe_error_set(r->error, ABBE_SCHEMA, "'%s' %s", names[column], what);
}

static abbe_result no_memory(reader *r) {
  return abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for a material");
}

static double get_double(const unsigned char *from) {
  uint64_t bits = 0;
  double value;
  for (int i = 0; i < 8; i++) bits |= (uint64_t)from[i] << (8 * i);
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* Whole UTF-8 without a zero. */
static bool is_text(const char *text, int size) {
  if (strlen(text) != (size_t)size) return false;
  while (*text != '\0') {
    size_t length = abbe_utf8_letter(text);
    if (length == 0) return false;
    text += length;
  }
  return true;
}

static abbe_result read_text(reader *r, abbe_store_column column, char **out) {
  int type = sqlite3_column_type(r->q, column + 1);
  if (type == SQLITE_NULL) return ABBE_OK;
  if (type != SQLITE_TEXT) return damaged(r, column, "is no text");
  const char *text = (const char *)sqlite3_column_text(r->q, column + 1);
  if (text == NULL) return no_memory(r);
  if (!is_text(text, sqlite3_column_bytes(r->q, column + 1)))
    return damaged(r, column, "is no whole text");
  *out = strdup(text);
  return *out != NULL ? ABBE_OK : no_memory(r);
}

/* Reads one of names[count]; *out stays as it is where the row has none. */
static abbe_result read_word(reader *r, abbe_store_column column, const char *(*name)(int),
                             int count, int *out) {
  char *text = NULL;
  abbe_result result = read_text(r, column, &text);
  int found = -1;
  for (int i = 0; i < count && text != NULL; i++)
    if (strcmp(text, name(i)) == 0) found = i;
  if (result == ABBE_OK && text != NULL && found < 0) result = damaged(r, column, "is not known");
  if (found >= 0) *out = found;
  free(text);
  return result;
}

static abbe_result read_number(reader *r, abbe_store_column column, double min, double max,
                               double *out) {
  int type = sqlite3_column_type(r->q, column + 1);
  if (type == SQLITE_NULL) return ABBE_OK;
  if (type != SQLITE_FLOAT && type != SQLITE_INTEGER) return damaged(r, column, "is no number");
  double value = sqlite3_column_double(r->q, column + 1);
  if (!(value >= min && value <= max)) return damaged(r, column, "is out of its range");
  *out = value;
  return ABBE_OK;
}

/* The doubles of a list; NULL and 0 where there is none. They are not aligned. */
static abbe_result read_bytes(reader *r, abbe_store_column column, size_t group,
                              const unsigned char **out, size_t *count) {
  int type = sqlite3_column_type(r->q, column + 1);
  *out = NULL;
  *count = 0;
  if (type == SQLITE_NULL) return ABBE_OK;
  if (type != SQLITE_BLOB) return damaged(r, column, "is no list of numbers");
  *out = sqlite3_column_blob(r->q, column + 1);
  size_t size = (size_t)sqlite3_column_bytes(r->q, column + 1);
  if (size == 0 || size % (8 * group) != 0) return damaged(r, column, "is not whole");
  *count = size / (8 * group);
  return *out != NULL ? ABBE_OK : no_memory(r);
}

/* min to max numbers, all finite, in [-most, most]; *count stays 0 where there are none. */
static abbe_result read_numbers(reader *r, abbe_store_column column, size_t min, size_t max,
                                double most, double *out, size_t *count) {
  const unsigned char *bytes;
  ABBE_TRY(read_bytes(r, column, 1, &bytes, count));
  if (*count == 0) return ABBE_OK;
  if (*count < min || *count > max) return damaged(r, column, "has another length");
  for (size_t i = 0; i < *count; i++) {
    out[i] = get_double(bytes + 8 * i);
    if (!(fabs(out[i]) <= most)) return damaged(r, column, "holds a number out of its range");
  }
  return ABBE_OK;
}

static const char *interpolation_name(int index) {
  return abbe_interpolation_name((abbe_interpolation)index);
}

static const char *model_name(int index) {
  return abbe_dispersion_model_name((abbe_dispersion_model)index);
}

static abbe_result read_spectrum(reader *r, abbe_store_column column,
                                 abbe_store_column interpolation, double min, double max,
                                 abbe_spectrum **out) {
  const unsigned char *bytes;
  size_t count;
  int kind = ABBE_INTERPOLATION_LINEAR;
  ABBE_TRY(read_bytes(r, column, 2, &bytes, &count));
  ABBE_TRY(read_word(r, interpolation, interpolation_name, 3, &kind));
  if (count == 0) return ABBE_OK;
  if (count > ABBE_SPECTRUM_MAX_COUNT) return damaged(r, column, "has too many points");
  ABBE_FREED double *lambda_nm = malloc(count * sizeof *lambda_nm),
                    *value = malloc(count * sizeof *value);
  if (lambda_nm == NULL || value == NULL) ABBE_TRY(no_memory(r));
  for (size_t i = 0; i < count; i++) {
    lambda_nm[i] = get_double(bytes + 16 * i);
    value[i] = get_double(bytes + 16 * i + 8);
    if (!(lambda_nm[i] >= ABBE_SPECTRUM_LOW_NM && lambda_nm[i] <= ABBE_SPECTRUM_HIGH_NM &&
          value[i] >= min && value[i] <= max))
      ABBE_TRY(damaged(r, column, "holds a number out of its range"));
  }
  abbe_error why;
  return abbe_spectrum_make(lambda_nm, value, count, (abbe_interpolation)kind, out, &why) == ABBE_OK
             ? ABBE_OK
         : why.code == ABBE_NO_MEMORY ? no_memory(r)
                                      : damaged(r, column, "does not ascend");
}

static abbe_result read_conductor(reader *r, abbe_dispersion *out) {
  const unsigned char *bytes;
  size_t count;
  abbe_error why = {0};
  abbe_result result = read_bytes(r, ABBE_STORE_points, 3, &bytes, &count);
  if (result != ABBE_OK || count == 0) return result;
  double *column = malloc(3 * count * sizeof *column);
  if (column == NULL) return no_memory(r);
  for (size_t i = 0; i < 3 * count; i++) column[i % 3 * count + i / 3] = get_double(bytes + 8 * i);
  bool inside = column[0] >= ABBE_SPECTRUM_LOW_NM && column[count - 1] <= ABBE_SPECTRUM_HIGH_NM;
  result = inside
               ? abbe_conductor_make(column, column + count, column + 2 * count, count, out, &why)
               : ABBE_INVALID_ARGUMENT;
  free(column);
  if (result == ABBE_OK || result == ABBE_NO_MEMORY)
    return result == ABBE_OK ? ABBE_OK : no_memory(r);
  return damaged(r, ABBE_STORE_points, "cannot be those of a conductor");
}

static abbe_result read_fit(reader *r, abbe_store_column column, size_t terms,
                            abbe_material_fit *out) {
  double value[ABBE_STORE_MAX_TERMS + 3];
  size_t count;
  ABBE_TRY(read_numbers(r, column, terms + 3, terms + 3, 1e12, value, &count));
  if (count == 0) return ABBE_OK;
  *out = (abbe_material_fit){.terms = terms,
                             .max_error = value[terms],
                             .min_nm = value[terms + 1],
                             .max_nm = value[terms + 2]};
  memcpy(out->c, value, terms * sizeof *value);
  bool ascends = out->min_nm >= ABBE_SPECTRUM_LOW_NM && out->min_nm < out->max_nm &&
                 out->max_nm <= ABBE_SPECTRUM_HIGH_NM;
  return ascends && out->max_error >= 0 ? ABBE_OK : damaged(r, column, "has no range");
}

static abbe_result read_catalogue(reader *r) {
  abbe_material_catalogue *c = &r->material->catalogue;
  const double most = ABBE_MATERIAL_CATALOGUE_MOST, dpgf = ABBE_MATERIAL_DPGF_MOST;
  double expansion[6] = {0}; /* the two, and their ranges */
  size_t count;
  ABBE_TRY(read_text(r, ABBE_STORE_code, &c->code));
  ABBE_TRY(read_text(r, ABBE_STORE_status, &c->status));
  ABBE_TRY(
      read_number(r, ABBE_STORE_melt_frequency, 0, ABBE_MATERIAL_MELT_MOST, &c->melt_frequency));
  ABBE_TRY(
      read_number(r, ABBE_STORE_density_g_cm3, 0, ABBE_MATERIAL_DENSITY_MOST, &c->density_g_cm3));
  ABBE_TRY(read_numbers(r, ABBE_STORE_expansion_per_k, 2, 6, most, expansion, &count));
  memcpy(c->expansion_per_k, expansion, sizeof c->expansion_per_k);
  memcpy(c->expansion_range_k, expansion + 2, sizeof c->expansion_range_k);
  ABBE_TRY(read_number(r, ABBE_STORE_dpgf, -dpgf, dpgf, &c->dpgf));
  ABBE_TRY(read_numbers(r, ABBE_STORE_thermal, 6, 6, most, c->thermal, &count));
  return read_numbers(r, ABBE_STORE_ratings, 6, 6, most, c->ratings, &c->rating_count);
}

/* An index: its model, numbers, how its points are joined, and those. */
static abbe_result read_index(reader *r, const abbe_store_column column[4], abbe_dispersion *d) {
  int model = -1;
  ABBE_TRY(read_word(r, column[0], model_name, ABBE_DISPERSION_MODEL_COUNT, &model));
  if (model < 0) return ABBE_OK;
  d->model = (abbe_dispersion_model)model;
  ABBE_TRY(
      read_numbers(r, column[1], 1, ABBE_DISPERSION_MAX_COEFFICIENTS, INFINITY, d->c, &d->count));
  return d->model == ABBE_DISPERSION_CONDUCTOR
             ? read_conductor(r, d)
             : read_spectrum(r, column[3], column[2], 1e-3, 1e3, &d->table);
}

static abbe_result read_dispersion(reader *r) {
#define INDEX_COLUMNS(of)                                                                          \
  {                                                                                                \
    ABBE_STORE_##of##model, ABBE_STORE_##of##coefficients, ABBE_STORE_##of##interpolation,         \
        ABBE_STORE_##of##points                                                                    \
  }
  static const abbe_store_column columns[4][4] = {INDEX_COLUMNS(), INDEX_COLUMNS(extraordinary_),
                                                  INDEX_COLUMNS(alpha_), INDEX_COLUMNS(gamma_)};
  abbe_material *m = r->material;
  abbe_dispersion *const to[4] = {&m->dispersion, &m->extraordinary, &m->outer[0], &m->outer[1]};
  if (sqlite3_column_type(r->q, ABBE_STORE_model + 1) == SQLITE_NULL)
    return damaged(r, ABBE_STORE_model, "is missing");
  for (int i = 0; i < 4; i++) ABBE_TRY(read_index(r, columns[i], to[i]));
  const double low = ABBE_SPECTRUM_LOW_NM, high = ABBE_SPECTRUM_HIGH_NM;
  ABBE_TRY(read_number(r, ABBE_STORE_from_nm, low, high, &m->min_nm));
  return read_number(r, ABBE_STORE_to_nm, low, high, &m->max_nm);
}

static abbe_result read_row(reader *r) {
  abbe_material *m = r->material;
  double extrapolate = 0, absolute = 0;
  m->temperature_c = NAN;
  m->line = (size_t)sqlite3_column_int64(r->q, 0);
  const struct {
    abbe_store_column column;
    char **to;
  } texts[] = {{ABBE_STORE_name, &m->name},
               {ABBE_STORE_description, &m->description},
               {ABBE_STORE_source, &m->source},
               {ABBE_STORE_comment, &m->comment},
               {ABBE_STORE_warning, &m->warning}};
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof texts / sizeof texts[0] && result == ABBE_OK; i++)
    result = read_text(r, texts[i].column, texts[i].to);
  if (result == ABBE_OK) result = read_dispersion(r);
  if (result == ABBE_OK) result = read_number(r, ABBE_STORE_extrapolate, 0, 1, &extrapolate);
  m->extrapolate = extrapolate != 0;
  if (result == ABBE_OK)
    result = read_number(r, ABBE_STORE_temperature_c, -273.15, 1e4, &m->temperature_c);
  if (result == ABBE_OK) result = read_number(r, ABBE_STORE_n_absolute, 0, 1, &absolute);
  m->n_absolute = absolute != 0;
  if (result == ABBE_OK) result = read_number(r, ABBE_STORE_n_d, 1e-3, 1e3, &m->published_n_d);
  if (result == ABBE_OK) result = read_number(r, ABBE_STORE_v_d, -1e6, 1e6, &m->published_v_d);
  if (result == ABBE_OK) result = read_fit(r, ABBE_STORE_cauchy2, 2, &m->fit[0]);
  if (result == ABBE_OK) result = read_fit(r, ABBE_STORE_cauchy3, 3, &m->fit[1]);
  if (result == ABBE_OK)
    result = read_spectrum(r, ABBE_STORE_attenuation_per_m, ABBE_STORE_attenuation_interpolation, 0,
                           1e15, &m->attenuation);
  if (result == ABBE_OK)
    result = read_spectrum(r, ABBE_STORE_attenuation_y_per_m,
                           ABBE_STORE_attenuation_y_interpolation, 0, 1e15, &m->attenuation_yz[0]);
  if (result == ABBE_OK)
    result = read_spectrum(r, ABBE_STORE_attenuation_z_per_m,
                           ABBE_STORE_attenuation_z_interpolation, 0, 1e15, &m->attenuation_yz[1]);
  if (result == ABBE_OK)
    result = read_number(r, ABBE_STORE_fluorescence_yield, 0, 1, &m->fluorescence.yield);
  if (result == ABBE_OK)
    result =
        read_spectrum(r, ABBE_STORE_fluorescence_emission, ABBE_STORE_fluorescence_interpolation, 0,
                      1e15, &m->fluorescence.emission);
  if (result == ABBE_OK)
    result =
        read_spectrum(r, ABBE_STORE_fluorescence_excitation_per_m,
                      ABBE_STORE_fluorescence_interpolation, 0, 1e15, &m->fluorescence.excitation);
  if (result == ABBE_OK) result = read_catalogue(r);
  if (result != ABBE_OK) return result;
  /* only rows that are used are checked; thousands that are looked through would take as long
   * again */
  result =
      r->names != NULL ? abbe_material_check(m, r->error) : abbe_material_check_form(m, r->error);
  return result == ABBE_OK ? ABBE_OK : ABBE_SCHEMA;
}

/* The row that the query stands at, into the table. */
static abbe_result take_row(reader *r, abbe_error *error) {
  abbe_material m = {0};
  abbe_error why = {0};
  r->material = &m;
  r->error = &why;
  abbe_result result = r->names_only ? read_text(r, ABBE_STORE_name, &m.name) : read_row(r);
  if (result == ABBE_OK && m.name != NULL) {
    result = abbe_material_table_append(r->out, &m, error);
  } else if (result == ABBE_NO_MEMORY) {
    abbe_error_set(error, result, "%s: %s", r->path, why.text);
  } else if (r->unread != NULL) {
    abbe_report_add(r->unread, ABBE_NOTE_SKIPPED, m.line, m.name, "%s", why.text);
    result = ABBE_OK;
  } else {
    result = abbe_error_set(error, ABBE_SCHEMA, "%s: row %zu ('%.80s') cannot be used: %s", r->path,
                            m.line, m.name != NULL ? m.name : "", why.text);
  }
  abbe_material_free(&m);
  return result;
}

static abbe_result take_rows(reader *r, abbe_error *error) {
  int code;
  while ((code = sqlite3_step(r->q)) == SQLITE_ROW) {
    ABBE_TRY(take_row(r, error));
  }
  return code == SQLITE_DONE ? ABBE_OK : abbe_store_fail(r->db, code, r->path, error);
}

/* Whether a name stands before this one, whatever its case. */
static bool again(const char *const *names, size_t index) {
  for (size_t i = 0; i < index; i++)
    if (strcasecmp(names[i], names[index]) == 0) return true;
  return false;
}

static abbe_result take_named(reader *r, abbe_error *error) {
  for (size_t i = 0; i < r->count; i++) {
    if (again(r->names, i)) continue;
    sqlite3_reset(r->q);
    int code = sqlite3_bind_text(r->q, 1, r->names[i], -1, SQLITE_STATIC);
    ABBE_TRY(code == SQLITE_OK ? take_rows(r, error)
                               : abbe_store_fail(r->db, code, r->path, error));
  }
  return ABBE_OK;
}

/* ---- opening ---- */

/* file:PATH?immutable=1, so that nothing beside the file is looked for or made. */
static char *uri_of(const char *path) {
  static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-";
  static const char begin[] = "file:", end[] = "?immutable=1", hex[] = "0123456789ABCDEF";
  char *uri = malloc(sizeof begin + 3 * strlen(path) + sizeof end);
  if (uri == NULL) return NULL;
  char *to = strcpy(uri, begin) + strlen(begin);
  for (; *path != '\0'; path++) {
    unsigned char c = (unsigned char)*path;
    bool escaped = strchr(plain, c) == NULL;
    *to++ = escaped ? '%' : (char)c;
    if (escaped) *to++ = hex[c >> 4];
    if (escaped) *to++ = hex[c & 15];
  }
  strcpy(to, end);
  return uri;
}

/* One value of one row; other contents of a stranger's file are refused. */
static abbe_result check_value(sqlite3 *db, const char *path, const char *sql, const char *wanted,
                               abbe_error *error) {
  sqlite3_stmt *q = NULL;
  abbe_result result = abbe_store_prepare(db, sql, path, &q, error);
  if (result != ABBE_OK) return result;
  int code = sqlite3_step(q);
  const char *found = code == SQLITE_ROW ? (const char *)sqlite3_column_text(q, 0) : NULL;
  if (found == NULL && sqlite3_errcode(db) == SQLITE_NOMEM) code = SQLITE_NOMEM;
  if (code != SQLITE_ROW && code != SQLITE_DONE)
    result = abbe_store_fail(db, code, path, error);
  else if (found == NULL || strcmp(found, wanted) != 0)
    result = abbe_error_set(error, ABBE_PARSE,
                            "%s: is an SQLite file, and no store of this version of Abbe; 'abbe "
                            "materials import' makes one",
                            path);
  sqlite3_finalize(q);
  return result;
}

/* A file may be anyone's: its schema is compared with ours letter by letter before it is read. */
static abbe_result open_store(const char *path, sqlite3 **db, abbe_error *error) {
  char *uri = uri_of(path), number[24];
  if (uri == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", path);
  int code =
      sqlite3_open_v2(uri, db, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, NULL);
  free(uri);
  if (code != SQLITE_OK) return abbe_store_fail(*db, code, path, error);
  sqlite3_db_config(*db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
  sqlite3_db_config(*db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
  sqlite3_limit(*db, SQLITE_LIMIT_LENGTH, MAX_ROW);
  snprintf(number, sizeof number, "%d", ABBE_STORE_APPLICATION);
  abbe_result result = check_value(*db, path, "PRAGMA application_id", number, error);
  snprintf(number, sizeof number, "%d", ABBE_STORE_VERSION);
  if (result == ABBE_OK) result = check_value(*db, path, "PRAGMA user_version", number, error);
  static const char schema[] = "SELECT sql FROM sqlite_schema WHERE type = 'table' AND name = ";
  char sql[sizeof schema + 16];
  snprintf(sql, sizeof sql, "%s'materials'", schema);
  if (result == ABBE_OK) result = check_value(*db, path, sql, ABBE_STORE_MATERIALS, error);
  snprintf(sql, sizeof sql, "%s'about'", schema);
  return result == ABBE_OK ? check_value(*db, path, sql, ABBE_STORE_ABOUT, error) : result;
}

static abbe_result read_about(reader *r, char **description, abbe_error *error) {
  sqlite3_stmt *q = NULL;
  abbe_result result =
      abbe_store_prepare(r->db, "SELECT description FROM about LIMIT 1", r->path, &q, error);
  if (result != ABBE_OK) return result;
  int code = sqlite3_step(q);
  const char *text = code == SQLITE_ROW ? (const char *)sqlite3_column_text(q, 0) : NULL;
  if (code != SQLITE_ROW && code != SQLITE_DONE)
    result = abbe_store_fail(r->db, code, r->path, error);
  if (text != NULL && is_text(text, sqlite3_column_bytes(q, 0))) {
    *description = strdup(text);
    if (*description == NULL)
      result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", r->path);
  }
  sqlite3_finalize(q);
  return result;
}

static abbe_result read_store(reader *r, abbe_error *error) {
  *r->out = (abbe_material_table){0};
  abbe_result result = open_store(r->path, &r->db, error);
  if (result == ABBE_OK) result = read_about(r, &r->out->description, error);
  if (result == ABBE_OK)
    result = abbe_store_prepare(r->db,
                                r->names == NULL ? SELECT " ORDER BY id" : SELECT " WHERE name = ?",
                                r->path, &r->q, error);
  if (result == ABBE_OK) result = r->names == NULL ? take_rows(r, error) : take_named(r, error);
  sqlite3_finalize(r->q);
  sqlite3_close(r->db);
  if (result == ABBE_OK) {
    r->out->path = strdup(r->path);
    if (r->out->path == NULL)
      result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", r->path);
  }
  if (result != ABBE_OK) abbe_material_table_free(r->out);
  return result;
}

abbe_result abbe_material_store_read(const char *path, const char *const *names, size_t count,
                                     abbe_report *unread, abbe_material_table *out,
                                     abbe_error *error) {
  return read_store(
      &(reader){.path = path, .names = names, .count = count, .unread = unread, .out = out}, error);
}

abbe_result abbe_material_store_read_names(const char *path, abbe_material_table *out,
                                           abbe_error *error) {
  return read_store(&(reader){.path = path, .names_only = true, .out = out}, error);
}
