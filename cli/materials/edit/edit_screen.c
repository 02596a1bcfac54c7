#include "cli/materials/edit/edit_screen.h"

#include "cli/materials/edit/edit_terminal.h"

#include "base/number.h"
#include "base/utf8.h"
#include "colorimetry/plot/text_plot.h"
#include "spectral/editing/check.h"
#include "spectral/materials/material_numbers.h"
#include "spectral/wavelengths.h"

#include <curses.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_INPUT = 400, SAMPLES = 400, LABELS = 10 };
enum { CURVE_BEFORE = 1, CURVE_NOW, CURVE_POINTS };
enum { PAIR_WARNING = 1, PAIR_CHANGED, PAIR_CURVE };
enum { CTRL_L = 12, CTRL_R = 18, ESCAPE = 27 };

typedef struct app {
  const abbe_edit_screen *screen;
  abbe_record_draft *draft;
  size_t selected, first; /* field; the first one on the screen */
  bool editing, asking, helping, plain, left;
  char input[MAX_INPUT]; /* while editing */
  size_t length, cursor; /* bytes */
  char message[1024];
  abbe_material preview; /* of what is being typed */
  bool has_preview;
} app;

static void say(app *a, const char *text) {
  snprintf(a->message, sizeof a->message, "%s", text);
}

static const abbe_material *shown(const app *a) {
  return a->has_preview ? &a->preview : abbe_record_draft_material(a->draft);
}

/* ---- text on the screen ---- */

/* text from column x, cut to width characters and filled up with blanks. */
static void put(int y, int x, int width, const char *text) {
  char shown[2048];
  int used = 0;
  move(y, x);
  abbe_utf8_printable(text, strlen(text), false, shown, sizeof shown);
  for (const char *c = shown; *c != '\0' && used < width; used++) {
    const size_t size = abbe_utf8_letter(c);
    addnstr(c, (int)size);
    c += size;
  }
  for (; used < width; used++) addch(' ');
}

static size_t characters(const char *text, size_t bytes) {
  size_t count = 0;
  for (size_t i = 0; i < bytes; i++) count += ((unsigned char)text[i] & 0xc0) != 0x80;
  return count;
}

static void colour(int pair, bool on) {
  if (!has_colors()) return;
  if (on)
    attron(COLOR_PAIR(pair));
  else
    attroff(COLOR_PAIR(pair));
}

/* ---- the fields ---- */

static void draw_field(const app *a, size_t index, int y, int width) {
  enum { KEY_WIDTH = 16 };
  const abbe_draft_field *f = abbe_record_draft_field(a->draft, index);
  bool here = index == a->selected;
  char key[48];
  snprintf(key, sizeof key, "%c %s", f->changed ? '*' : ' ', f->key);
  if (f->changed) colour(PAIR_CHANGED, true);
  put(y, 0, KEY_WIDTH + 2, key);
  if (f->changed) colour(PAIR_CHANGED, false);
  int room = width - KEY_WIDTH - 3;
  if (here) attron(A_REVERSE);
  if (here && a->editing) {
    /* the end of a long text, as far as the cursor is seen */
    size_t skip = characters(a->input, a->cursor), start = 0;
    for (skip = skip >= (size_t)room ? skip - (size_t)room + 1 : 0; skip > 0; skip--) do
        start++;
      while (((unsigned char)a->input[start] & 0xc0) == 0x80);
    put(y, KEY_WIDTH + 2, room, a->input + start);
  } else {
    put(y, KEY_WIDTH + 2, room, f->text);
  }
  if (here) attroff(A_REVERSE);
}

static void draw_fields(app *a, int top, int rows, int width) {
  size_t count = abbe_record_draft_count(a->draft);
  if (a->selected >= count) a->selected = count - 1;
  if (a->selected < a->first) a->first = a->selected;
  if (a->selected >= a->first + (size_t)rows) a->first = a->selected - (size_t)rows + 1;
  for (int i = 0; i < rows && a->first + (size_t)i < count; i++)
    draw_field(a, a->first + (size_t)i, top + i, width);
}

/* ---- the plots ---- */

typedef struct curves {
  size_t count;
  double x[SAMPLES + 1], now[SAMPLES + 1], before[SAMPLES + 1];
} curves;

static double index_at(const abbe_material *m, double nm) {
  double n = NAN;
  return m != NULL && abbe_material_n(m, nm, &n, NULL) == ABBE_OK ? n : NAN;
}

static const abbe_material *source_of(const app *a) {
  const abbe_material *m = a->screen->source.material;
  return m != NULL ? m : abbe_record_draft_original(a->draft);
}

static void sample(const app *a, const abbe_material *now, curves *out) {
  const double from = ABBE_WAVELENGTH_MIN_NM, to = ABBE_WAVELENGTH_MAX_NM;
  out->count = SAMPLES + 1;
  for (int i = 0; i <= SAMPLES; i++) {
    out->x[i] = from + (to - from) * i / SAMPLES;
    out->now[i] = index_at(now, out->x[i]);
    out->before[i] = index_at(source_of(a), out->x[i]);
  }
}

static void widen(double *low, double *high, const double *value, size_t count) {
  for (size_t i = 0; i < count; i++) {
    if (!isfinite(value[i])) continue;
    *low = fmin(*low, value[i]);
    *high = fmax(*high, value[i]);
  }
}

static void draw_cells(const app *a, const abbe_text_plot *plot, int top, int left) {
  for (size_t row = 0; row < plot->rows; row++)
    for (size_t i = 0; i < plot->columns; i++) {
      char text[4];
      bool now = abbe_text_plot_curve(plot, i, row) != CURVE_BEFORE;
      if (now) colour(PAIR_CURVE, true);
      mvaddstr(top + (int)row, left + (int)i, abbe_text_plot_cell(plot, i, row, a->plain, text));
      if (now) colour(PAIR_CURVE, false);
    }
}

/* One plot with its caption, the ends of its height and of the wavelengths. */
static void draw_plot(const app *a, int top, int rows, int left, int columns, const char *caption,
                      const char *format, double least_span, const curves *c, const double *now,
                      const double *before, const abbe_index_points *points,
                      const double *point_y) {
  double low = INFINITY, high = -INFINITY;
  char text[32];
  widen(&low, &high, now, c->count);
  if (before != NULL) widen(&low, &high, before, c->count);
  if (points != NULL) widen(&low, &high, point_y, points->count);
  attron(A_BOLD);
  put(top, left, columns, caption);
  attroff(A_BOLD);
  abbe_axis x = {ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, false, false};
  if (low <= high && high - low < least_span) { /* rounding errors are no curve */
    double middle = (low + high) / 2;
    low = middle - least_span / 2;
    high = middle + least_span / 2;
  }
  abbe_axis y = abbe_axis_make(low, high, 0.02, false, false);
  abbe_text_plot plot;
  if (rows < 4 || columns < LABELS + 10 ||
      abbe_text_plot_make((size_t)(columns - LABELS), (size_t)rows - 2, x, y, &plot, NULL) !=
          ABBE_OK)
    return;
  if (before != NULL) abbe_text_plot_line(&plot, CURVE_BEFORE, c->count, c->x, before);
  abbe_text_plot_line(&plot, CURVE_NOW, c->count, c->x, now);
  if (points != NULL)
    abbe_text_plot_points(&plot, CURVE_POINTS, points->count, points->lambda_nm, point_y);
  draw_cells(a, &plot, top + 1, left + LABELS);
  abbe_text_plot_free(&plot);
  if (low <= high) {
    snprintf(text, sizeof text, format, y.max);
    put(top + 1, left, LABELS - 1, text);
    snprintf(text, sizeof text, format, y.min);
    put(top + rows - 2, left, LABELS - 1, text);
  }
  mvprintw(top + rows - 1, left + LABELS, "%.0f", x.min);
  mvprintw(top + rows - 1, left + columns - 6, "%.0f nm", x.max);
}

static void draw_plots(const app *a, int top, int rows, int left, int columns) {
  static curves c;
  static double residual[SAMPLES + 1];
  const abbe_index_points *points = a->screen->source.points;
  const abbe_material *m = shown(a);
  double *difference = points != NULL ? calloc(points->count, sizeof *difference) : NULL;
  sample(a, m, &c);
  double largest = 0;
  for (size_t i = 0; i < c.count; i++) residual[i] = c.now[i] - c.before[i];
  for (size_t i = 0; difference != NULL && i < points->count; i++)
    difference[i] = index_at(m, points->lambda_nm[i]) - points->n[i];
  const double *value = difference != NULL ? difference : residual;
  for (size_t i = 0; i < (difference != NULL ? points->count : c.count); i++)
    if (isfinite(value[i])) largest = fmax(largest, fabs(value[i]));
  char caption[160];
  snprintf(caption, sizeof caption, "n - that of %s, up to %.3g",
           a->screen->source.name != NULL ? a->screen->source.name : "the record as opened",
           largest);
  int upper = rows / 2;
  draw_plot(a, top, upper, left, columns, "n over wavelength", "%.5f", 1e-4, &c, c.now,
            points != NULL ? NULL : c.before, points, points != NULL ? points->n : NULL);
  for (size_t i = 0; difference != NULL && i < c.count; i++) residual[i] = NAN;
  draw_plot(a, top + upper, rows - upper, left, columns, caption, "%+.2e", 1e-6, &c, residual, NULL,
            difference != NULL ? points : NULL, difference);
  free(difference);
}

/* ---- numbers and warnings ---- */

static const char *number(char text[32], const char *format, double value) {
  if (isnan(value)) return "-";
  if (isinf(value)) return "infinite";
  snprintf(text, 32, format, value);
  return text;
}

static void draw_numbers(const app *a, int y) {
  const abbe_material *m = shown(a);
  char line[200] = "no material: ", text[4][32];
  abbe_material_numbers d;
  if (m != NULL) {
    abbe_material_numbers_make(m, &d);
    snprintf(line, sizeof line, "n_d %s   V_d %s   B-G %s   n_F - n_C %s",
             number(text[0], "%.6f", d.n_d), number(text[1], "%.3f", d.v_d),
             number(text[2], "%.6f", d.b_g), number(text[3], "%.6f", d.n_F - d.n_C));
  } else {
    snprintf(line, sizeof line, "no material: %.180s", abbe_record_draft_trouble(a->draft));
  }
  attron(A_BOLD);
  put(y, 0, COLS, line);
  attroff(A_BOLD);
}

/* The text over as many of the rows as it wants, broken at blanks; how many it took. */
static int put_wrapped(int y, int rows, const char *text) {
  int used = 0;
  while (*text != '\0' && used < rows) {
    size_t length = strlen(text);
    if (length > (size_t)COLS && used + 1 < rows) {
      length = (size_t)COLS;
      while (length > 0 && text[length] != ' ') length--;
      if (length == 0) length = (size_t)COLS;
    }
    char line[1100];
    snprintf(line, sizeof line, "%.*s", (int)length, text);
    put(y + used++, 0, COLS, line);
    text += length;
    while (*text == ' ') text++;
  }
  return used;
}

static int draw_warnings(const app *a, int y, int rows) {
  const abbe_material *m = shown(a);
  abbe_findings found = {0};
  int used = 0;
  if (m != NULL) abbe_check_material(m, a->screen->known, &found, NULL);
  for (int weight = ABBE_FINDING_WRONG; weight >= ABBE_FINDING_NOTE; weight--)
    for (size_t i = 0; i < found.count && used < rows; i++) {
      const abbe_finding *f = &found.finding[i];
      if ((int)f->weight != weight) continue;
      char line[1000];
      snprintf(line, sizeof line, "%s: %s; %s", abbe_finding_weight_name(f->weight), f->evidence,
               f->fix);
      colour(PAIR_WARNING, weight == ABBE_FINDING_WRONG);
      used += put_wrapped(y + used, rows - used, line);
      colour(PAIR_WARNING, false);
    }
  if (used == 0 && rows > 0 && m != NULL) put(y + used++, 0, COLS, "no warnings");
  abbe_findings_free(&found);
  return used;
}

/* Above the keys; a long one takes the place of warnings for the while. */
static void draw_message(const app *a, int warnings) {
  int rows = 1 + (int)(characters(a->message, strlen(a->message)) * 10 / 9) / COLS;
  if (rows > 1 + warnings) rows = 1 + warnings;
  for (int i = 0; i < rows; i++) put(LINES - 1 - rows + i, 0, COLS, "");
  put_wrapped(LINES - 1 - rows, rows, a->message);
}

static const char *keys_line(const app *a) {
  if (a->asking) return "There are changes. Save them?  y yes   n no   Esc back";
  if (a->editing) return "Enter keep   Esc leave as it was   (shown as you type)";
  return "Enter edit  s save  q quit  Q quit unsaved  ? help  u undo  r redo  f fix";
}

static void draw_help(void) {
  static const char *const lines[] = {
      "Up, Down         another field",
      "Enter            edit its text; a digit, '-' or '.' begins a new number",
      "Left, Right      the number's last digit down or up: watch the curves",
      "PgDn, PgUp       the same by ten",
      "Delete           empty the field, which takes an optional key out of the record",
      "u, r             undo, redo",
      "+, X             a coefficient more at the end, or one fewer",
      "f                put in the first fix that the check is certain of",
      "s                save: only this record's bytes change in the file",
      "q                quit, asking first where there are changes",
      "Q                quit without saving",
      "Ctrl-L           draw the screen anew",
      "",
      "Above are the index over wavelength and its difference to the source; below n_d,",
      "V_d and what the check of the record finds. A * marks a field that differs from the file.",
      "",
      "Any key goes back."};
  for (int i = 0; i < (int)(sizeof lines / sizeof lines[0]) && i + 2 < LINES; i++)
    put(i + 2, 2, COLS - 4, lines[i]);
}

static void draw(app *a) {
  char title[300];
  const char *name = abbe_record_draft_field(a->draft, 0)->text;
  erase();
  if (LINES < 8 || COLS < 40) {
    put(0, 0, COLS, "This window is too small: 40 x 8 at least");
    refresh();
    return;
  }
  snprintf(title, sizeof title, " %.140s: %.80s%s", a->screen->path, name,
           abbe_record_draft_is_changed(a->draft) ? "  (changed)" : "");
  attron(A_REVERSE);
  put(0, 0, COLS, title);
  attroff(A_REVERSE);
  if (a->helping) {
    draw_help();
    refresh();
    return;
  }
  int warnings = LINES >= 20 ? 4 : 1, body = LINES - 5 - warnings;
  bool plots = COLS >= 76 && body >= 8;
  int width = plots ? COLS * 2 / 5 : COLS;
  draw_fields(a, 2, body, width);
  if (plots) draw_plots(a, 1, body + 1, width + 1, COLS - width - 1);
  draw_numbers(a, LINES - 3 - warnings);
  draw_warnings(a, LINES - 2 - warnings, warnings);
  draw_message(a, warnings);
  attron(A_DIM);
  put(LINES - 1, 0, COLS - 1, keys_line(a));
  attroff(A_DIM);
  curs_set(a->editing ? 1 : 0);
  if (a->editing) {
    int x = 18 + (int)characters(a->input, a->cursor), most = width - 2;
    move(2 + (int)(a->selected - a->first), x > most ? most : x);
  }
  refresh();
}

/* ---- typing ---- */

static void forget_preview(app *a) {
  if (a->has_preview) abbe_material_free(&a->preview);
  a->has_preview = false;
}

static void preview(app *a) {
  abbe_error error = {0};
  forget_preview(a);
  a->has_preview =
      abbe_record_draft_try(a->draft, a->selected, a->input, &a->preview, &error) == ABBE_OK;
  say(a, a->has_preview ? "" : error.text);
  if (!a->has_preview) abbe_material_free(&a->preview);
}

static void begin(app *a, const char *text) {
  if (strlen(text) >= MAX_INPUT) {
    say(a, "This text is too long for one line here; edit it in the file, or with 'set'");
    return;
  }
  a->editing = true;
  a->length = strlen(text);
  a->cursor = a->length;
  memmove(a->input, text, a->length + 1);
  preview(a);
}

static void commit(app *a, const char *text) {
  abbe_error error = {0};
  forget_preview(a);
  abbe_result result = abbe_record_draft_set(a->draft, a->selected, text, &error);
  say(a, result == ABBE_OK ? "" : error.text);
  a->editing = a->editing && result != ABBE_OK;
}

static size_t step(const app *a, size_t at, int direction) {
  if (direction < 0 && at == 0) return at;
  if (direction > 0 && at >= a->length) return at;
  do at += (size_t)direction;
  while (at > 0 && at < a->length && ((unsigned char)a->input[at] & 0xc0) == 0x80);
  return at;
}

static void cut(app *a, size_t from, size_t to) {
  memmove(a->input + from, a->input + to, a->length - to + 1);
  a->length -= to - from;
  a->cursor = from;
  preview(a);
}

static void type(app *a, int key) {
  switch (key) {
  case ESCAPE:
    a->editing = false;
    forget_preview(a);
    say(a, "");
    return;
  case '\n':
  case '\r':
  case KEY_ENTER:
    commit(a, a->input);
    return;
  case KEY_LEFT:
    a->cursor = step(a, a->cursor, -1);
    return;
  case KEY_RIGHT:
    a->cursor = step(a, a->cursor, 1);
    return;
  case KEY_HOME:
    a->cursor = 0;
    return;
  case KEY_END:
    a->cursor = a->length;
    return;
  case KEY_BACKSPACE:
  case '\b':
  case 127:
    cut(a, step(a, a->cursor, -1), a->cursor);
    return;
  case KEY_DC:
    cut(a, a->cursor, step(a, a->cursor, 1));
    return;
  default:
    if (key < 0x20 || key > 0xff || a->length + 1 >= MAX_INPUT) return;
    memmove(a->input + a->cursor + 1, a->input + a->cursor, a->length - a->cursor + 1);
    a->input[a->cursor++] = (char)key;
    a->length++;
    preview(a);
  }
}

/* ---- commands ---- */

/* The number's last digit, up or down by `units`; its other digits and its exponent stay. */
static void nudge(app *a, int units) {
  const abbe_draft_field *f = abbe_record_draft_field(a->draft, a->selected);
  if (!f->number || f->text[0] == '\0') {
    say(a, "Left and Right change the last digit of a number");
    return;
  }
  const char *point = strchr(f->text, '.');
  size_t decimals = point != NULL ? strspn(point + 1, "0123456789") : 0;
  const char *exponent = f->text + strcspn(f->text, "eE");
  if (decimals > 17) return;
  char text[80];
  const char *end;
  double value = 0;
  snprintf(text, sizeof text, "%.*s", (int)(exponent - f->text), f->text);
  if (!abbe_number_read(text, &end, &value)) return;
  snprintf(text, sizeof text, "%.*f%.16s", (int)decimals,
           value + units * pow(10, -(double)decimals), exponent);
  commit(a, text);
}

static void save(app *a) {
  abbe_error error = {0};
  if (!abbe_record_draft_is_changed(a->draft))
    say(a, "Nothing has changed since it was last saved");
  else if (abbe_record_draft_save(a->draft, &error) == ABBE_OK)
    say(a, "Saved");
  else
    say(a, error.text);
}

/* Puts in the first fix that is certain. */
static void fix(app *a) {
  const abbe_material *m = abbe_record_draft_material(a->draft);
  abbe_findings found = {0};
  abbe_error error = {0};
  say(a, "The check knows no certain fix for this record");
  if (m != NULL) abbe_check_material(m, a->screen->known, &found, NULL);
  for (size_t i = 0; i < found.count; i++) {
    const abbe_finding *f = &found.finding[i];
    if (!f->certain || f->key == NULL || f->value == NULL) continue;
    abbe_result result = abbe_record_draft_put(a->draft, f->key, f->value, &error);
    say(a, result == ABBE_OK ? f->fix : error.text);
    break;
  }
  abbe_findings_free(&found);
}

static void resize_record(app *a, bool more) {
  abbe_error error = {0};
  abbe_result result = abbe_record_draft_resize(a->draft, more, &error);
  say(a, result == ABBE_OK ? "" : error.text);
}

static void answer(app *a, int key) {
  if (key == 'y' || key == 'Y') save(a);
  bool saved = !abbe_record_draft_is_changed(a->draft);
  if (key == 'n' || key == 'N' || ((key == 'y' || key == 'Y') && saved)) a->left = true;
  if (key == 'y' || key == 'Y' || key == 'n' || key == 'N' || key == ESCAPE) a->asking = false;
}

static void letter(app *a, int key) {
  switch (key) {
  case 'u':
    say(a, abbe_record_draft_undo(a->draft) ? "Undone" : "There is nothing to undo");
    return;
  case 'r':
  case CTRL_R:
    say(a, abbe_record_draft_redo(a->draft) ? "Done again" : "There is nothing to redo");
    return;
  case '+':
  case 'X':
    resize_record(a, key == '+');
    return;
  case 'f':
    fix(a);
    return;
  case 's':
    save(a);
    return;
  case 'q':
    a->asking = abbe_record_draft_is_changed(a->draft);
    a->left = !a->asking;
    return;
  case 'Q':
    a->left = true;
    return;
  case '?':
  case 'h':
    a->helping = true;
    return;
  default:
    say(a, "This key does nothing here; ? shows those that do");
  }
}

static void command(app *a, int key) {
  const abbe_draft_field *f = abbe_record_draft_field(a->draft, a->selected);
  bool digit = (key >= '0' && key <= '9') || key == '-' || key == '.';
  if (digit && f->number) {
    begin(a, "");
    type(a, key);
    return;
  }
  switch (key) {
  case KEY_UP:
  case 'k':
    if (a->selected > 0) a->selected--;
    return;
  case KEY_DOWN:
  case 'j':
  case '\t':
    if (a->selected + 1 < abbe_record_draft_count(a->draft)) a->selected++;
    return;
  case KEY_HOME:
    a->selected = 0;
    return;
  case KEY_END:
    a->selected = abbe_record_draft_count(a->draft) - 1;
    return;
  case '\n':
  case '\r':
  case KEY_ENTER:
    begin(a, f->text);
    return;
  case KEY_LEFT:
  case KEY_RIGHT:
    nudge(a, key == KEY_LEFT ? -1 : 1);
    return;
  case KEY_PPAGE:
  case KEY_NPAGE:
    nudge(a, key == KEY_NPAGE ? -10 : 10);
    return;
  case KEY_DC:
    commit(a, "");
    return;
  default:
    letter(a, key);
  }
}

static void take(app *a, int key) {
  if (key == KEY_RESIZE) return;
  if (key == CTRL_L) {
    clearok(curscr, TRUE);
    return;
  }
  if (a->helping)
    a->helping = false;
  else if (a->asking)
    answer(a, key);
  else if (a->editing)
    type(a, key);
  else
    command(a, key);
}

abbe_edit_end abbe_edit_screen_run(const abbe_edit_screen *screen) {
  if (!abbe_edit_terminal_take()) return ABBE_EDIT_NO_TERMINAL;
  static app a;
  a = (app){.screen = screen, .draft = screen->draft, .plain = !abbe_edit_terminal_is_utf8()};
  if (has_colors()) {
    start_color();
    use_default_colors();
    init_pair(PAIR_WARNING, COLOR_RED, -1);
    init_pair(PAIR_CHANGED, COLOR_YELLOW, -1);
    init_pair(PAIR_CURVE, COLOR_CYAN, -1);
  }
  bool fresh = true;
  while (!a.left && !abbe_edit_terminal_ended()) {
    if (fresh) draw(&a);
    int key = getch();
    fresh = key != ERR;
    if (fresh) take(&a, key);
  }
  forget_preview(&a);
  abbe_edit_terminal_give_back();
  return a.left ? ABBE_EDIT_QUIT : ABBE_EDIT_INTERRUPTED;
}
