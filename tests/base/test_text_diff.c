#include "tests/check.h"

#include "base/text_diff.h"

static char *diff(const char *before, const char *after) {
  char *out = NULL;
  OK(abbe_text_diff(before, strlen(before), after, strlen(after), "t", &out, &error));
  return out;
}

static void check_diff(const char *before, const char *after, const char *wanted) {
  FREED char *out = diff(before, after);
  assert_string_equal(out, wanted);
}

TEST(known_answers) {
  check_diff("a\nb\n", "a\nb\n", "");
  check_diff("", "", "");
  check_diff("a\n", "b\n", "--- t\n+++ t\n@@ -1 +1 @@\n-a\n+b\n");
  check_diff("", "b\n", "--- t\n+++ t\n@@ -0,0 +1 @@\n+b\n");
  check_diff("a\n", "", "--- t\n+++ t\n@@ -1 +0,0 @@\n-a\n");
  check_diff("1\n2\n3\n4\n5\n6\n7\n8\n9\n", "1\n2\n3\n4\nfive\n6\n7\n8\n9\n",
             "--- t\n+++ t\n@@ -2,7 +2,7 @@\n 2\n 3\n 4\n-5\n+five\n 6\n 7\n 8\n");
  check_diff("a\nb", "a\nc\n",
             "--- t\n+++ t\n@@ -1,2 +1,2 @@\n a\n-b\n\\ No newline at end of file\n+c\n");
}

/* Two changes share a hunk where at most six unchanged lines part them. */
TEST(hunks_meet_or_part) {
  check_diff("x\n1\n2\n3\n4\n5\n6\nx\n", "y\n1\n2\n3\n4\n5\n6\ny\n",
             "--- t\n+++ t\n@@ -1,8 +1,8 @@\n-x\n+y\n 1\n 2\n 3\n 4\n 5\n 6\n-x\n+y\n");
  check_diff("x\n1\n2\n3\n4\n5\n6\n7\nx\n", "y\n1\n2\n3\n4\n5\n6\n7\ny\n",
             "--- t\n+++ t\n@@ -1,4 +1,4 @@\n-x\n+y\n 1\n 2\n 3\n"
             "@@ -6,4 +6,4 @@\n 5\n 6\n 7\n-x\n+y\n");
}

/* Makes `after` from `before` and the diff, as patch does. */
static void apply(const char *before, const char *script, char *out) {
  const char *at = before, *s = script + strlen("--- t\n+++ t\n");
  size_t done = 0;
  while (*script != '\0' && *s != '\0') {
    size_t from = 0, count = 1;
    if (sscanf(s, "@@ -%zu,%zu", &from, &count) < 1) fail_msg("no hunk at '%s'", s);
    for (size_t start = count == 0 ? from : from - 1; done < start; done++) {
      size_t length = strcspn(at, "\n") + 1;
      out = (char *)memcpy(out, at, length) + length;
      at += length;
    }
    for (s += strcspn(s, "\n") + 1; *s == ' ' || *s == '-' || *s == '+';) {
      size_t length = strcspn(s, "\n") + 1;
      if (*s != '+') {
        assert_memory_equal(at, s + 1, length - 1);
        at += length - 1;
        done++;
      }
      if (*s != '-') out = (char *)memcpy(out, s + 1, length - 1) + length - 1;
      s += length;
    }
  }
  strcpy(out, at);
}

TEST(a_diff_applied_gives_the_other_text) {
  unsigned seed = 1;
  for (int round = 0; round < 3000; round++) {
    char text[2][256] = {"", ""}, made[1024];
    for (int side = 0; side < 2; side++) {
      seed = seed * 1664525u + 1013904223u;
      int count = (int)(seed >> 16) % 40;
      for (int i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        /* mostly the same sequence of lines, with a letter changed here and there */
        char letter = (seed >> 28) == 0 ? (char)('A' + (seed >> 8) % 3) : (char)('a' + i % 9);
        snprintf(text[side] + strlen(text[side]), 4, "%c\n", letter);
      }
    }
    FREED char *out = diff(text[0], text[1]);
    apply(text[0], out, made);
    assert_string_equal(made, text[1]);
  }
}

/* More lines than a table of all pairs may have: replaced as a whole, still right. */
TEST(long_changes_are_replaced) {
  enum { LINES = 4000 };
  FREED char *before = calloc(LINES, 8), *after = calloc(LINES, 8), *made = calloc(LINES, 16);
  assert_true(before != NULL && after != NULL && made != NULL);
  for (int i = 0, a = 0, b = 0; i < LINES; i++) {
    a += sprintf(before + a, "b%d\n", i);
    b += sprintf(after + b, "a%d\n", i);
  }
  FREED char *out = diff(before, after);
  apply(before, out, made);
  assert_string_equal(made, after);
}
