#include "cli/materials/edit/edit_state.h"

#include "base/utf8.h"
#include "colorimetry/plot/text_plot.h"
#include "spectral/editing/check.h"
#include "spectral/materials/material_numbers.h"
#include "spectral/wavelengths.h"

#include <curses.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* text from column x, cut to width characters and filled up with blanks. */
static void edit_put(int y, int x, int width, const char *text) {
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

/* The characters in so many bytes of UTF-8. */
static size_t edit_characters(const char *text, size_t bytes) {
  size_t count = 0;
  for (size_t i = 0; i < bytes; i++) count += ((unsigned char)text[i] & 0xc0) != 0x80;
  return count;
}

static void edit_colour(int pair, bool on) {
  if (!has_colors()) return;
  if (on)
    attron(COLOR_PAIR(pair));
  else
    attroff(COLOR_PAIR(pair));
}

/* The editor's two plots: the index over wavelength, and its difference to the source. */

/* Part of the screen, in characters. */
typedef struct abbe_edit_area {
  int top, rows, left, columns;
} abbe_edit_area;

enum { SAMPLES = 400, LABELS = 10 };
enum { CURVE_BEFORE = 1, CURVE_NOW, CURVE_POINTS };

typedef struct curves {
  double x[SAMPLES + 1], now[SAMPLES + 1], before[SAMPLES + 1];
} curves;

static double index_at(const abbe_material *m, double nm) {
  double n = NAN, k;
  if (m != NULL && abbe_material_is_conductor(m))
    return abbe_material_nk(m, nm, &n, &k, NULL) == ABBE_OK ? n : NAN;
  return m != NULL && abbe_material_n(m, nm, &n, NULL) == ABBE_OK ? n : NAN;
}

static const abbe_material *source_of(const abbe_edit_state *a) {
  const abbe_material *m = a->screen->source.material;
  return m != NULL ? m : abbe_record_draft_original(a->draft);
}

static void sample(const abbe_edit_state *a, const abbe_material *now, curves *out) {
  const double from = ABBE_WAVELENGTH_MIN_NM, to = ABBE_WAVELENGTH_MAX_NM;
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

static void draw_cells(const abbe_edit_state *a, const abbe_text_plot *plot, int top, int left) {
  for (size_t row = 0; row < plot->rows; row++)
    for (size_t i = 0; i < plot->columns; i++) {
      char text[4];
      bool now = abbe_text_plot_curve(plot, i, row) != CURVE_BEFORE;
      if (now) edit_colour(ABBE_EDIT_CURVE, true);
      mvaddstr(top + (int)row, left + (int)i, abbe_text_plot_cell(plot, i, row, a->plain, text));
      if (now) edit_colour(ABBE_EDIT_CURVE, false);
    }
}

/* What one plot shows; before and points may be NULL. */
typedef struct plot_content {
  const char *caption, *format;   /* format: of the ends of its height */
  double least_span;              /* share of its height: rounding errors are no curve */
  const double *x, *now, *before; /* [SAMPLES + 1] */
  const abbe_index_points *points;
  const double *point_y; /* [points->count] */
} plot_content;

static void find_height(const plot_content *p, double *low, double *high) {
  *low = INFINITY, *high = -INFINITY;
  widen(low, high, p->now, SAMPLES + 1);
  if (p->before != NULL) widen(low, high, p->before, SAMPLES + 1);
  if (p->points != NULL) widen(low, high, p->point_y, p->points->count);
  if (!(*low <= *high && *high - *low < p->least_span)) return;
  double middle = (*low + *high) / 2;
  *low = middle - p->least_span / 2;
  *high = middle + p->least_span / 2;
}

/* The ends of its height, where there is one, and of the wavelengths. */
static void draw_ends(abbe_edit_area area, const plot_content *p, const abbe_axis *x,
                      const abbe_axis *y, bool has_height) {
  char text[32];
  if (has_height) {
    snprintf(text, sizeof text, p->format, y->max);
    edit_put(area.top + 1, area.left, LABELS - 1, text);
    snprintf(text, sizeof text, p->format, y->min);
    edit_put(area.top + area.rows - 2, area.left, LABELS - 1, text);
  }
  mvprintw(area.top + area.rows - 1, area.left + LABELS, "%.0f", x->min);
  mvprintw(area.top + area.rows - 1, area.left + area.columns - 6, "%.0f nm", x->max);
}

/* One plot with its caption. */
static void draw_plot(const abbe_edit_state *a, abbe_edit_area area, const plot_content *p) {
  double low, high;
  find_height(p, &low, &high);
  attron(A_BOLD);
  edit_put(area.top, area.left, area.columns, p->caption);
  attroff(A_BOLD);
  const abbe_axis x = {ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, false, false};
  const abbe_axis y = abbe_axis_make(low, high, 0.02, false, false);
  abbe_text_plot plot;
  if (area.rows < 4 || area.columns < LABELS + 10 ||
      abbe_text_plot_make((size_t)(area.columns - LABELS), (size_t)area.rows - 2, x, y, &plot,
                          NULL) != ABBE_OK)
    return;
  if (p->before != NULL) abbe_text_plot_line(&plot, CURVE_BEFORE, SAMPLES + 1, p->x, p->before);
  abbe_text_plot_line(&plot, CURVE_NOW, SAMPLES + 1, p->x, p->now);
  if (p->points != NULL)
    abbe_text_plot_points(&plot, CURVE_POINTS, p->points->count, p->points->lambda_nm, p->point_y);
  draw_cells(a, &plot, area.top + 1, area.left + LABELS);
  abbe_text_plot_free(&plot);
  draw_ends(area, p, &x, &y, low <= high);
}

/* Against points the difference is at them alone, else along the curve. */
static void edit_plot_draw(const abbe_edit_state *a, abbe_edit_area area) {
  static curves c;
  static double residual[SAMPLES + 1];
  const abbe_index_points *points = a->screen->source.points;
  const abbe_material *m = abbe_edit_state_shown(a);
  double *difference = points != NULL ? calloc(points->count, sizeof *difference) : NULL;
  sample(a, m, &c);
  double largest = 0;
  for (size_t i = 0; i <= SAMPLES; i++) residual[i] = c.now[i] - c.before[i];
  for (size_t i = 0; difference != NULL && i < points->count; i++)
    difference[i] = index_at(m, points->lambda_nm[i]) - points->n[i];
  const double *value = difference != NULL ? difference : residual;
  for (size_t i = 0; i < (difference != NULL ? points->count : SAMPLES + 1); i++)
    if (isfinite(value[i])) largest = fmax(largest, fabs(value[i]));
  char caption[160];
  snprintf(caption, sizeof caption, "n - that of %s, up to %.3g",
           a->screen->source.name != NULL ? a->screen->source.name : "the record as opened",
           largest);
  const int upper = area.rows / 2;
  const abbe_edit_area above = {area.top, upper, area.left, area.columns};
  const abbe_edit_area below = {area.top + upper, area.rows - upper, area.left, area.columns};
  draw_plot(a, above,
            &(plot_content){"n over wavelength", "%.5f", 1e-4, c.x, c.now,
                            points != NULL ? NULL : c.before, points,
                            points != NULL ? points->n : NULL});
  for (size_t i = 0; difference != NULL && i <= SAMPLES; i++) residual[i] = NAN;
  draw_plot(a, below,
            &(plot_content){caption, "%+.2e", 1e-6, c.x, residual, NULL,
                            difference != NULL ? points : NULL, difference});
  free(difference);
}

/* ---- the fields ---- */

static void draw_field(const abbe_edit_state *a, size_t index, int y, int width) {
  enum { KEY_WIDTH = 16 };
  const abbe_draft_field *f = abbe_record_draft_field(a->draft, index);
  bool here = index == a->selected;
  char key[48];
  snprintf(key, sizeof key, "%c %s", f->changed ? '*' : ' ', f->key);
  if (f->changed) edit_colour(ABBE_EDIT_CHANGED, true);
  edit_put(y, 0, KEY_WIDTH + 2, key);
  if (f->changed) edit_colour(ABBE_EDIT_CHANGED, false);
  int room = width - KEY_WIDTH - 3;
  if (here) attron(A_REVERSE);
  if (here && a->editing) {
    /* the end of a long text, as far as the cursor is seen */
    size_t skip = edit_characters(a->input, a->cursor), start = 0;
    for (skip = skip >= (size_t)room ? skip - (size_t)room + 1 : 0; skip > 0; skip--) do
        start++;
      while (((unsigned char)a->input[start] & 0xc0) == 0x80);
    edit_put(y, KEY_WIDTH + 2, room, a->input + start);
  } else {
    edit_put(y, KEY_WIDTH + 2, room, f->text);
  }
  if (here) attroff(A_REVERSE);
}

static void draw_fields(abbe_edit_state *a, int top, int rows, int width) {
  size_t count = abbe_record_draft_count(a->draft);
  if (a->selected >= count) a->selected = count - 1;
  if (a->selected < a->first) a->first = a->selected;
  if (a->selected >= a->first + (size_t)rows) a->first = a->selected - (size_t)rows + 1;
  for (int i = 0; i < rows && a->first + (size_t)i < count; i++)
    draw_field(a, a->first + (size_t)i, top + i, width);
}

/* ---- numbers and warnings ---- */

static const char *number(char text[32], const char *format, double value) {
  if (isnan(value)) return "-";
  if (isinf(value)) return "infinite";
  snprintf(text, 32, format, value);
  return text;
}

static void draw_numbers(const abbe_edit_state *a, int y) {
  const abbe_material *m = abbe_edit_state_shown(a);
  char line[200] = "no material: ", text[4][32];
  abbe_material_numbers d;
  if (m != NULL && abbe_material_is_conductor(m)) {
    double n = NAN, k = NAN;
    abbe_material_nk(m, ABBE_LINE_D_NM, &n, &k, NULL);
    snprintf(line, sizeof line, "a conductor: n %s   k %s at %.1f nm", number(text[0], "%.4f", n),
             number(text[1], "%.4f", k), ABBE_LINE_D_NM);
  } else if (m != NULL) {
    abbe_material_numbers_make(m, &d);
    snprintf(line, sizeof line, "n_d %s   V_d %s   B-G %s   n_F - n_C %s",
             number(text[0], "%.6f", d.n_d), number(text[1], "%.3f", d.v_d),
             number(text[2], "%.6f", d.b_g), number(text[3], "%.6f", d.n_F - d.n_C));
  } else {
    snprintf(line, sizeof line, "no material: %.180s", abbe_record_draft_trouble(a->draft));
  }
  attron(A_BOLD);
  edit_put(y, 0, COLS, line);
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
    edit_put(y + used++, 0, COLS, line);
    text += length;
    while (*text == ' ') text++;
  }
  return used;
}

static int draw_warnings(const abbe_edit_state *a, int y, int rows) {
  const abbe_material *m = abbe_edit_state_shown(a);
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
      edit_colour(ABBE_EDIT_WARNING, weight == ABBE_FINDING_WRONG);
      used += put_wrapped(y + used, rows - used, line);
      edit_colour(ABBE_EDIT_WARNING, false);
    }
  if (used == 0 && rows > 0 && m != NULL) edit_put(y + used++, 0, COLS, "no warnings");
  abbe_findings_free(&found);
  return used;
}

/* Above the keys; a long one takes the place of warnings for the while. */
static void draw_message(const abbe_edit_state *a, int warnings) {
  int rows = 1 + (int)(edit_characters(a->message, strlen(a->message)) * 10 / 9) / COLS;
  if (rows > 1 + warnings) rows = 1 + warnings;
  for (int i = 0; i < rows; i++) edit_put(LINES - 1 - rows + i, 0, COLS, "");
  put_wrapped(LINES - 1 - rows, rows, a->message);
}

static const char *keys_line(const abbe_edit_state *a) {
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
    edit_put(i + 2, 2, COLS - 4, lines[i]);
}

void abbe_edit_view_draw(abbe_edit_state *a) {
  char title[300];
  const char *name = abbe_record_draft_field(a->draft, 0)->text;
  erase();
  if (LINES < 8 || COLS < 40) {
    edit_put(0, 0, COLS, "This window is too small: 40 x 8 at least");
    refresh();
    return;
  }
  snprintf(title, sizeof title, " %.140s: %.80s%s", a->screen->path, name,
           abbe_record_draft_is_changed(a->draft) ? "  (changed)" : "");
  attron(A_REVERSE);
  edit_put(0, 0, COLS, title);
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
  if (plots) edit_plot_draw(a, (abbe_edit_area){1, body + 1, width + 1, COLS - width - 1});
  draw_numbers(a, LINES - 3 - warnings);
  draw_warnings(a, LINES - 2 - warnings, warnings);
  draw_message(a, warnings);
  attron(A_DIM);
  edit_put(LINES - 1, 0, COLS - 1, keys_line(a));
  attroff(A_DIM);
  curs_set(a->editing ? 1 : 0);
  if (a->editing) {
    int x = 18 + (int)edit_characters(a->input, a->cursor), most = width - 2;
    move(2 + (int)(a->selected - a->first), x > most ? most : x);
  }
  refresh();
}
