/* render_settings.h: the table of a request's settings: one row each, with its names, kind, limits,
 * default and help. The program's options, the library's keys and the checks of a request come from
 * it. A setting that is a pair or a list (size, range, polygons) or a file is its reader's own.
 */
#ifndef ABBE_GL_PLAN_FACTS_RENDER_SETTINGS_H
#define ABBE_GL_PLAN_FACTS_RENDER_SETTINGS_H

#include "gl/plan/facts/render_desc.h"

typedef enum abbe_setting_kind {
  ABBE_SETTING_COUNT,  /* size_t */
  ABBE_SETTING_NUMBER, /* double */
  ABBE_SETTING_FLAG,   /* bool */
  ABBE_SETTING_CHOICE  /* an enum, the number of one of the names */
} abbe_setting_kind;

typedef struct abbe_render_setting {
  const char *key;    /* the library's */
  const char *option; /* the program's, without "--"; NULL: it has none of its own */
  abbe_setting_kind kind;
  size_t offset;        /* in abbe_render_desc */
  double least, most;   /* limits of a count or number; a request may have 0: the default */
  bool stays_open;      /* a request that is resolved may still have 0: the scene decides */
  bool aside;           /* seldom wanted, or of methods alone: shown by 'abbe methods --help' */
  const char *what;     /* in sentences; NULL: its reader checks it */
  const char *default_; /* default of the option, as its help shows it; NULL: none */
  const char *help;     /* help of the option */
  const char *const *names;
  size_t name_count;
} abbe_render_setting;

extern const abbe_render_setting abbe_render_settings[];
extern const size_t abbe_render_settings_count;

/* Where a request holds it: a size_t, double, bool or int by its kind. */
void *abbe_render_setting_in(const abbe_render_setting *setting, abbe_render_desc *desc);

/* Checks a request that is resolved; ABBE_INVALID_ARGUMENT names the first count that is out of its
 * limits, and these. */
abbe_result abbe_render_settings_check(const abbe_render_desc *desc, abbe_error *error);

#endif
