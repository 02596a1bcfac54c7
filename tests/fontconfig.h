/* fontconfig.h: for tests that draw text: fontconfig keeps patterns in caches of its own until the
 * process ends, which the leak sanitizer would report. */
#ifndef ABBE_TESTS_FONTCONFIG_H
#define ABBE_TESTS_FONTCONFIG_H

const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libfontconfig";
}

#endif
