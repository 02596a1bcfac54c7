/* run_json.h: what the program answers in JSON. */
#ifndef ABBE_TESTS_CLI_RUN_JSON_H
#define ABBE_TESTS_CLI_RUN_JSON_H

#include "tests/cli/run_program.h"

#include <cjson/cJSON.h>

static inline void cJSON_drop(cJSON **held) {
  cJSON_Delete(*held);
}

/* Runs a shell line, which must end with code and print JSON; cJSON_Delete frees it. */
static inline cJSON *run_json(const char *line, int code) {
  const int ended = run_line(line);
  if (ended != code) fail_msg("%s\nends with %d, not %d: %s", line, ended, code, run_errors);
  cJSON *json = cJSON_Parse(run_output);
  if (json == NULL) fail_msg("%s\nno JSON: %s", line, run_output);
  return json;
}

/* The answer to another line in its place. */
static inline void rerun_json(cJSON **json, const char *line, int code) {
  cJSON_Delete(*json);
  *json = run_json(line, code);
}

/* A member of an object, which must be there. */
static inline const cJSON *json_item(const cJSON *object, const char *key) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
  if (item == NULL) fail_msg("there is no '%s'", key);
  return item;
}

/* A number of an object; NaN where there is none. */
static inline double json_number(const cJSON *object, const char *key) {
  return cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(object, key));
}

#endif
