#include "validation/lab/known/known_answers.h"

#include "base/text.h"
#include "validation/lab/known/known_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name, *what;
  abbe_result (*make)(abbe_known_run *run, abbe_error *error);
} groups[] = {
#define ABBE_KNOWN_ROW(name, what) {#name, what, abbe_known_##name},
    ABBE_KNOWN_GROUPS(ABBE_KNOWN_ROW)
#undef ABBE_KNOWN_ROW
};

/* The work of a group, roughly, in the last one's: only the bar of progress goes by it. */
static double cost_of(const char *name) {
  static const struct {
    const char *name;
    double cost;
  } costs[] = {{"pane", 1},        {"polarised", 1}, {"absorption", 1}, {"furnace", 1},
               {"environment", 1}, {"mirror", 2},    {"medium", 1},     {"lamp", 1},
               {"sphere", 4},      {"white", 2},     {"picture", 1},    {"convergence", 1}};
  for (size_t i = 0; i < sizeof costs / sizeof *costs; i++)
    if (strcmp(name, costs[i].name) == 0) return costs[i].cost;
  return 0.01;
}

enum { GROUPS = sizeof groups / sizeof *groups };

const char *abbe_known_answers_group(size_t index) {
  return index < GROUPS ? groups[index].name : NULL;
}

const char *abbe_known_answers_describe(size_t index) {
  return index < GROUPS ? groups[index].what : NULL;
}

static abbe_result check_group(const char *only, abbe_error *error) {
  const char *names[GROUPS];
  for (size_t i = 0; i < GROUPS; i++) {
    names[i] = groups[i].name;
    if (only == NULL || strcmp(only, names[i]) == 0) return ABBE_OK;
  }
  const char *near = abbe_nearest_word(only, names, GROUPS);
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "there is no group '%.60s' of known answers%s%s%s; the first is '%s'", only,
                        near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                        near != NULL ? "'?" : "", names[0]);
}

abbe_result abbe_known_answers_make(const abbe_known_options *options, abbe_known_answers *out,
                                    abbe_error *error) {
  const abbe_known_options defaults = {0};
  if (options == NULL) options = &defaults;
  *out = (abbe_known_answers){0};
  abbe_result result = check_group(options->only, error);
  double whole = 0, before = 0;
  for (size_t i = 0; i < GROUPS; i++) whole += cost_of(groups[i].name);
  for (size_t i = 0; i < GROUPS && result == ABBE_OK; i++) {
    bool all = options->only == NULL;
    if (!all && strcmp(options->only, groups[i].name) != 0) continue;
    abbe_known_run run = {.options = options, .out = out, .group = groups[i].name, .to = 1};
    if (all) run.from = before / whole;
    before += cost_of(groups[i].name);
    if (all) run.to = before / whole;
    result = abbe_known_progress(&run, 0, error);
    if (result == ABBE_OK) result = groups[i].make(&run, error);
  }
  if (result != ABBE_OK) abbe_known_answers_free(out);
  return result;
}

void abbe_known_answers_free(abbe_known_answers *answers) {
  if (answers == NULL) return;
  free(answers->row);
  *answers = (abbe_known_answers){0};
}

size_t abbe_known_answers_failed(const abbe_known_answers *answers) {
  size_t failed = 0;
  for (size_t i = 0; i < answers->count; i++) failed += answers->row[i].passed ? 0 : 1;
  return failed;
}
