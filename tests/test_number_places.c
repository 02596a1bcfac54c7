/* In the library numbers with a decimal point are printed and read in spectral/number.c alone,
 * which does not go by the locale: read from the sources. */
#include "tests/check.h"

#include "spectral/file.h"

#include <ctype.h>
#include <dirent.h>
#include <stdbool.h>
#include <stdlib.h>

static const char *const rooms[] = {"spectral", "colorimetry", "scenes", "gl", "validation"};
static const char *const the_place = "spectral/number.c";

/* Read numbers, or print what is not told from here. */
static const char *const nowhere[] = {"strtod",  "strtof",   "strtold",   "atof",
                                      "vprintf", "vfprintf", "vsnprintf", "vsprintf",
                                      "scanf",   "stod",     "stof",      "to_string"};
/* May print and read whole numbers and words. */
static const char *const whole[] = {"printf",  "fprintf", "snprintf", "sprintf",
                                    "dprintf", "sscanf",  "fscanf"};

static bool is_one_of(const char *word, const char *const *list, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (strcmp(word, list[i]) == 0) return true;
  return false;
}
#define IS_ONE_OF(word, list) is_one_of(word, list, sizeof list / sizeof *list)

/* Whether a literal's text has a conversion of a, e, f or g. */
static bool has_real(const char *c, const char *end) {
  while (c < end) {
    if (*c++ != '%') continue;
    while (c < end && strchr("-+ #0123456789.*hlLzjt", *c) != NULL) c++;
    if (c < end && strchr("aAeEfFgG", *c) != NULL) return true;
    if (c < end) c++;
  }
  return false;
}

enum { DEEP = 64, WORD = 64 };

/* The words before the brackets that are open. */
typedef struct reading {
  const char *file;
  size_t line, found;
  int depth;
  char word[WORD], call[DEEP][WORD];
} reading;

static void complain(reading *r, const char *what, const char *why) {
  if (r->file != NULL)
    print_error("%s:%zu: %s %s; spectral/number.h has what does not go by the locale\n", r->file,
                r->line, what, why);
  r->found++;
}

static const char *read_word(reading *r, const char *c) {
  size_t used = 0;
  for (; isalnum((unsigned char)*c) || *c == '_'; c++)
    if (used + 1 < WORD) r->word[used++] = *c;
  r->word[used] = '\0';
  if (*c == '(' && IS_ONE_OF(r->word, nowhere)) complain(r, r->word, "goes by the locale");
  return c;
}

static const char *read_literal(reading *r, const char *c) {
  const char quote = *c++, *from = c;
  for (; *c != '\0' && *c != quote; c++)
    if (*c == '\\' && c[1] != '\0') c++;
  const char *call = r->depth > 0 && r->depth <= DEEP ? r->call[r->depth - 1] : "";
  if (quote == '"' && IS_ONE_OF(call, whole) && has_real(from, c))
    complain(r, call, "prints or reads a real number");
  return *c == '\0' ? c : c + 1;
}

static const char *skip_comment(reading *r, const char *c) {
  const char *end = c[1] == '*' ? strstr(c + 2, "*/") : strchr(c, '\n');
  if (end == NULL) return c + strlen(c);
  if (c[1] == '*') end += 2;
  for (; c < end; c++) r->line += *c == '\n';
  return end;
}

static size_t read_text(const char *file, const char *text) {
  reading r = {.file = file, .line = 1};
  for (const char *c = text; *c != '\0';) {
    if (*c == '/' && (c[1] == '*' || c[1] == '/')) {
      c = skip_comment(&r, c);
    } else if (*c == '"' || *c == '\'') {
      c = read_literal(&r, c);
    } else if (isalpha((unsigned char)*c) || *c == '_') {
      c = read_word(&r, c);
    } else {
      if (*c == '(' && r.depth++ < DEEP) memcpy(r.call[r.depth - 1], r.word, WORD);
      if (*c == ')' && r.depth > 0) r.depth--;
      if (!isspace((unsigned char)*c)) r.word[0] = '\0';
      r.line += *c++ == '\n';
    }
  }
  return r.found;
}

static void test_the_reader_finds_them(void **state) {
  (void)state;
  static const struct {
    const char *text;
    size_t found;
  } rows[] = {{"x = strtod(a, b);", 1},
              {"/* strtod(a) */ // atof(b)\n", 0},
              {"snprintf(a, b, \"%d %s %% f %zu\", c);", 0},
              {"snprintf(a, b,\n \"n\"\n \"%.*g\", 3, c);", 1},
              {"snprintf(a, f(b, \"%g\"), \"%5.2lf\", '\"');", 1},
              {"abbe_error_set(e, c, \"%g\", f(1, \"%\\\"\"));", 0},
              {"vsnprintf(a, b, c, d);", 1},
              {"sscanf(a, \"%lg\", &b); sscanf(a, \"%20llu\", &c);", 1},
              {"x = \"%g\"; std::to_string(1.5);", 1}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (read_text(NULL, rows[i].text) != rows[i].found) fail_msg("row %zu", i);
}

static void test_the_library_has_one_place(void **state) {
  (void)state;
  size_t found = 0, files = 0;
  for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++) {
    char folder[400];
    snprintf(folder, sizeof folder, "%s/%s", ABBE_SOURCE_DIR, rooms[i]);
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
      const char *dot = strrchr(entry->d_name, '.');
      if (dot == NULL || (strcmp(dot, ".c") != 0 && strcmp(dot, ".cpp") != 0)) continue;
      char path[1000], file[400], *text = NULL;
      size_t size = 0;
      snprintf(file, sizeof file, "%s/%.200s", rooms[i], entry->d_name);
      snprintf(path, sizeof path, "%s/%s", ABBE_SOURCE_DIR, file);
      assert_int_equal(abbe_file_read(path, 1 << 22, &text, &size, NULL), ABBE_OK);
      if (strcmp(file, the_place) != 0) found += read_text(file, text);
      free(text);
      files++;
    }
    closedir(dir);
  }
  assert_true(files > 100);
  assert_int_equal(found, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_reader_finds_them),
                                     cmocka_unit_test(test_the_library_has_one_place)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
