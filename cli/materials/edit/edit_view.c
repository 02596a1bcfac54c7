#include "cli/materials/edit/edit_view.h"

#include "cli/materials/edit/edit_cells.h"
#include "cli/materials/edit/edit_plot.h"

#include "spectral/editing/check.h"
#include "spectral/materials/material_numbers.h"

#include <curses.h>
#include <math.h>
#include <string.h>

/* ---- the fields ---- */

static void draw_field(const abbe_edit_state *a, size_t index, int y, int width) {
  enum { KEY_WIDTH = 16 };
  const abbe_draft_field *f = abbe_record_draft_field(a->draft, index);
  bool here = index == a->selected;
  char key[48];
  snprintf(key, sizeof key, "%c %s", f->changed ? '*' : ' ', f->key);
  if (f->changed) abbe_edit_colour(ABBE_EDIT_CHANGED, true);
  abbe_edit_put(y, 0, KEY_WIDTH + 2, key);
  if (f->changed) abbe_edit_colour(ABBE_EDIT_CHANGED, false);
  int room = width - KEY_WIDTH - 3;
  if (here) attron(A_REVERSE);
  if (here && a->editing) {
    /* the end of a long text, as far as the cursor is seen */
    size_t skip = abbe_edit_characters(a->input, a->cursor), start = 0;
    for (skip = skip >= (size_t)room ? skip - (size_t)room + 1 : 0; skip > 0; skip--) do
        start++;
      while (((unsigned char)a->input[start] & 0xc0) == 0x80);
    abbe_edit_put(y, KEY_WIDTH + 2, room, a->input + start);
  } else {
    abbe_edit_put(y, KEY_WIDTH + 2, room, f->text);
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
  abbe_edit_put(y, 0, COLS, line);
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
    abbe_edit_put(y + used++, 0, COLS, line);
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
      abbe_edit_colour(ABBE_EDIT_WARNING, weight == ABBE_FINDING_WRONG);
      used += put_wrapped(y + used, rows - used, line);
      abbe_edit_colour(ABBE_EDIT_WARNING, false);
    }
  if (used == 0 && rows > 0 && m != NULL) abbe_edit_put(y + used++, 0, COLS, "no warnings");
  abbe_findings_free(&found);
  return used;
}

/* Above the keys; a long one takes the place of warnings for the while. */
static void draw_message(const abbe_edit_state *a, int warnings) {
  int rows = 1 + (int)(abbe_edit_characters(a->message, strlen(a->message)) * 10 / 9) / COLS;
  if (rows > 1 + warnings) rows = 1 + warnings;
  for (int i = 0; i < rows; i++) abbe_edit_put(LINES - 1 - rows + i, 0, COLS, "");
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
    abbe_edit_put(i + 2, 2, COLS - 4, lines[i]);
}

void abbe_edit_view_draw(abbe_edit_state *a) {
  char title[300];
  const char *name = abbe_record_draft_field(a->draft, 0)->text;
  erase();
  if (LINES < 8 || COLS < 40) {
    abbe_edit_put(0, 0, COLS, "This window is too small: 40 x 8 at least");
    refresh();
    return;
  }
  snprintf(title, sizeof title, " %.140s: %.80s%s", a->screen->path, name,
           abbe_record_draft_is_changed(a->draft) ? "  (changed)" : "");
  attron(A_REVERSE);
  abbe_edit_put(0, 0, COLS, title);
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
  if (plots) abbe_edit_plot_draw(a, (abbe_edit_area){1, body + 1, width + 1, COLS - width - 1});
  draw_numbers(a, LINES - 3 - warnings);
  draw_warnings(a, LINES - 2 - warnings, warnings);
  draw_message(a, warnings);
  attron(A_DIM);
  abbe_edit_put(LINES - 1, 0, COLS - 1, keys_line(a));
  attroff(A_DIM);
  curs_set(a->editing ? 1 : 0);
  if (a->editing) {
    int x = 18 + (int)abbe_edit_characters(a->input, a->cursor), most = width - 2;
    move(2 + (int)(a->selected - a->first), x > most ? most : x);
  }
  refresh();
}
