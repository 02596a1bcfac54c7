/* What is looked at: changes by key, what differs, and the way back. */
#include "tests/check.h"

#include "cli/view/state/view_document.h"

static abbe_view_document gem(void) {
  char path[] = "gem.yaml";
  const abbe_view_document named = {.path = path};
  abbe_view_document out;
  OK(abbe_view_document_copy(&named, &out, &error));
  return out;
}

static void set(abbe_view_document *d, const char *key, const char *value) {
  OK(abbe_view_document_set(d, key, value, &error));
}

TEST(a_key_has_one_value) {
  OWNED(abbe_view_document, d) = gem();
  set(&d, "ambient", "1");
  set(&d, "camera.fov", "30");
  set(&d, "ambient", "2");
  assert_int_equal(d.set_count, 2);
  assert_string_equal(d.set[0], "camera.fov=30");
  assert_string_equal(d.set[1], "ambient=2");
  assert_string_equal(abbe_view_document_value(&d, "ambient"), "2");
  assert_null(abbe_view_document_value(&d, "ambien"));
  assert_null(abbe_view_document_value(&d, "camera"));
}

TEST(one_change_too_many_is_refused) {
  OWNED(abbe_view_document, d) = gem();
  for (int i = 0; i < ABBE_VIEW_MOST_CHANGES; i++) set(&d, printed("k%d", i), "1");
  REFUSED(ABBE_INVALID_ARGUMENT, "64 changes", abbe_view_document_set(&d, "more", "1", &error));
  assert_int_equal(d.set_count, ABBE_VIEW_MOST_CHANGES);
  set(&d, "k3", "2"); /* one that is there may change on */
  assert_string_equal(d.set[ABBE_VIEW_MOST_CHANGES - 1], "k3=2");
}

TEST(points_are_what_is_written) {
  double p[3] = {1.0 / 3, -2e-7 / 3, 123456.789};
  char text[96];
  abbe_view_document_point(p, text, sizeof text);
  assert_string_equal(text, "[0.333333, -6.66667e-08, 123457]");
  assert_true(p[0] == 0.333333 && p[1] == -6.66667e-08 && p[2] == 123457);
}

TEST(what_differs) {
  OWNED(abbe_view_document, a) = gem();
  OWNED(abbe_view_document, b) = gem();
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_SAME);
  set(&a, "camera.eye", "[1, 0, 0]");
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_CAMERA);
  set(&b, "camera.eye", "[2, 0, 0]");
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_CAMERA);
  set(&b, "camera.eye", "[1, 0, 0]");
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_SAME);
  set(&a, "ambient", "1");
  set(&b, "ambient", "1");
  set(&b, "camera.eye", "[1, 0, 0]"); /* other places in the list, the same values */
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_SAME);
  b.photons = 64;
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_SETTINGS);
  set(&b, "ambient", "2");
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_LIGHTS);
  b.photons = 0;
  set(&b, "ambient", "1");
  set(&b, "lights.lamp.position", "[1, 2, 3]");
  assert_int_equal(abbe_view_document_compare(&a, &b), ABBE_VIEW_LIGHTS);
  static const char *const others[] = {
      "objects.gem.material", "lights", "environment.rotate", "ambient.x", "time", "materials"};
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    MADE(abbe_view_document, c, abbe_view_document_copy(&b, &c, &error));
    set(&c, others[i], "1");
    assert_int_equal(abbe_view_document_compare(&b, &c), ABBE_VIEW_CHANGED);
  }
}

static void edit(abbe_view_history *h, bool continued, const char *value) {
  abbe_view_document *d;
  OK(abbe_view_history_edit(h, continued, &d, &error));
  set(d, "ambient", value);
}

static const char *now(const abbe_view_history *h) {
  return abbe_view_document_value(abbe_view_history_now(h), "ambient");
}

TEST(there_and_back) {
  static abbe_view_history h;
  abbe_view_document d = gem();
  OK(abbe_view_history_begin(&h, &d, &error));
  abbe_view_document_free(&d);
  assert_false(abbe_view_history_undo(&h));
  edit(&h, false, "1");
  edit(&h, false, "2");
  edit(&h, true, "3"); /* a drag is one step */
  assert_int_equal(h.count, 3);
  assert_true(abbe_view_history_undo(&h));
  assert_string_equal(now(&h), "1");
  assert_true(abbe_view_history_redo(&h));
  assert_string_equal(now(&h), "3");
  assert_false(abbe_view_history_redo(&h));
  assert_true(abbe_view_history_undo(&h) && abbe_view_history_undo(&h));
  assert_null(now(&h));
  edit(&h, true, "4"); /* what had come then is gone, the first stays */
  assert_int_equal(h.count, 2);
  assert_true(abbe_view_history_undo(&h));
  assert_null(now(&h));
  abbe_view_history_free(&h);
}

TEST(the_oldest_steps_are_forgotten) {
  static abbe_view_history h;
  abbe_view_document d = gem();
  OK(abbe_view_history_begin(&h, &d, &error));
  abbe_view_document_free(&d);
  for (int i = 0; i < ABBE_VIEW_MOST_STEPS + 5; i++) edit(&h, false, printed("%d", i));
  int steps = 0;
  while (abbe_view_history_undo(&h)) steps++;
  assert_int_equal(steps, ABBE_VIEW_MOST_STEPS - 1);
  assert_string_equal(now(&h), "5");
  abbe_view_history_free(&h);
}
