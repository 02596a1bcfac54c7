#include "spectral/store/material_store.h"

#include "spectral/store/material_store_columns.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/types.h>
#include <unistd.h>

bool abbe_material_store_is_name(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot != NULL && strcasecmp(dot, ".sqlite") == 0;
}

/* ---- what a row holds ---- */

static void put_double(unsigned char *to, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 8; i++) to[i] = (unsigned char)(bits >> (8 * i));
}

static int bind_text(sqlite3_stmt *q, abbe_store_column column, const char *text) {
  return sqlite3_bind_text(q, column + 1, text, -1, SQLITE_STATIC);
}

/* As in the YAML of a table, NaN and 0 are left out. */
static int bind_number(sqlite3_stmt *q, abbe_store_column column, double value) {
  return value == 0 || isnan(value) ? SQLITE_OK : sqlite3_bind_double(q, column + 1, value);
}

static int bind_numbers(sqlite3_stmt *q, abbe_store_column column, const double *value,
                        size_t count) {
  unsigned char bytes[8 * ABBE_DISPERSION_MAX_COEFFICIENTS];
  for (size_t i = 0; i < count; i++) put_double(bytes + 8 * i, value[i]);
  return count == 0 ? SQLITE_OK
                    : sqlite3_bind_blob(q, column + 1, bytes, (int)(8 * count), SQLITE_TRANSIENT);
}

static int bind_said(sqlite3_stmt *q, abbe_store_column column, const double *value, size_t count) {
  bool any = false;
  for (size_t i = 0; i < count; i++) any = any || value[i] != 0;
  return any ? bind_numbers(q, column, value, count) : SQLITE_OK;
}

static int bind_spectrum(sqlite3_stmt *q, abbe_store_column column, abbe_store_column interpolation,
                         const abbe_spectrum *spectrum) {
  if (spectrum == NULL) return SQLITE_OK;
  size_t count = abbe_spectrum_count(spectrum);
  unsigned char *bytes = malloc(16 * count);
  if (bytes == NULL) return SQLITE_NOMEM;
  for (size_t i = 0; i < count; i++) {
    put_double(bytes + 16 * i, abbe_spectrum_lambda_nm(spectrum)[i]);
    put_double(bytes + 16 * i + 8, abbe_spectrum_value(spectrum)[i]);
  }
  int code = sqlite3_bind_blob(q, column + 1, bytes, (int)(16 * count), free); /* it frees them */
  const char *name = abbe_interpolation_name(abbe_spectrum_interpolation(spectrum));
  return code == SQLITE_OK ? bind_text(q, interpolation, name) : code;
}

/* nm, n and k. */
static int bind_conductor(sqlite3_stmt *q, const abbe_dispersion *d) {
  size_t count = abbe_spectrum_count(d->table);
  unsigned char *bytes = malloc(24 * count);
  if (bytes == NULL) return SQLITE_NOMEM;
  for (size_t i = 0; i < count; i++) {
    put_double(bytes + 24 * i, abbe_spectrum_lambda_nm(d->table)[i]);
    put_double(bytes + 24 * i + 8, abbe_spectrum_value(d->table)[i]);
    put_double(bytes + 24 * i + 16, abbe_spectrum_value(d->k)[i]);
  }
  return sqlite3_bind_blob(q, ABBE_STORE_points + 1, bytes, (int)(24 * count), free);
}

static int bind_fit(sqlite3_stmt *q, abbe_store_column column, const abbe_material_fit *fit) {
  double value[ABBE_STORE_MAX_TERMS + 3];
  if (fit->terms == 0 || fit->terms > ABBE_STORE_MAX_TERMS) return SQLITE_OK;
  memcpy(value, fit->c, fit->terms * sizeof *value);
  value[fit->terms] = fit->max_error;
  value[fit->terms + 1] = fit->min_nm;
  value[fit->terms + 2] = fit->max_nm;
  return bind_numbers(q, column, value, fit->terms + 3);
}

static int bind_expansion(sqlite3_stmt *q, const abbe_material_catalogue *c) {
  double value[6];
  bool ranged = false;
  for (int i = 0; i < 4; i++) ranged = ranged || c->expansion_range_k[i] != 0;
  memcpy(value, c->expansion_per_k, sizeof c->expansion_per_k);
  memcpy(value + 2, c->expansion_range_k, sizeof c->expansion_range_k);
  return bind_said(q, ABBE_STORE_expansion_per_k, value, ranged ? 6 : 2);
}

static int bind_catalogue(sqlite3_stmt *q, const abbe_material_catalogue *c) {
  int code = bind_text(q, ABBE_STORE_code, c->code);
  if (code == SQLITE_OK) code = bind_text(q, ABBE_STORE_status, c->status);
  if (code == SQLITE_OK) code = bind_number(q, ABBE_STORE_melt_frequency, c->melt_frequency);
  if (code == SQLITE_OK) code = bind_number(q, ABBE_STORE_density_g_cm3, c->density_g_cm3);
  if (code == SQLITE_OK) code = bind_expansion(q, c);
  if (code == SQLITE_OK) code = bind_number(q, ABBE_STORE_dpgf, c->dpgf);
  if (code == SQLITE_OK) code = bind_said(q, ABBE_STORE_thermal, c->thermal, 6);
  if (code == SQLITE_OK) code = bind_numbers(q, ABBE_STORE_ratings, c->ratings, c->rating_count);
  return code;
}

/* The indices besides the record's own. */
static int bind_crystal(sqlite3_stmt *q, const abbe_material *m) {
#define INDEX_COLUMNS(of)                                                                          \
  {                                                                                                \
    ABBE_STORE_##of##model, ABBE_STORE_##of##coefficients, ABBE_STORE_##of##points,                \
        ABBE_STORE_##of##interpolation                                                             \
  }
  static const abbe_store_column columns[3][4] = {INDEX_COLUMNS(extraordinary_),
                                                  INDEX_COLUMNS(alpha_), INDEX_COLUMNS(gamma_)};
  const abbe_dispersion *const from[3] = {&m->extraordinary, &m->outer[0], &m->outer[1]};
  int code = SQLITE_OK;
  for (int i = 0; i < 3 && code == SQLITE_OK; i++) {
    const abbe_dispersion *d = from[i];
    if (d->count == 0 && d->table == NULL) continue;
    code = bind_text(q, columns[i][0], abbe_dispersion_model_name(d->model));
    if (code == SQLITE_OK) code = bind_numbers(q, columns[i][1], d->c, d->count);
    if (code == SQLITE_OK) code = bind_spectrum(q, columns[i][2], columns[i][3], d->table);
  }
  return code;
}

static int bind_material(sqlite3_stmt *q, const abbe_material *m) {
  const abbe_dispersion *d = &m->dispersion;
  const struct {
    abbe_store_column column;
    const char *text;
  } texts[] = {{ABBE_STORE_name, m->name},
               {ABBE_STORE_description, m->description},
               {ABBE_STORE_model, abbe_dispersion_model_name(d->model)},
               {ABBE_STORE_source, m->source},
               {ABBE_STORE_comment, m->comment},
               {ABBE_STORE_warning, m->warning}};
  int code = SQLITE_OK;
  for (size_t i = 0; i < sizeof texts / sizeof texts[0] && code == SQLITE_OK; i++)
    code = bind_text(q, texts[i].column, texts[i].text);
  if (code == SQLITE_OK) code = bind_numbers(q, ABBE_STORE_coefficients, d->c, d->count);
  if (code == SQLITE_OK) code = bind_number(q, ABBE_STORE_from_nm, m->min_nm);
  if (code == SQLITE_OK) code = bind_number(q, ABBE_STORE_to_nm, m->max_nm);
  if (code == SQLITE_OK) code = sqlite3_bind_int(q, ABBE_STORE_extrapolate + 1, m->extrapolate);
  if (code == SQLITE_OK && !isnan(m->temperature_c))
    code = sqlite3_bind_double(q, ABBE_STORE_temperature_c + 1, m->temperature_c);
  if (code == SQLITE_OK) code = sqlite3_bind_int(q, ABBE_STORE_n_absolute + 1, m->n_absolute);
  if (code == SQLITE_OK) code = bind_number(q, ABBE_STORE_n_d, m->published_n_d);
  if (code == SQLITE_OK) code = bind_number(q, ABBE_STORE_v_d, m->published_v_d);
  if (code == SQLITE_OK) code = bind_fit(q, ABBE_STORE_cauchy2, &m->fit[0]);
  if (code == SQLITE_OK) code = bind_fit(q, ABBE_STORE_cauchy3, &m->fit[1]);
  if (code == SQLITE_OK)
    code = abbe_material_is_conductor(m)
               ? bind_conductor(q, d)
               : bind_spectrum(q, ABBE_STORE_points, ABBE_STORE_interpolation, d->table);
  if (code == SQLITE_OK) code = bind_crystal(q, m);
  if (code == SQLITE_OK)
    code = bind_spectrum(q, ABBE_STORE_attenuation_per_m, ABBE_STORE_attenuation_interpolation,
                         m->attenuation);
  if (code == SQLITE_OK)
    code = bind_spectrum(q, ABBE_STORE_attenuation_y_per_m, ABBE_STORE_attenuation_y_interpolation,
                         m->attenuation_yz[0]);
  if (code == SQLITE_OK)
    code = bind_spectrum(q, ABBE_STORE_attenuation_z_per_m, ABBE_STORE_attenuation_z_interpolation,
                         m->attenuation_yz[1]);
  if (code == SQLITE_OK)
    code = bind_number(q, ABBE_STORE_fluorescence_yield, m->fluorescence.yield);
  if (code == SQLITE_OK)
    code = bind_spectrum(q, ABBE_STORE_fluorescence_emission, ABBE_STORE_fluorescence_interpolation,
                         m->fluorescence.emission);
  if (code == SQLITE_OK)
    code = bind_spectrum(q, ABBE_STORE_fluorescence_excitation_per_m,
                         ABBE_STORE_fluorescence_interpolation, m->fluorescence.excitation);
  return code == SQLITE_OK ? bind_catalogue(q, &m->catalogue) : code;
}

/* ---- a file row by row ---- */

/* A file without a name, so that nothing is left of it wherever the program ends. */
struct abbe_material_store_maker {
  sqlite3 *db;
  sqlite3_stmt *insert;
  int fd;
  size_t rows;
};

static const char *temporary_folder(void) {
  const char *folder = getenv("TMPDIR");
  return folder != NULL && folder[0] != '\0' ? folder : "/tmp";
}

/* A store is made in a temporary file, whose disk may be another one than the store's. */
static abbe_result fail_to_make(sqlite3 *db, int code, const char *name, abbe_error *error) {
  if ((code & 0xff) != SQLITE_IOERR && (code & 0xff) != SQLITE_FULL)
    return abbe_store_fail(db, code, name, error);
  return abbe_error_set(error, ABBE_IO,
                        "a temporary file in %s could not be written: %s; TMPDIR may name another "
                        "folder",
                        temporary_folder(), sqlite3_errmsg(db));
}

static abbe_result execute(sqlite3 *db, const char *sql, abbe_error *error) {
  int code = sqlite3_exec(db, sql, NULL, NULL, NULL);
  return code == SQLITE_OK ? ABBE_OK : fail_to_make(db, code, "the store", error);
}

#define ASKED(name, type) ", ?"

static abbe_result begin(abbe_material_store_maker *s, const char *path, abbe_error *error) {
  char sql[256];
  int code = sqlite3_open_v2(path, &s->db, SQLITE_OPEN_READWRITE, NULL);
  if (code != SQLITE_OK) return fail_to_make(s->db, code, path, error);
  snprintf(sql, sizeof sql,
           "PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA application_id=%d; "
           "PRAGMA user_version=%d; BEGIN",
           ABBE_STORE_APPLICATION, ABBE_STORE_VERSION);
  ABBE_TRY(execute(s->db, sql, error));
  ABBE_TRY(execute(s->db, ABBE_STORE_ABOUT ";" ABBE_STORE_MATERIALS, error));
  return abbe_store_prepare(s->db,
                            "INSERT INTO materials VALUES(NULL" ABBE_STORE_COLUMNS(ASKED) ")",
                            "the store", &s->insert, error);
}

abbe_result abbe_material_store_begin(abbe_material_store_maker **out, abbe_error *error) {
  char path[4096];
  abbe_material_store_maker *s = calloc(1, sizeof *s);
  *out = s;
  if (s == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a store");
  snprintf(path, sizeof path, "%s/abbe-store-XXXXXX", temporary_folder());
  s->fd = mkstemp(path);
  if (s->fd < 0)
    return abbe_error_set(error, ABBE_IO,
                          "%s: no file can be made there: %s; TMPDIR may name another folder", path,
                          strerror(errno));
  const abbe_result result = begin(s, path, error);
  unlink(path);
  return result;
}

void abbe_material_store_drop(abbe_material_store_maker *s) {
  if (s == NULL) return;
  sqlite3_finalize(s->insert);
  sqlite3_close(s->db);
  if (s->fd >= 0) close(s->fd);
  free(s);
}

static int insert(abbe_material_store_maker *s, const abbe_material *m, const char *name) {
  sqlite3_reset(s->insert);
  sqlite3_clear_bindings(s->insert);
  int code = bind_material(s->insert, m);
  if (code == SQLITE_OK) code = bind_text(s->insert, ABBE_STORE_name, name);
  if (code == SQLITE_OK) code = sqlite3_step(s->insert);
  s->rows += code == SQLITE_DONE;
  return code;
}

static abbe_result check_place(const abbe_material *m, abbe_error *error) {
  if (m->fluorescence.rows == 0) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: a store has no place for a re-radiation matrix; YAML has", m->name);
}

abbe_result abbe_material_store_put(abbe_material_store_maker *s, abbe_material *m,
                                    abbe_error *error) {
  ABBE_TRY(check_place(m, error));
  char apart[32]; /* no name of a material has such a letter */
  snprintf(apart, sizeof apart, "\x01%zu", s->rows + 1);
  int code = insert(s, m, m->name);
  if (code == SQLITE_CONSTRAINT) code = insert(s, m, apart);
  if (code != SQLITE_DONE) return fail_to_make(s->db, code, m->name, error);
  abbe_material kept = {.name = m->name, .line = m->line, .row = s->rows};
  m->name = NULL;
  abbe_material_free(m);
  *m = kept;
  return ABBE_OK;
}

/* The names of rows that stay; first apart, for a new one may be another's old one. The others go.
 */
static abbe_result name_rows(abbe_material_store_maker *s, const abbe_material_table *table,
                             abbe_error *error) {
  static const char *const steps[] = {
      "UPDATE materials SET name=char(1)||id WHERE id=?1 AND name IS NOT ?2 COLLATE BINARY",
      "UPDATE materials SET name=?2 WHERE id=?1 AND name IS NOT ?2 COLLATE BINARY",
      "DELETE FROM materials WHERE name LIKE char(1)||'%'"};
  abbe_result result = ABBE_OK;
  for (int step = 0; step < 3 && result == ABBE_OK; step++) {
    sqlite3_stmt *q = NULL;
    result = abbe_store_prepare(s->db, steps[step], "the store", &q, error);
    for (size_t i = 0; i < (step < 2 ? table->count : 1) && result == ABBE_OK; i++) {
      const abbe_material *m = step < 2 ? &table->material[i] : NULL;
      int code = sqlite3_reset(q);
      if (m != NULL) code = sqlite3_bind_int64(q, 1, (sqlite3_int64)m->row);
      if (m != NULL && code == SQLITE_OK)
        code = sqlite3_bind_text(q, 2, m->name, -1, SQLITE_STATIC);
      if (code == SQLITE_OK) code = sqlite3_step(q);
      if (code != SQLITE_DONE) result = fail_to_make(s->db, code, "the store", error);
    }
    sqlite3_finalize(q);
  }
  return result;
}

static abbe_result describe(sqlite3 *db, const char *description, abbe_error *error) {
  sqlite3_stmt *q = NULL;
  abbe_result result =
      abbe_store_prepare(db, "INSERT INTO about VALUES(?)", "the store", &q, error);
  if (result != ABBE_OK) return result;
  int code = sqlite3_bind_text(q, 1, description, -1, SQLITE_STATIC);
  if (code == SQLITE_OK) code = sqlite3_step(q);
  if (code != SQLITE_DONE) result = fail_to_make(db, code, "the store", error);
  sqlite3_finalize(q);
  return result;
}

static abbe_result finish(abbe_material_store_maker *s, const char *description, FILE *to,
                          abbe_error *error) {
  char bytes[1 << 15];
  ssize_t count;
  ABBE_TRY(describe(s->db, description, error));
  ABBE_TRY(execute(s->db, "COMMIT", error));
  for (off_t at = 0; (count = pread(s->fd, bytes, sizeof bytes, at)) > 0; at += count)
    fwrite(bytes, 1, (size_t)count, to);
  if (count == 0 && fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "the store could not be written");
}

abbe_result abbe_material_store_end(abbe_material_store_maker *s, const abbe_material_table *table,
                                    FILE *to, abbe_error *error) {
  ABBE_TRY(name_rows(s, table, error));
  return finish(s, table->description, to, error);
}

static abbe_result insert_all(abbe_material_store_maker *s, const abbe_material_table *table,
                              abbe_error *error) {
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    ABBE_TRY(abbe_material_check(m, error));
    ABBE_TRY(check_place(m, error));
    const int code = insert(s, m, m->name);
    if (code == SQLITE_CONSTRAINT)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the name '%s' stands twice", m->name);
    if (code != SQLITE_DONE) return fail_to_make(s->db, code, m->name, error);
  }
  return ABBE_OK;
}

abbe_result abbe_material_store_write(const abbe_material_table *table, FILE *to,
                                      abbe_error *error) {
  abbe_material_store_maker *s = NULL;
  abbe_result result = abbe_material_store_begin(&s, error);
  if (result == ABBE_OK) result = insert_all(s, table, error);
  if (result == ABBE_OK) result = finish(s, table->description, to, error);
  abbe_material_store_drop(s);
  return result;
}

/* How SQLite's failures are reported. */
abbe_result abbe_store_fail(sqlite3 *db, int code, const char *name, abbe_error *error) {
  const char *text = db != NULL ? sqlite3_errmsg(db) : sqlite3_errstr(code);
  switch (code & 0xff) {
  case SQLITE_NOMEM:
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", name);
  case SQLITE_CANTOPEN:
  case SQLITE_IOERR:
  case SQLITE_PERM:
  case SQLITE_AUTH:
    return abbe_error_set(error, ABBE_IO, "%s: cannot be read: %s", name, text);
  default:
    return abbe_error_set(error, ABBE_PARSE, "%s: the store is damaged: %s", name, text);
  }
}

abbe_result abbe_store_prepare(sqlite3 *db, const char *sql, const char *name, sqlite3_stmt **out,
                               abbe_error *error) {
  int code = sqlite3_prepare_v2(db, sql, -1, out, NULL);
  return code == SQLITE_OK ? ABBE_OK : abbe_store_fail(db, code, name, error);
}
