#include "library/lib_settings.h"

#include "base/number.h"
#include "base/text.h"
#include "library/lib_handles.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MOST_NAME = 40 };

static abbe_result refuse_key(const char *what, const abbe_lib_setting *known, size_t known_count,
                              const char *key, abbe_error *error) {
  const char *names[ABBE_LIB_SETTINGS_MOST] = {NULL};
  for (size_t i = 0; i < known_count; i++) names[i] = known[i].key;
  const char *near = abbe_nearest_word(key, names, known_count);
  char list[512] = "";
  for (size_t i = 0, at = 0; near == NULL && i < known_count && at < sizeof list; i++)
    at += (size_t)snprintf(list + at, sizeof list - at, "%s%s", i == 0 ? "" : ", ", names[i]);
  return near != NULL
             ? abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "%s: there is no setting '%s'; did you mean '%s'?", what, key, near)
             : abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "%s: there is no setting '%s'; there are %s", what, key, list);
}

static abbe_result take_number(const char *what, const abbe_lib_setting *s, const char *value,
                               abbe_error *error) {
  const bool whole = s->kind != ABBE_LIB_SETTING_NUMBER;
  const char *end = value;
  double number = 0;
  const bool read = abbe_number_read(value, &end, &number) && *end == '\0';
  if (!read || !isfinite(number) || number < s->least || number > s->most ||
      (whole && number != floor(number))) {
    char low[ABBE_NUMBER_TEXT_SIZE], high[ABBE_NUMBER_TEXT_SIZE];
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: %s '%.60s' is not a %snumber from %s to %s", what, s->key, value,
                          whole ? "whole " : "", abbe_number_text(s->least, low),
                          abbe_number_text(s->most, high));
  }
  if (s->kind == ABBE_LIB_SETTING_NUMBER)
    *(double *)s->value = number;
  else if (s->kind == ABBE_LIB_SETTING_COUNT)
    *(size_t *)s->value = (size_t)number;
  else
    *(bool *)s->value = number != 0;
  return ABBE_OK;
}

static abbe_result take_choice(const char *what, const abbe_lib_setting *s, const char *value,
                               abbe_error *error) {
  char list[256] = "";
  size_t at = 0;
  for (size_t i = 0; i < s->names_count; i++) {
    if (strcasecmp(value, s->names[i]) == 0) {
      *(int *)s->value = (int)i;
      return ABBE_OK;
    }
    if (at < sizeof list)
      at += (size_t)snprintf(list + at, sizeof list - at, "%s%s", i == 0 ? "" : ", ", s->names[i]);
  }
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: %s '%.60s' is not one of %s", what,
                        s->key, value, list);
}

static abbe_result take(const char *what, const abbe_lib_setting *s, const char *value,
                        abbe_error *error) {
  if (s->kind == ABBE_LIB_SETTING_CHOICE) return take_choice(what, s, value, error);
  if (s->kind != ABBE_LIB_SETTING_TEXT) return take_number(what, s, value, error);
  *(const char **)s->value = value;
  return ABBE_OK;
}

abbe_result abbe_library_settings_read(const char *what, const abbe_lib_setting *known,
                                       size_t known_count, const char *const *text, size_t count,
                                       abbe_error *error) {
  ABBE_REQUIRE(text || count == 0, error);
  for (size_t i = 0; i < count; i++) {
    ABBE_REQUIRE(text[i], error);
    char key[MOST_NAME];
    const size_t length = strcspn(text[i], "=");
    snprintf(key, sizeof key, "%.*s", (int)(length < sizeof key ? length : sizeof key), text[i]);
    if (text[i][length] == '\0')
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: the setting '%s' has no value; write it as KEY=VALUE", what, key);
    size_t row = 0;
    while (row < known_count && strcmp(known[row].key, key) != 0) row++;
    if (row == known_count) return refuse_key(what, known, known_count, key, error);
    ABBE_TRY(take(what, &known[row], text[i] + length + 1, error));
  }
  return ABBE_OK;
}
