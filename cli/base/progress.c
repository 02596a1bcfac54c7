#include "cli/base/progress.h"

#include "base/clock.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 30 };

/* over: interrupted, or out of time. */
static volatile sig_atomic_t interrupted, over;

/* The first signal stops the work, at once or as soon as some begins; a second ends the program. */
static void interrupt(int signal_number) {
  if (interrupted) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
  interrupted = over = 1;
}

static void end_time(int signal_number) {
  (void)signal_number;
  over = 1;
}

/* For requests to end, from a user or a machine that goes down: what is done is saved. A terminal
 * that hangs up ends nothing where the parent has set that (nohup). */
static void catch_interrupts(void) {
  struct sigaction action, present;
  memset(&action, 0, sizeof action);
  action.sa_handler = interrupt;
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  sigaction(SIGHUP, NULL, &present);
  if (present.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, NULL);
}

void abbe_progress_begin(abbe_progress *progress, const char *what, bool quiet) {
  memset(progress, 0, sizeof *progress);
  progress->what = what;
  progress->silent = quiet || !isatty(STDERR_FILENO);
  progress->start_s = abbe_clock_seconds();
  catch_interrupts();
}

bool abbe_progress_update(void *user, double done) {
  abbe_progress *progress = user;
  double now = abbe_clock_seconds(), spent = now - progress->start_s;
  double left = done > 0 ? spent * (1 - done) / done : 0;
  /* Work that will be over within a second needs no bar. */
  if (!progress->silent && (spent > 0.3 && spent + left > 1.0) && now - progress->last_s > 0.1) {
    int filled = (int)(done * BAR_WIDTH);
    FILE *out = abbe_output_raw(stderr);
    fprintf(out, "\r%s [", progress->what);
    for (int i = 0; i < BAR_WIDTH; i++) fputc(i < filled ? '#' : '.', out);
    fprintf(out, "] %3.0f %%, %.0f s left ", 100 * done, left);
    fflush(out);
    progress->shown = true;
    progress->last_s = now;
  }
  return !interrupted;
}

const volatile int *abbe_progress_stopped(void) {
  return &interrupted;
}

static void set_alarm(double seconds) {
  const double whole = floor(seconds);
  const struct itimerval once = {
      .it_value = {(time_t)whole, (suseconds_t)(1e6 * (seconds - whole))}};
  setitimer(ITIMER_REAL, &once, NULL);
}

const volatile int *abbe_progress_stopped_after(double seconds) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = end_time;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, NULL);
  over = interrupted;
  set_alarm(fmin(fmax(seconds, 1e-3), 1e9));
  return &over;
}

double abbe_progress_seconds(const abbe_progress *progress) {
  return abbe_clock_seconds() - progress->start_s;
}

void abbe_progress_end(abbe_progress *progress) {
  set_alarm(0);
  if (progress->shown) fprintf(abbe_output_raw(stderr), "\r%*s\r", BAR_WIDTH + 60, "");
}
