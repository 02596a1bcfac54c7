#include "validation/measure/gem/gem_grid_file.h"

#include "base/file.h"
#include "base/number.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char COLUMNS[] = "pair,crown_rad,pavilion_rad,value,standard_error";
enum { ASKED_SIZE = 400, MOST_BYTES = 1 << 24 };

/* What must be alike for tables to go together. */
static void asked(const abbe_gem_optimum *o, char out[ASKED_SIZE]) {
  char crown[2][ABBE_NUMBER_TEXT_SIZE], pavilion[2][ABBE_NUMBER_TEXT_SIZE];
  char value[ABBE_NUMBER_TEXT_SIZE];
  snprintf(out, ASKED_SIZE,
           "%s of %zu x %zu angles, crown %s to %s rad, pavilion %s to %s rad; the design has %s",
           abbe_gem_amount_name(o->measure), o->crowns, o->pavilions,
           abbe_number_text(o->crown_rad[0], crown[0]),
           abbe_number_text(o->crown_rad[o->crowns - 1], crown[1]),
           abbe_number_text(o->pavilion_rad[0], pavilion[0]),
           abbe_number_text(o->pavilion_rad[o->pavilions - 1], pavilion[1]),
           abbe_number_text(o->design.value, value));
}

static void write_row(FILE *to, const abbe_gem_optimum *o, size_t i) {
  const double cell[] = {o->crown_rad[i % o->crowns], o->pavilion_rad[i / o->crowns],
                         o->value[i].value, o->value[i].error};
  fprintf(to, "%zu", i);
  for (size_t k = 0; k < sizeof cell / sizeof cell[0]; k++) {
    char text[ABBE_NUMBER_TEXT_SIZE];
    fprintf(to, ",%s", abbe_number_text(cell[k], text));
  }
  fputc('\n', to);
}

abbe_result abbe_gem_grid_file_write(const char *path, const abbe_gem_optimum *o,
                                     abbe_error *error) {
  assert(o->value);
  abbe_file_writer writer = {0};
  char text[ASKED_SIZE];
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  asked(o, text);
  fprintf(writer.stream, "# asked: %s\n%s\n", text, COLUMNS);
  for (size_t i = 0; i < o->crowns * o->pavilions; i++)
    if (!isnan(o->value[i].value)) write_row(writer.stream, o, i);
  return abbe_file_writer_commit(&writer, error);
}

/* ---- reading ---- */

static abbe_result read_row(const char *path, size_t line, const char *row, abbe_gem_optimum *o,
                            abbe_error *error) {
  double cell[5];
  const char *at = row;
  for (int k = 0; k < 5; k++) {
    const char *end;
    if (!abbe_number_read(at, &end, &cell[k]) || !isfinite(cell[k]) || *end != (k < 4 ? ',' : '\0'))
      return abbe_error_set(error, ABBE_PARSE,
                            "%s: line %zu: column %d of five numbers, %s, is none", path, line,
                            k + 1, COLUMNS);
    at = end + 1;
  }
  const double pairs = (double)(o->crowns * o->pavilions);
  if (!(cell[0] >= 0 && cell[0] < pairs && cell[0] == floor(cell[0])))
    return abbe_error_set(error, ABBE_PARSE, "%s: line %zu: pair %g of 0 to %.0f", path, line,
                          cell[0], pairs - 1);
  const size_t i = (size_t)cell[0];
  if (!isnan(o->value[i].value))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: line %zu: pair %zu is known already; is a table given twice?", path,
                          line, i);
  abbe_gem_optimum_know(o, i, (abbe_gem_number){cell[3], cell[4]});
  return ABBE_OK;
}

static abbe_result read_head(const char *path, size_t line, const char *row,
                             const abbe_gem_optimum *o, abbe_error *error) {
  static const char MARK[] = "# asked: ";
  char text[ASKED_SIZE];
  asked(o, text);
  if (line == 1 && strncmp(row, MARK, sizeof MARK - 1) != 0)
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: no table of a part of a search; it begins with '%s'", path, MARK);
  if (line == 1 && strcmp(row + sizeof MARK - 1, text) != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s is of another search: it has %.300s; asked now is %.300s", path,
                          row + sizeof MARK - 1, text);
  if (line == 2 && strcmp(row, COLUMNS) != 0)
    return abbe_error_set(error, ABBE_PARSE, "%s: line 2: the columns are not %s", path, COLUMNS);
  return ABBE_OK;
}

abbe_result abbe_gem_grid_file_read(const char *path, abbe_gem_optimum *o, abbe_error *error) {
  assert(o->value);
  char *data, *rest = NULL;
  size_t size, line = 0;
  abbe_result result = abbe_file_read_text(path, MOST_BYTES, &data, &size, error);
  if (result != ABBE_OK) return result;
  for (char *row = strtok_r(data, "\r\n", &rest); row != NULL && result == ABBE_OK;
       row = strtok_r(NULL, "\r\n", &rest)) {
    line++;
    result = line <= 2 ? read_head(path, line, row, o, error) : read_row(path, line, row, o, error);
  }
  if (result == ABBE_OK && line < 2)
    result = abbe_error_set(error, ABBE_PARSE, "%s: no table of a part of a search", path);
  free(data);
  return result;
}
