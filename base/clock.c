#define _GNU_SOURCE /* CLOCK_BOOTTIME */
#include "base/clock.h"

#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

double abbe_clock_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double abbe_clock_thread_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Field 22 of /proc/self/stat, in ticks since the machine was started; the second field is a name
 * in brackets that may hold anything. */
static double read_start(void) {
  char text[1024];
  unsigned long long ticks = 0;
  FILE *file = fopen("/proc/self/stat", "r");
  if (file == NULL) return -1;
  size_t size = fread(text, 1, sizeof text - 1, file);
  fclose(file);
  text[size] = '\0';
  const char *at = strrchr(text, ')');
  for (int field = 2; at != NULL && field < 22; field++) at = strchr(at + 1, ' ');
  if (at == NULL || sscanf(at, " %llu", &ticks) != 1) return -1;
  return (double)ticks / (double)sysconf(_SC_CLK_TCK);
}

double abbe_clock_process_seconds(void) {
  static double first = -1;
  struct timespec now;
  const double start = read_start();
  if (start >= 0 && clock_gettime(CLOCK_BOOTTIME, &now) == 0) {
    const double age = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec - start;
    if (age >= 0) return age;
  }
  if (first < 0) first = abbe_clock_seconds();
  return abbe_clock_seconds() - first;
}
