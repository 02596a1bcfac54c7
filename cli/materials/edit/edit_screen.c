#include "cli/materials/edit/edit_screen.h"

#include "base/number.h"
#include "cli/base/output.h"
#include "cli/materials/edit/edit_state.h"
#include "spectral/editing/check.h"

#include <curses.h>
#include <langinfo.h>
#include <locale.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <term.h>
#include <termios.h>
#include <unistd.h>

/* Takes the terminal for a full screen, and gives it back on every way out. */

static SCREEN *terminal;
static volatile sig_atomic_t asked_to_end;

/* For a crash, where curses must not be called: the modes, and what the terminal wants to hear. */
static struct termios modes_before;
static char farewell[256];

static void edit_terminal_give_back(void);

static void on_end(int number) {
  (void)number;
  asked_to_end = 1;
}

static void on_crash(int number) {
  (void)!write(STDOUT_FILENO, farewell, strlen(farewell));
  tcsetattr(STDIN_FILENO, TCSANOW, &modes_before);
  signal(number, SIG_DFL);
  raise(number);
}

static void handle(int number, void (*handler)(int)) {
  struct sigaction action = {.sa_handler = handler};
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, NULL);
}

static void append_capability(const char *name) {
  char capability[32];
  strcpy(capability, name);
  const char *text = tigetstr(capability);
  if (text == NULL || text == (const char *)-1) return;
  if (strlen(farewell) + strlen(text) < sizeof farewell) strcat(farewell, text);
}

/* Takes standard input and output; false where they are no terminal that curses can draw on. */
static bool edit_terminal_take(void) {
  static const int ends[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
  static const int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)) return false;
  if (tcgetattr(STDIN_FILENO, &modes_before) != 0) return false;
  setlocale(LC_CTYPE, "");
  for (int i = 0; i < 4; i++)
    handle(ends[i], on_end); /* before curses, which keeps its hands off */
  terminal = newterm(NULL, abbe_output_raw(stdout), stdin);
  if (terminal == NULL) return false;
  if (cursor_address == NULL) { /* a terminal of lines only, such as TERM=dumb */
    edit_terminal_give_back();
    return false;
  }
  farewell[0] = '\0';
  append_capability("sgr0");
  append_capability("cnorm");
  append_capability("rmkx");
  append_capability("rmcup");
  for (int i = 0; i < 5; i++) handle(crashes[i], on_crash);
  cbreak();
  noecho();
  keypad(stdscr, TRUE);
  set_escdelay(25);
  timeout(250);
  return true;
}

static void edit_terminal_give_back(void) {
  if (terminal == NULL) return;
  endwin();
  delscreen(terminal);
  terminal = NULL;
}

/* Whether a signal requested the end, or the terminal has hung up. */
static bool edit_terminal_ended(void) {
  struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
  bool gone = poll(&input, 1, 0) > 0 && (input.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  return asked_to_end || gone;
}

/* Whether its characters are UTF-8. */
static bool edit_terminal_is_utf8(void) {
  return strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}

enum { CTRL_L = 12, CTRL_R = 18, ESCAPE = 27 };

static void say(abbe_edit_state *a, const char *text) {
  snprintf(a->message, sizeof a->message, "%s", text);
}

/* ---- typing ---- */

static void forget_preview(abbe_edit_state *a) {
  if (a->has_preview) abbe_material_free(&a->preview);
  a->has_preview = false;
}

static void preview(abbe_edit_state *a) {
  abbe_error error = {0};
  forget_preview(a);
  a->has_preview =
      abbe_record_draft_try(a->draft, a->selected, a->input, &a->preview, &error) == ABBE_OK;
  say(a, a->has_preview ? "" : error.text);
  if (!a->has_preview) abbe_material_free(&a->preview);
}

static void begin(abbe_edit_state *a, const char *text) {
  if (strlen(text) >= ABBE_EDIT_MAX_INPUT) {
    say(a, "This text is too long for one line here; edit it in the file, or with 'set'");
    return;
  }
  a->editing = true;
  a->length = strlen(text);
  a->cursor = a->length;
  memmove(a->input, text, a->length + 1);
  preview(a);
}

static void commit(abbe_edit_state *a, const char *text) {
  abbe_error error = {0};
  forget_preview(a);
  abbe_result result = abbe_record_draft_set(a->draft, a->selected, text, &error);
  say(a, result == ABBE_OK ? "" : error.text);
  a->editing = a->editing && result != ABBE_OK;
}

static size_t step(const abbe_edit_state *a, size_t at, int direction) {
  if (direction < 0 && at == 0) return at;
  if (direction > 0 && at >= a->length) return at;
  do at += (size_t)direction;
  while (at > 0 && at < a->length && ((unsigned char)a->input[at] & 0xc0) == 0x80);
  return at;
}

static void cut(abbe_edit_state *a, size_t from, size_t to) {
  memmove(a->input + from, a->input + to, a->length - to + 1);
  a->length -= to - from;
  a->cursor = from;
  preview(a);
}

static void type(abbe_edit_state *a, int key) {
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
    if (key < 0x20 || key > 0xff || a->length + 1 >= ABBE_EDIT_MAX_INPUT) return;
    memmove(a->input + a->cursor + 1, a->input + a->cursor, a->length - a->cursor + 1);
    a->input[a->cursor++] = (char)key;
    a->length++;
    preview(a);
  }
}

/* ---- commands ---- */

/* The number's last digit, up or down by `units`; its other digits and its exponent stay. */
static void nudge(abbe_edit_state *a, int units) {
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

static void save(abbe_edit_state *a) {
  abbe_error error = {0};
  if (!abbe_record_draft_is_changed(a->draft))
    say(a, "Nothing has changed since it was last saved");
  else if (abbe_record_draft_save(a->draft, &error) == ABBE_OK)
    say(a, "Saved");
  else
    say(a, error.text);
}

/* Puts in the first fix that is certain. */
static void fix(abbe_edit_state *a) {
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

static void resize_record(abbe_edit_state *a, bool more) {
  abbe_error error = {0};
  abbe_result result = abbe_record_draft_resize(a->draft, more, &error);
  say(a, result == ABBE_OK ? "" : error.text);
}

static void answer(abbe_edit_state *a, int key) {
  if (key == 'y' || key == 'Y') save(a);
  bool saved = !abbe_record_draft_is_changed(a->draft);
  if (key == 'n' || key == 'N' || ((key == 'y' || key == 'Y') && saved)) a->left = true;
  if (key == 'y' || key == 'Y' || key == 'n' || key == 'N' || key == ESCAPE) a->asking = false;
}

static void letter(abbe_edit_state *a, int key) {
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

static void command(abbe_edit_state *a, int key) {
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

static void take(abbe_edit_state *a, int key) {
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
  if (!edit_terminal_take()) return ABBE_EDIT_NO_TERMINAL;
  static abbe_edit_state a;
  a = (abbe_edit_state){
      .screen = screen, .draft = screen->draft, .plain = !edit_terminal_is_utf8()};
  if (has_colors()) {
    start_color();
    use_default_colors();
    init_pair(ABBE_EDIT_WARNING, COLOR_RED, -1);
    init_pair(ABBE_EDIT_CHANGED, COLOR_YELLOW, -1);
    init_pair(ABBE_EDIT_CURVE, COLOR_CYAN, -1);
  }
  bool fresh = true;
  while (!a.left && !edit_terminal_ended()) {
    if (fresh) abbe_edit_view_draw(&a);
    int key = getch();
    fresh = key != ERR;
    if (fresh) take(&a, key);
  }
  forget_preview(&a);
  edit_terminal_give_back();
  return a.left ? ABBE_EDIT_QUIT : ABBE_EDIT_INTERRUPTED;
}
