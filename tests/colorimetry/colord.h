/* colord.h: reads the CIE's tables as Debian's package colord-data prints them, for tests that
 * check ours against an independent copy.
 */
#ifndef ABBE_TESTS_COLORIMETRY_COLORD_H
#define ABBE_TESTS_COLORIMETRY_COLORD_H

#include "tests/check.h"

/* The numbers after BEGIN_DATA, row after row, into values[max]; their count. *start and *end are
 * the first and last wavelength. Fails the test where the package is not installed, which
 * script/bootstrap does. */
static size_t colord_read(const char *name, double *values, size_t max, double *start,
                          double *end) {
  char word[256];
  const char *path = printed("/usr/share/colord/%s", name);
  FILE *file = fopen(path, "r");
  if (file == NULL) fail_msg("%s is missing; script/bootstrap installs it (colord-data)", path);
  size_t count = 0;
  int inside = 0;
  while (fscanf(file, "%255s", word) == 1 && strcmp(word, "END_DATA") != 0) {
    if (inside && count < max) values[count++] = strtod(word, NULL);
    if (strcmp(word, "SPECTRAL_START_NM") == 0 && fscanf(file, "%lf", start) != 1) break;
    if (strcmp(word, "SPECTRAL_END_NM") == 0 && fscanf(file, "%lf", end) != 1) break;
    inside = inside || strcmp(word, "BEGIN_DATA") == 0;
  }
  fclose(file);
  return count;
}

#endif
