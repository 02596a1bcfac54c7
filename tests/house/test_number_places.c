/* In the library numbers with a decimal point are printed and read in base/number.c alone,
 * which does not go by the locale: read from the sources. */
#include "tests/check.h"

#include "base/file.h"

#include <ctype.h>
#include <dirent.h>
#include <sys/stat.h>

static const char *const rooms[] = {"base", "spectral",   "colorimetry", "scenes",
                                    "gl",   "validation", "library"};
static const char *const the_place = "base/number.c";

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
    print_error("%s:%zu: %s %s; base/number.h has what does not go by the locale\n", r->file,
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

TEST(the_reader_finds_them) {
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

typedef struct survey {
  size_t files, found;
} survey;

static void visit_file(survey *s, const char *path) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(printed(ABBE_SOURCE_DIR "/%s", path), 1 << 22, &text, &size, &error));
  if (strcmp(path, the_place) != 0) s->found += read_text(path, text);
  s->files++;
}

static void visit_folder(survey *s, const char *folder) {
  char full[1000], path[800];
  snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", folder);
  DIR *dir = opendir(full);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
    struct stat status;
    const char *dot = strrchr(entry->d_name, '.');
    int n = snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    assert_true(n > 0 && (size_t)n < sizeof path);
    snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", path);
    if (dot == NULL && stat(full, &status) == 0 && S_ISDIR(status.st_mode)) visit_folder(s, path);
    if (dot != NULL && (strcmp(dot, ".c") == 0 || strcmp(dot, ".cpp") == 0)) visit_file(s, path);
  }
  closedir(dir);
}

TEST(the_library_has_one_place) {
  survey s = {0};
  for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++) visit_folder(&s, rooms[i]);
  assert_true(s.files > 100);
  assert_int_equal(s.found, 0);
}
