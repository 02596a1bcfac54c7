#include "tests/check.h"

#include "base/json/json_text.h"

#include <cjson/cJSON.h>
#include <float.h>

static const double hard[] = {0.1 + 0.2,  2.4175239999999997, 1.0 / 3, DBL_MAX, DBL_MIN,
                              5e-324,     1 - DBL_EPSILON / 2, 1e22,    -0.1,    123456789012345678.0,
                              1e15 + 0.5, 0.1,                 42,      -7e-30,  -0.0};
enum { HARD = sizeof hard / sizeof *hard };

TEST(every_number_reads_back_to_the_same_double) {
  for (int lines = 0; lines < 2; lines++) {
    cJSON *root = cJSON_CreateObject(), *list = cJSON_CreateDoubleArray(hard, HARD);
    cJSON_AddItemToObject(root, "list", list);
    cJSON_AddNumberToObject(root, "sum", 0.1 + 0.2);
    char *text = abbe_json_text(root, lines != 0);
    assert_non_null(text);
    assert_contains(text, "0.30000000000000004");
    cJSON *back = cJSON_Parse(text);
    assert_non_null(back);
    for (int i = 0; i < HARD; i++) {
      const double value =
          cJSON_GetArrayItem(cJSON_GetObjectItem(back, "list"), i)->valuedouble;
      assert_memory_equal(&value, &hard[i], sizeof value);
    }
    /* what was printed is not changed */
    assert_true(cJSON_IsNumber(cJSON_GetObjectItem(root, "sum")));
    cJSON_free(text);
    cJSON_Delete(back);
    cJSON_Delete(root);
  }
}

TEST(random_doubles_read_back) {
  uint64_t bits = 88172645463325252u;
  for (int i = 0; i < 2000; i++) {
    double value;
    bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
    memcpy(&value, &bits, sizeof value);
    if (!isfinite(value)) continue;
    cJSON *number = cJSON_CreateNumber(value);
    char *text = abbe_json_text(number, false);
    cJSON *back = cJSON_Parse(text);
    assert_memory_equal(&back->valuedouble, &value, sizeof value);
    cJSON_free(text);
    cJSON_Delete(number);
    cJSON_Delete(back);
  }
}

TEST(other_items_are_as_cjson_prints_them) {
  cJSON *root = cJSON_Parse("{\"a\":[true,null,\"0.1\",0.5],\"b\":{\"c\":-3}}");
  cJSON_AddNumberToObject(root, "no", NAN);
  char *text = abbe_json_text(root, false);
  assert_string_equal(text, "{\"a\":[true,null,\"0.1\",0.5],\"b\":{\"c\":-3},\"no\":null}");
  cJSON_free(text);
  cJSON_Delete(root);
  assert_null(abbe_json_text(NULL, true));
}
