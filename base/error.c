#include "base/error.h"

#include "base/number.h"
#include "base/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *abbe_result_text(abbe_result result) {
  static const char *const texts[] = {
#define ABBE_RESULT_TEXT(code, text) [ABBE_##code] = text,
      ABBE_RESULTS(ABBE_RESULT_TEXT)
#undef ABBE_RESULT_TEXT
  };
  if ((int)result < 0 || result >= ABBE_RESULT_COUNT) return "unknown result";
  return texts[result];
}

void abbe_drop(void *pointer) {
  free(*(void **)pointer);
}

abbe_result abbe_error_set_list(abbe_error *error, abbe_result code, const char *prefix,
                                const char *format, va_list arguments) {
  if (error == NULL) return code;
  char raw[sizeof error->text]; /* the arguments may be the error's own text */
  int used = snprintf(raw, sizeof raw, "%s", prefix);
  if (used >= 0 && (size_t)used < sizeof raw)
    abbe_number_format_list(raw + used, sizeof raw - (size_t)used, format, arguments);
  error->code = code;
  abbe_utf8_printable(raw, strlen(raw), false, error->text, sizeof error->text);
  return code;
}

abbe_result abbe_error_set(abbe_error *error, abbe_result code, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  abbe_error_set_list(error, code, "", format, arguments);
  va_end(arguments);
  return code;
}
