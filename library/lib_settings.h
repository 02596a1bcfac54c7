/* lib_settings.h: requests as texts "KEY=VALUE", read by a table of the keys that are known.
 *
 * A request may then gain keys without another layout of any struct. Numbers have a decimal point
 * whatever the host's locale says. Internal to library/.
 */
#ifndef ABBE_LIBRARY_LIB_SETTINGS_H
#define ABBE_LIBRARY_LIB_SETTINGS_H

#include "base/error.h"

#include <stddef.h>

typedef enum abbe_lib_setting_kind {
  ABBE_LIB_SETTING_COUNT,  /* size_t, least to most */
  ABBE_LIB_SETTING_NUMBER, /* double, least to most */
  ABBE_LIB_SETTING_FLAG,   /* bool, 0 or 1 */
  ABBE_LIB_SETTING_CHOICE, /* int, the number of one of names[names_count] */
  ABBE_LIB_SETTING_TEXT    /* const char *, into the text that was given */
} abbe_lib_setting_kind;

typedef struct abbe_lib_setting {
  const char *key;
  abbe_lib_setting_kind kind;
  void *value;
  double least, most;
  const char *const *names;
  size_t names_count;
} abbe_lib_setting;

/* Rows of a table. */
#define ABBE_LIB_COUNT(key, at, least, most)                                                       \
  { key, ABBE_LIB_SETTING_COUNT, at, (double)(least), (double)(most), NULL, 0 }
#define ABBE_LIB_NUMBER(key, at, least, most)                                                      \
  { key, ABBE_LIB_SETTING_NUMBER, at, least, most, NULL, 0 }
#define ABBE_LIB_FLAG(key, at)                                                                     \
  { key, ABBE_LIB_SETTING_FLAG, at, 0, 1, NULL, 0 }
#define ABBE_LIB_CHOICE(key, at, names)                                                            \
  { key, ABBE_LIB_SETTING_CHOICE, at, 0, 0, names, sizeof(names) / sizeof *(names) }
#define ABBE_LIB_TEXT(key, at)                                                                     \
  { key, ABBE_LIB_SETTING_TEXT, at, 0, 0, NULL, 0 }

enum { ABBE_LIB_SETTINGS_MOST = 64 }; /* rows of a table */

/* Among several texts with one key the last one counts. `what` names the request in sentences. text
 * may be NULL where count is 0. ABBE_INVALID_ARGUMENT, with the nearest key or the range, for a key
 * or value that is none. */
abbe_result abbe_library_settings_read(const char *what, const abbe_lib_setting *known,
                                       size_t known_count, const char *const *text, size_t count,
                                       abbe_error *error);

#endif
