/* Requests as texts: what each kind takes, what is refused, and by which words. */
#include "tests/check.h"

#include "library/lib_settings.h"

typedef struct request {
  size_t width;
  double low;
  bool on;
  int choice;
  const char *name;
} request;

static abbe_result read(request *q, const char *text, abbe_error *error) {
  static const char *const colours[] = {"red", "green"};
  const abbe_lib_setting known[] = {
      ABBE_LIB_COUNT("width", &q->width, 1, 8192), ABBE_LIB_NUMBER("low", &q->low, -1.5, 2),
      ABBE_LIB_FLAG("on", &q->on), ABBE_LIB_CHOICE("colour", &q->choice, colours),
      ABBE_LIB_TEXT("name", &q->name)};
  return abbe_library_settings_read("render", known, sizeof known / sizeof *known, &text, 1, error);
}

TEST(each_kind_is_taken) {
  request q = {0};
  OK(read(&q, "width=8192", &error));
  OK(read(&q, "low=-1.5e0", &error));
  OK(read(&q, "on=1", &error));
  OK(read(&q, "colour=GREEN", &error));
  OK(read(&q, "name=a=b", &error));
  assert_int_equal(q.width, 8192);
  assert_near(q.low, -1.5, 0);
  assert_true(q.on);
  assert_int_equal(q.choice, 1);
  assert_string_equal(q.name, "a=b");
}

TEST(the_last_one_counts) {
  size_t width = 0;
  const abbe_lib_setting known[] = {ABBE_LIB_COUNT("width", &width, 1, 9)};
  const char *const text[] = {"width=2", "width=3"};
  OK(abbe_library_settings_read("x", known, 1, text, 2, &error));
  assert_int_equal(width, 3);
  OK(abbe_library_settings_read("x", known, 1, NULL, 0, &error));
}

TEST(what_is_none_is_refused) {
  static const char *const wrong[][2] = {
      {"widht=3", "did you mean 'width'?"},
      {"zzzzzzzzzzzz=3", "there are width, low, on, colour, name"},
      {"width", "no value"},
      {"", "no value"},
      {"width=", "is not a whole number from 1 to 8192"},
      {"width=0", "is not a whole number from 1 to 8192"},
      {"width=8193", "is not a whole number"},
      {"width=2.5", "is not a whole number"},
      {"width=1e400", "is not a whole number"},
      {"width=3x", "width '3x' is not"},
      {"low=2.01", "is not a number from -1.5 to 2"},
      {"low=nan", "is not a number"},
      {"low=1,5", "is not a number"},
      {"on=2", "is not a whole number from 0 to 1"},
      {"colour=blue", "is not one of red, green"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    request q = {.width = 7};
    REFUSED(ABBE_INVALID_ARGUMENT, wrong[i][1], read(&q, wrong[i][0], &error));
    assert_int_equal(q.width, 7);
  }
}
