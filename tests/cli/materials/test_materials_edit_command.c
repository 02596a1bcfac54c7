/* `abbe materials edit` on a terminal of its own: what it shows, saves, and leaves behind. */
#define _DEFAULT_SOURCE 1
#define _XOPEN_SOURCE 700
#include "tests/cli/run_program.h"

#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <termios.h>
#include <time.h>

#define UP "\033OA"
#define DOWN "\033OB"
#define RIGHT "\033OC"
#define REDRAW "\014"
#define LEAVES "\033[?1049l" /* what an xterm is told at the end of a full screen */

static const char table[] = "# glasses\nmaterials:\n"
                            "- name: k5 # a crown\n  model: cauchy\n"
                            "  coefficients: [1.5220, 0.00459]\n  range_nm: [380, 780]\n"
                            "  source: \"me: 3 May\"\n"
                            "- {name: flint, model: constant, coefficients: [1.6], source: x}\n";

static int master = -1, slave = -1;
static pid_t child;
static char path[96], seen[1 << 20];
static size_t seen_size;
static struct termios before;
static const char *terminal = "xterm";

/* ---- a terminal ---- */

static void set_size(unsigned short rows, unsigned short columns) {
  struct winsize size = {.ws_row = rows, .ws_col = columns};
  assert_int_equal(ioctl(master, TIOCSWINSZ, &size), 0);
}

static void start(const char *more, unsigned short rows, unsigned short columns) {
  master = posix_openpt(O_RDWR | O_NOCTTY);
  assert_true(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
  slave = open(ptsname(master), O_RDWR | O_NOCTTY);
  assert_true(slave >= 0);
  set_size(rows, columns);
  assert_int_equal(tcgetattr(slave, &before), 0);
  seen_size = 0;
  seen[0] = '\0';
  child = fork();
  assert_true(child >= 0);
  if (child > 0) return;
  char line[512];
  snprintf(line, sizeof line, "exec '%s' materials edit k5 --table '%s' %s", ABBE_PROGRAM, path,
           more);
  setsid();
  ioctl(slave, TIOCSCTTY, 0);
  for (int fd = 0; fd < 3; fd++) dup2(slave, fd);
  close(master);
  close(slave);
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
  setenv("TERM", terminal, 1);
  setenv("LC_ALL", "C.UTF-8", 1);
  execl("/bin/sh", "sh", "-c", line, (char *)NULL);
  _exit(127);
}

/* Turns of waiting for what must come: as many as only a program that hangs takes. */
enum { PATIENCE = 12000 };

/* Reads what the program writes for up to so many milliseconds; false where nothing came. */
static bool listen_for(int milliseconds) {
  struct pollfd input = {.fd = master, .events = POLLIN};
  if (poll(&input, 1, milliseconds) <= 0) return false;
  ssize_t got = read(master, seen + seen_size, sizeof seen - 1 - seen_size);
  if (got <= 0) return false;
  seen_size += (size_t)got;
  seen[seen_size] = '\0';
  return true;
}

/* Waits until the program has drawn what is wanted, after what was seen before. */
static void expect(const char *wanted) {
  for (int tries = 0; tries < PATIENCE; tries++) {
    if (strstr(seen, wanted) != NULL) {
      seen_size = 0;
      seen[0] = '\0';
      return;
    }
    listen_for(100);
  }
  fail_msg("'%s' was not drawn in:\n%s", wanted, seen);
}

/* Types, and waits for the answer on a screen that is drawn anew. */
static void type(const char *keys, const char *wanted) {
  assert_int_equal(write(master, keys, strlen(keys)), (ssize_t)strlen(keys));
  while (listen_for(60)) continue;
  seen_size = 0;
  assert_int_equal(write(master, REDRAW, 1), 1);
  expect(wanted);
}

static void send_keys(const char *keys) {
  assert_int_equal(write(master, keys, strlen(keys)), (ssize_t)strlen(keys));
}

/* Waits for the end; the program's status as waitpid has it. The terminal must be as it was. */
static int finish(void) {
  int status = -1;
  for (int tries = 0; tries < PATIENCE; tries++) {
    while (listen_for(20)) continue;
    if (waitpid(child, &status, WNOHANG) == child) break;
    if (tries == PATIENCE - 1) {
      kill(child, SIGKILL);
      fail_msg("it does not end");
    }
  }
  while (listen_for(20)) continue;
  struct termios after;
  assert_int_equal(tcgetattr(slave, &after), 0);
  assert_int_equal(after.c_lflag, before.c_lflag);
  assert_int_equal(after.c_iflag, before.c_iflag);
  assert_int_equal(after.c_oflag, before.c_oflag);
  assert_contains(seen, LEAVES);
  close(master);
  close(slave);
  return status;
}

static void check_file(const char *wanted) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 20, &text, &size, &error));
  assert_string_equal(text, wanted);
}

static void set_up(void) {
  run_setup();
  snprintf(path, sizeof path, "%s/t.yaml", run_folder);
  OK(abbe_file_write(path, table, strlen(table), &error));
}

/* ---- tests ---- */

EACH(set_up, run_teardown);

TEST(values_are_edited_live_and_saved) {
  start("", 32, 110);
  expect("n_d 1.535296");
  type(DOWN DOWN DOWN "1.509", "n_d 1.522296"); /* while it is typed */
  type("\n", "(changed)");
  type(RIGHT RIGHT, "n_d 1.524296");
  type("u", "n_d 1.523296");
  type("u", "n_d 1.522296");
  type("r", "n_d 1.523296");
  type("uu", "n_d 1.535296");
  type("rr", "n_d 1.523296");
  type("s", "Saved");
  send_keys("q");
  int status = finish();
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  check_file("# glasses\nmaterials:\n- name: k5 # a crown\n  model: cauchy\n"
             "  coefficients: [1.510, 0.00459]\n  range_nm: [380, 780]\n"
             "  source: \"me: 3 May\"\n"
             "- {name: flint, model: constant, coefficients: [1.6], source: x}\n");
}

TEST(warnings_and_complaints_are_shown) {
  start("--against k5", 32, 110);
  expect("wrong: A 1.522");
  type(DOWN DOWN DOWN "red", "does nothing here");
  type("+", "coefficients.2");
  type("X", "n_d 1.535296");
  type("1.5x\n", "wants a number");
  type("\033", "n_d 1.535296"); /* Escape: as it was */
  type(UP "\n", "Enter keep");
  type("\177\177\177\177\177\177sellmeier\n", "no material");
  type("s", "not saved");
  type("u", "n_d 1.535296");
  type("uu", "n_d 1.535296");
  type("f", "n_d 1.522"); /* the check's: A is n_d - B / L^2 */
  type("f", "no certain fix");
  type("u", "n_d 1.535296");
  send_keys("q");
  int status = finish();
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  check_file(table);
}

TEST(leaving_asks_where_something_would_be_lost) {
  start("", 24, 80);
  expect("n_d 1.535296");
  type(DOWN DOWN DOWN RIGHT, "n_d 1.535396");
  type("q", "Save them?");
  type("\033", "u undo");
  type("q", "Save them?");
  send_keys("n");
  int status = finish();
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  check_file(table);
  start("", 24, 80);
  expect("n_d 1.535296");
  type(DOWN DOWN DOWN RIGHT, "n_d 1.535396");
  send_keys("Q");
  finish();
  check_file(table);
}

TEST(a_file_changed_meanwhile_is_kept) {
  start("", 24, 100);
  expect("n_d 1.535296");
  type(DOWN DOWN DOWN RIGHT, "n_d 1.535396");
  const char *other = "materials: []\n";
  OK(abbe_file_write(path, other, strlen(other), &error));
  type("s", "Look at it"); /* the end of a sentence longer than the screen is wide */
  send_keys("Q");
  finish();
  check_file(other);
}

TEST(the_window_may_change_its_size) {
  start("", 32, 110);
  expect("n over wavelength");
  set_size(6, 30);
  kill(child, SIGWINCH);
  expect("too small");
  set_size(16, 60);
  kill(child, SIGWINCH);
  expect("coefficients.0");
  set_size(40, 160);
  kill(child, SIGWINCH);
  expect("n over wavelength");
  send_keys("q");
  int status = finish();
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(signals_leave_the_terminal_as_it_was) {
  const int ends[] = {SIGTERM, SIGHUP, SIGINT, SIGQUIT};
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
    start("", 24, 80);
    expect("n_d 1.535296");
    type(DOWN DOWN DOWN RIGHT, "n_d 1.535396");
    kill(child, ends[i]);
    int status = finish();
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    assert_contains(seen, "interrupted; what was changed since the last save is lost");
    check_file(table);
  }
  const int crashes[] = {SIGSEGV, SIGABRT};
  for (size_t i = 0; i < 2; i++) {
    start("", 24, 80);
    expect("n_d 1.535296");
    kill(child, crashes[i]);
    int status = finish();
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == crashes[i]);
  }
}

TEST(it_ends_with_its_terminal) {
  start("", 24, 80);
  expect("n_d 1.535296");
  close(slave);
  close(master);
  int status;
  for (int tries = 0; waitpid(child, &status, WNOHANG) != child; tries++) {
    if (tries == PATIENCE) {
      kill(child, SIGKILL);
      fail_msg("it outlives its terminal");
    }
    nanosleep(&(struct timespec){.tv_nsec = 25000000}, NULL);
  }
}

TEST(a_terminal_of_lines_is_refused) {
  terminal = "dumb";
  start("", 24, 80);
  expect("there is no terminal to draw on");
  terminal = "xterm";
  int status = 0;
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 1);
  check_file(table);
  close(slave);
  close(master);
}

TEST(without_a_terminal_it_says_so) {
  const struct {
    const char *arguments, *part;
    int code;
  } cases[] = {
      {"k5 --table t.yaml < /dev/null", "there is no terminal", 1},
      {"k5", "--table FILE", 2},
      {"--table t.yaml", "edit what?", 2},
      {"k6 --table t.yaml", "did you mean 'k5'?", 1},
      {"k5 --table default", "compiled in", 1},
      {"k5 --table t.yaml --from default", "--from goes with --against", 2},
      {"k5 --table t.yaml --against k6", "k6", 1},
      {"k5 --table t.yaml --points no.csv", "no.csv", 1},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char line[256];
    snprintf(line, sizeof line, "\"$abbe\" materials edit %s", cases[i].arguments);
    int code = run_line(line);
    if (code != cases[i].code) fail_msg("%s: %d\n%s", line, code, run_errors);
    assert_contains(run_errors, cases[i].part);
  }
  run_says("\"$abbe\" materials edit --help", "  abbe materials edit k5 --table glasses.yaml");
}
