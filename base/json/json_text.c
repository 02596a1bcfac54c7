#include "base/json/json_text.h"

#include "base/number.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

/* What cJSON does not print exactly: more than 15 digits, and -0. */
static bool is_hard(const cJSON *item) {
  const double value = item->valuedouble;
  return cJSON_IsNumber(item) && isfinite(value) &&
         (value != abbe_number_tidy(value) || (value == 0 && signbit(value)));
}

/* From a number to the text of it, which cJSON prints as it is. */
static bool keep_digits(cJSON *item) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  abbe_number_text(item->valuedouble, text);
  char *copy = cJSON_malloc(strlen(text) + 1);
  if (copy == NULL) return false;
  item->valuestring = strcpy(copy, text);
  item->type = (item->type & ~cJSON_Number) | cJSON_Raw;
  return true;
}

static bool keep_all_digits(cJSON *item) {
  if (is_hard(item)) return keep_digits(item);
  for (cJSON *child = item->child; child != NULL; child = child->next)
    if (!keep_all_digits(child)) return false;
  return true;
}

char *abbe_json_text(const struct cJSON *json, bool lines) {
  cJSON *copy = cJSON_Duplicate(json, true);
  const bool kept = copy != NULL && keep_all_digits(copy);
  char *text = !kept ? NULL : lines ? cJSON_Print(copy) : cJSON_PrintUnformatted(copy);
  cJSON_Delete(copy);
  return text;
}
