#include "scenes/cuts/cut_file.h"

#include "base/foreign_text.h"
#include "base/number.h"
#include "base/text.h"
#include "scenes/cuts/cut.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define MOST_INDEX 1e6
enum { MOST_FOLDS = 1000, ASSUMED_GEAR = 96 };

typedef struct reading {
  const char *name;
  size_t line;
  abbe_cut *cut;
  abbe_report *report;
  bool geared, open; /* a gear was read; a tier may go on */
  char *pending;     /* a name before any index of its tier */
} reading;

#define FAIL(r, code, ...) fail(r, code, error, __VA_ARGS__)
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
static abbe_result
fail(const reading *r, abbe_result code, abbe_error *error, const char *format, ...) {
  char prefix[300];
  va_list arguments;
  snprintf(prefix, sizeof prefix, "%.255s:%zu: ", r->name, r->line);
  va_start(arguments, format);
  abbe_error_set_list(error, code, prefix, format, arguments);
  va_end(arguments);
  return code;
}

#define NOTE(r, kind, ...) abbe_report_add((r)->report, kind, (r)->line, NULL, __VA_ARGS__)

static char *skip_blanks(char *at) {
  while (*at == ' ' || *at == '\t') at++;
  return at;
}

/* The next word, cut off from what follows it; NULL where there is none. */
static char *next_word(char **at) {
  char *word = skip_blanks(*at), *end = word;
  while (*end != '\0' && *end != ' ' && *end != '\t') end++;
  *at = *end != '\0' ? end + 1 : end;
  *end = '\0';
  return end > word ? word : NULL;
}

static bool is_number(const char *word, double *value) {
  const char *end;
  return abbe_number_read(word, &end, value) && *end == '\0' && isfinite(*value);
}

static bool begins_number(const char *at) {
  if (*at == '-' || *at == '+') at++;
  if (*at == '.') at++;
  return isdigit((unsigned char)*at);
}

/* NaN, an infinity, or a number that is as good as one. */
static bool is_no_number(const char *word) {
  static const char *const names[] = {"nan", "inf", "infinity"};
  double value;
  const char *end;
  if (abbe_number_read(word, &end, &value)) return !isfinite(value);
  if (*word == '-' || *word == '+') word++;
  for (int i = 0; i < 3; i++) {
    const char *a = word, *b = names[i];
    while (*b != '\0' && tolower((unsigned char)*a) == *b) a++, b++;
    if (*b == '\0' && *a == '\0') return true;
  }
  return false;
}

static abbe_result copy(const char *text, char **out, abbe_error *error) {
  free(*out);
  *out = strdup(text);
  return *out ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design's text");
}

/* The first number of the rest of a line. */
static abbe_result want(const reading *r, char **at, const char *what, double *out,
                        abbe_error *error) {
  const char *word = next_word(at);
  if (word && is_number(word, out)) return ABBE_OK;
  return FAIL(r, ABBE_PARSE, "%s is wanted here, and there is %s%.40s%s", what, word ? "'" : "",
              word ? word : "nothing", word ? "'" : "");
}

/* ---- what is there once ---- */

static abbe_result read_gear(reading *r, char *at, abbe_error *error) {
  double teeth, offset = 0;
  ABBE_TRY(want(r, &at, "the number of the gear's teeth", &teeth, error));
  if (teeth == 0 || teeth != round(teeth) || fabs(teeth) > ABBE_CUT_MAX_GEAR)
    return FAIL(r, ABBE_SCHEMA, "a gear has 1 to %d teeth (below 0 where it is reversed), not %g",
                ABBE_CUT_MAX_GEAR, teeth);
  if (*skip_blanks(at) != '\0') ABBE_TRY(want(r, &at, "the gear's offset", &offset, error));
  if (fabs(offset) > MOST_INDEX)
    return FAIL(r, ABBE_SCHEMA, "the gear's offset %g is not an index", offset);
  if (r->geared) NOTE(r, ABBE_NOTE_CHANGED, "the gear is said again; the last one holds");
  r->geared = true;
  r->cut->gear = (int)teeth;
  r->cut->offset = offset;
  return ABBE_OK;
}

static void read_folds(reading *r, char *at) {
  const char *end;
  double folds;
  at = skip_blanks(at);
  if (!abbe_number_read(at, &end, &folds) || !(folds >= 0 && folds <= MOST_FOLDS) ||
      folds != floor(folds)) {
    NOTE(r, ABBE_NOTE_SKIPPED, "the symmetry '%.40s' is no number of folds", at);
    return;
  }
  while (*end == ' ' || *end == '\t') end++;
  r->cut->folds = (int)folds;
  r->cut->mirror = *end == 'y' || *end == 'Y';
}

static abbe_result read_refraction(reading *r, char *at, abbe_error *error) {
  double n;
  ABBE_TRY(want(r, &at, "the refractive index", &n, error));
  if (n > 1 && n < 100)
    r->cut->refractive_index = n;
  else
    NOTE(r, ABBE_NOTE_SKIPPED, "no stone has a refractive index of %g", n);
  return ABBE_OK;
}

static abbe_result read_text(reading *r, char *at, char **lines, const char *what,
                             abbe_error *error) {
  at = skip_blanks(at);
  for (int i = 0; i < ABBE_CUT_LINES; i++)
    if (!lines[i]) return copy(at, &lines[i], error);
  NOTE(r, ABBE_NOTE_LOST, "a %s beyond the %dth: '%.80s'", what, ABBE_CUT_LINES, at);
  return ABBE_OK;
}

/* ---- tiers ---- */

static abbe_result add_index(reading *r, double index, abbe_error *error) {
  if (fabs(index) > MOST_INDEX) return FAIL(r, ABBE_SCHEMA, "%g is no index of a gear", index);
  abbe_result result = abbe_cut_add_facet(r->cut, index, error);
  if (result == ABBE_UNSUPPORTED)
    return FAIL(r, result, "more than %d facets; no stone has so many", ABBE_CUT_MAX_FACETS);
  if (result != ABBE_OK || !r->pending) return result;
  r->cut->facet[r->cut->facet_count - 1].name = r->pending;
  r->pending = NULL;
  return ABBE_OK;
}

/* Without an index a facet lies where the gear's offset is. */
static abbe_result end_tier(reading *r, abbe_error *error) {
  abbe_cut *cut = r->cut;
  const bool bare = r->open && cut->tier[cut->tier_count - 1].count == 0;
  r->open = false;
  return bare ? add_index(r, NAN, error) : ABBE_OK;
}

static abbe_result read_name(reading *r, char **at, abbe_error *error) {
  abbe_cut *cut = r->cut;
  const char *word = next_word(at);
  if (!word) {
    NOTE(r, ABBE_NOTE_SKIPPED, "'n' without a name behind it");
    return ABBE_OK;
  }
  char **name = cut->tier[cut->tier_count - 1].count > 0 ? &cut->facet[cut->facet_count - 1].name
                                                         : &r->pending;
  if (*name) NOTE(r, ABBE_NOTE_LOST, "a facet is named again; '%.40s' is left out", *name);
  return copy(word, name, error);
}

static abbe_result read_instruction(reading *r, char *at, abbe_error *error) {
  char **text = &r->cut->tier[r->cut->tier_count - 1].instruction;
  at = skip_blanks(at);
  if (*at == '\0') return ABBE_OK;
  if (!*text) return copy(at, text, error);
  const size_t size = strlen(*text) + strlen(at) + 2;
  char *both = malloc(size);
  if (!both) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design's text");
  snprintf(both, size, "%s %s", *text, at);
  free(*text);
  *text = both;
  return ABBE_OK;
}

/* Indices, names and the instruction, on the tier's line or one that goes on with it. */
static abbe_result read_words(reading *r, char *at, abbe_error *error) {
  const char *word;
  double index;
  while ((word = next_word(&at)) != NULL) {
    if (strcmp(word, "G") == 0) return read_instruction(r, at, error);
    if (strcmp(word, "n") == 0)
      ABBE_TRY(read_name(r, &at, error));
    else if (is_number(word, &index))
      ABBE_TRY(add_index(r, index, error));
    else if (is_no_number(word) || begins_number(word))
      ABBE_TRY(FAIL(r, ABBE_SCHEMA,
                    "'%.40s' is no index of a gear, which is a number such as 3 or 3.5", word));
    else
      NOTE(r, ABBE_NOTE_SKIPPED, "'%.40s' is neither an index nor a name behind 'n'", word);
  }
  return ABBE_OK;
}

static abbe_result read_tier(reading *r, char *at, abbe_error *error) {
  double angle, distance;
  const bool below = *skip_blanks(at) == '-';
  abbe_result result = want(r, &at, "a tier's angle", &angle, error);
  if (result == ABBE_OK) result = want(r, &at, "a tier's distance", &distance, error);
  if (result != ABBE_OK) return result;
  if (fabs(angle) > 90)
    return FAIL(r, ABBE_SCHEMA, "a tier's angle is from -90 to 90 degrees, not %g", angle);
  const double far = fabs(distance);
  if (!(far >= 1 / ABBE_CUT_FAR && far <= ABBE_CUT_FAR))
    return FAIL(r, ABBE_SCHEMA,
                "a tier's distance is that of its plane from the centre, from %g to %g, not %g",
                1 / ABBE_CUT_FAR, ABBE_CUT_FAR, distance);
  const bool culet = angle == 0 && (below || distance < 0);
  if (distance < 0 && angle != 0)
    NOTE(r, ABBE_NOTE_CHANGED, "the distance %g is below 0; its magnitude is taken", distance);
  result = abbe_cut_add_tier(r->cut, culet ? -0.0 : angle, far, error);
  r->open = result == ABBE_OK;
  return result == ABBE_OK ? read_words(r, at, error) : result;
}

/* ---- the file ---- */

static bool is_word(const char *at, char letter) {
  return *at == letter && (at[1] == ' ' || at[1] == '\t' || at[1] == '\0');
}

/* A keyword stands alone or sticks to the number behind it. */
static bool is_keyword(const char *at, char letter) {
  return is_word(at, letter) || (*at == letter && begins_number(at + 1));
}

static abbe_result read_line(reading *r, char *line, abbe_error *error) {
  char *at = skip_blanks(line);
  double ignored;
  const char *end;
  if (*at == '\0' || *at == ';' || *at == '#') return ABBE_OK;
  if (strncmp(at, "GemCad", 6) == 0) return ABBE_OK;
  const bool number = abbe_number_read(at, &end, &ignored);
  if (r->open && (number || is_no_number(at) || is_word(at, 'n') || is_word(at, 'G')))
    return read_words(r, at, error);
  ABBE_TRY(end_tier(r, error));
  if (is_keyword(at, 'a')) return read_tier(r, at + 1, error);
  if (is_keyword(at, 'g')) return read_gear(r, at + 1, error);
  if (is_keyword(at, 'I')) return read_refraction(r, at + 1, error);
  if (number && r->cut->tier_count == 0) return read_gear(r, at, error);
  if (is_keyword(at, 'y'))
    read_folds(r, at + 1);
  else if (*at == 'H')
    ABBE_TRY(read_text(r, at + 1, r->cut->heading, "heading", error));
  else if (*at == 'F')
    ABBE_TRY(read_text(r, at + 1, r->cut->footnote, "footnote", error));
  else
    NOTE(r, ABBE_NOTE_SKIPPED, "a line that says nothing of a design: '%.80s'", at);
  return ABBE_OK;
}

/* The sign for minus, as typesetters have it, becomes a hyphen. */
static void plain_minus(char *text) {
  char *to = text;
  while (*text != '\0') {
    const bool minus = strncmp(text, "\xe2\x88\x92", 3) == 0;
    *to++ = minus ? '-' : *text;
    text += minus ? 3 : 1;
  }
  *to = '\0';
}

static abbe_result read_all(reading *r, char *text, abbe_error *error) {
  abbe_result result = ABBE_OK;
  plain_minus(text);
  for (char *line = text, *next; line && result == ABBE_OK; line = next) {
    next = strchr(line, '\n');
    if (next) *next++ = '\0';
    r->line++;
    result = read_line(r, line, error);
  }
  if (result == ABBE_OK) result = end_tier(r, error);
  if (result != ABBE_OK) return result;
  if (r->cut->tier_count == 0)
    return abbe_error_set(error, ABBE_PARSE,
                          "%.255s: there is no facet in it; a design in GemCad's text has lines "
                          "such as 'a 42.0 0.7045 96 n B 84 72'",
                          r->name);
  if (!r->geared) {
    r->cut->gear = ASSUMED_GEAR;
    NOTE(r, ABBE_NOTE_ASSUMED, "no line 'g' says the gear; %d teeth are assumed", ASSUMED_GEAR);
  }
  for (size_t i = 0; i < r->cut->facet_count; i++)
    if (isnan(r->cut->facet[i].index)) r->cut->facet[i].index = r->cut->offset;
  abbe_cut_place(r->cut);
  abbe_error inner = {0};
  result = abbe_cut_check(r->cut, &inner);
  return result == ABBE_OK ? result
                           : abbe_error_set(error, result, "%.255s: %.600s", r->name, inner.text);
}

abbe_result abbe_cut_asc_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error) {
  memset(out, 0, sizeof *out);
  reading r = {.name = name, .cut = out, .report = report};
  char *text = NULL;
  size_t length;
  if (abbe_encoding_is_binary(data, size))
    return abbe_error_set(error, ABBE_PARSE, "%.255s: this is no text, as an .asc design is", name);
  abbe_result result = abbe_encoding_decode(data, size, &text, &length, error);
  if (result == ABBE_OK) result = read_all(&r, text, error);
  free(text);
  free(r.pending);
  if (result != ABBE_OK) abbe_cut_free(out);
  return result;
}

/* ---- out ---- */

/* With GemCad's digits where they are enough. */
static void write_number(FILE *to, double value, int digits) {
  char text[64];
  double back = 0;
  const char *end;
  abbe_number_format(text, sizeof text, "%.*f", digits, value);
  abbe_number_read(text, &end, &back);
  if (back != value) abbe_number_text(value, text);
  fputs(text, to);
}

static void write_line(FILE *to, const char *key, const char *text) {
  char narrow[1024];
  abbe_cut_text_narrow(text, narrow, sizeof narrow);
  fprintf(to, "%s %s\n", key, narrow);
}

/* A name is one word, and its letters are bytes that are not read as UTF-8: of those some would be
 * dropped, and the word with them. */
static void write_name(FILE *to, const char *name, abbe_report *report) {
  char narrow[256];
  bool changed = false;
  abbe_cut_text_narrow(name, narrow, sizeof narrow);
  for (char *c = narrow; *c != '\0'; c++) {
    uint32_t code;
    const size_t bytes = abbe_utf8_read((const unsigned char *)c, strlen(c), &code);
    if (*c == ' ') *c = '_', changed = true;
    if (bytes > 1) memset(c, '?', bytes), changed = true;
  }
  if (changed)
    abbe_report_add(report, ABBE_NOTE_CHANGED, 0, NULL, "a name is one word: '%s' is now '%s'",
                    name, narrow);
  fprintf(to, " n %s", narrow);
}

static void write_tier(const abbe_cut *cut, size_t t, FILE *to, abbe_report *report) {
  enum { A_LINE = 24 };
  const abbe_cut_tier *tier = &cut->tier[t];
  fputs("a ", to);
  write_number(to, tier->angle_deg, 6);
  putc(' ', to);
  write_number(to, tier->distance, 8);
  for (size_t i = 0; i < tier->count; i++) {
    const abbe_cut_facet *f = &cut->facet[tier->first + i];
    char index[ABBE_NUMBER_TEXT_SIZE];
    putc(i > 0 && i % A_LINE == 0 ? '\n' : ' ', to);
    fputs(abbe_number_text(f->index, index), to);
    if (f->name) write_name(to, f->name, report);
  }
  if (tier->instruction) write_line(to, " G", tier->instruction);
  if (!tier->instruction) putc('\n', to);
}

abbe_result abbe_cut_asc_write(const abbe_cut *cut, FILE *to, abbe_report *report,
                               abbe_error *error) {
  ABBE_TRY(abbe_cut_check(cut, error));
  fprintf(to, "GemCad 5.0\ng %d ", cut->gear);
  write_number(to, cut->offset, 1);
  if (cut->folds > 0) fprintf(to, "\ny %d %c", cut->folds, cut->mirror ? 'y' : 'n');
  if (cut->refractive_index > 0) {
    fputs("\nI ", to);
    write_number(to, cut->refractive_index, 3);
  }
  putc('\n', to);
  for (int i = 0; i < ABBE_CUT_LINES; i++)
    if (cut->heading[i]) write_line(to, "H", cut->heading[i]);
  for (size_t t = 0; t < cut->tier_count; t++) write_tier(cut, t, to, report);
  for (int i = 0; i < ABBE_CUT_LINES; i++)
    if (cut->footnote[i]) write_line(to, "F", cut->footnote[i]);
  return ferror(to) ? abbe_error_set(error, ABBE_IO, "the design could not be written") : ABBE_OK;
}
