/* json_text.h: a cJSON tree as text whose every number reads back to the same double.
 *
 * cJSON itself prints 15 digits where a number that reads back to nearly the same will do. It knows
 * nothing of what is printed; strings keep their bytes.
 */
#ifndef ABBE_BASE_JSON_JSON_TEXT_H
#define ABBE_BASE_JSON_JSON_TEXT_H

#include <stdbool.h>

struct cJSON;

/* json as text, in lines or on one (cJSON_free frees it): each number is the shortest decimal of its
 * double, null where it is not finite. NULL where json is NULL and for want of memory. */
char *abbe_json_text(const struct cJSON *json, bool lines);

#endif
