#include "cli/materials/edit/edit_terminal.h"

#include "cli/base/output.h"

#include <curses.h>
#include <langinfo.h>
#include <locale.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <term.h>
#include <termios.h>
#include <unistd.h>

static SCREEN *screen;
static volatile sig_atomic_t asked_to_end;

/* For a crash, where curses must not be called: the modes, and what the terminal wants to hear. */
static struct termios modes_before;
static char farewell[256];

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

bool abbe_edit_terminal_take(void) {
  static const int ends[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
  static const int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)) return false;
  if (tcgetattr(STDIN_FILENO, &modes_before) != 0) return false;
  setlocale(LC_CTYPE, "");
  for (int i = 0; i < 4; i++)
    handle(ends[i], on_end); /* before curses, which keeps its hands off */
  screen = newterm(NULL, abbe_output_raw(stdout), stdin);
  if (screen == NULL) return false;
  if (cursor_address == NULL) { /* a terminal of lines only, such as TERM=dumb */
    abbe_edit_terminal_give_back();
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

void abbe_edit_terminal_give_back(void) {
  if (screen == NULL) return;
  endwin();
  delscreen(screen);
  screen = NULL;
}

bool abbe_edit_terminal_ended(void) {
  struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
  bool gone = poll(&input, 1, 0) > 0 && (input.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  return asked_to_end || gone;
}

bool abbe_edit_terminal_is_utf8(void) {
  return strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}
