#include "spectral/error.h"

#include <stdarg.h>
#include <stdio.h>

const char *abbe_result_text(abbe_result result) {
  static const char *const texts[] = {
#define ABBE_RESULT_TEXT(code, text) [ABBE_##code] = text,
      ABBE_RESULTS(ABBE_RESULT_TEXT)
#undef ABBE_RESULT_TEXT
  };
  if ((int)result < 0 || result >= ABBE_RESULT_COUNT) return "unknown result";
  return texts[result];
}

abbe_result abbe_error_set(abbe_error *error, abbe_result code, const char *format, ...) {
  if (error == NULL) return code;
  error->code = code;
  va_list args;
  va_start(args, format);
  vsnprintf(error->text, sizeof error->text, format, args);
  va_end(args);
  return code;
}
