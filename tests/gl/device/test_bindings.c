/* The list of bindings is one for C and GLSL: a number means one buffer. */
#include "tests/check.h"

#include "base/file.h"

enum { MOST = 64 };

typedef struct list {
  char name[MOST][48];
  int number[MOST];
  size_t count;
} list;

static void read_list(const char *prefix, list *out) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(ABBE_SOURCE_DIR "/gl/device/bindings.h", 1 << 16, &text, &size, &error));
  out->count = 0;
  for (char *line = text; line != NULL && out->count < MOST;
       line = strchr(line, '\n') != NULL ? strchr(line, '\n') + 1 : NULL) {
    char name[48];
    int number = 0;
    if (sscanf(line, "#define %47s %d", name, &number) != 2) continue;
    if (strncmp(name, prefix, strlen(prefix)) != 0) continue;
    memcpy(out->name[out->count], name, sizeof name);
    out->number[out->count++] = number;
  }
}

static void check_list(const char *prefix, size_t least, int most) {
  list all;
  read_list(prefix, &all);
  assert_true(all.count >= least);
  for (size_t i = 0; i < all.count; i++) {
    if (all.number[i] < 0 || all.number[i] > most)
      fail_msg("%s is %d; at most %d is everywhere", all.name[i], all.number[i], most);
    for (size_t k = 0; k < i; k++)
      if (all.number[k] == all.number[i])
        fail_msg("%s and %s are both %d", all.name[k], all.name[i], all.number[i]);
  }
}

/* Beside them test harnesses have two, 38 and 39. */
TEST(buffers_have_a_number_each) {
  check_list("BINDING_", 20, 37);
}

/* Passes use the units below. All stages together have 96 for sure, and one may look at 16 of them.
 */
TEST(kept_textures_have_a_unit_each) {
  check_list("UNIT_", 5, 95);
}
