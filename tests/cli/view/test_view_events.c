/* What pages send: lines read, and a queue that keeps of them what is seen. */
#include "tests/check.h"

#include "cli/view/state/view_events.h"

static abbe_view_event event(const char *text) {
  char line[96];
  abbe_view_event e;
  snprintf(line, sizeof line, "%s", text);
  OK(abbe_view_event_read(line, &e, &error));
  return e;
}

static void add(abbe_view_events *q, const char *text) {
  const abbe_view_event e = event(text);
  assert_true(abbe_view_events_add(q, &e));
}

/* A thousand moves are one; what a drag, a key or a turn of the wheel must find stays in order. */
TEST(what_nobody_would_see_is_left_out) {
  static abbe_view_events q;
  abbe_view_event e;
  for (int i = 0; i < 1000; i++) add(&q, printed("move %d 7", i));
  assert_int_equal(q.count, 1);
  add(&q, "down 0");
  add(&q, "move 5 5");
  add(&q, "move 6 5");
  add(&q, "up 0");
  for (int i = 0; i < 300; i++) {
    add(&q, "move 6 5"); /* as pages do before each */
    add(&q, "wheel 1");
  }
  add(&q, "move 9 9");
  add(&q, "wheel -1");
  for (int i = 1; i < 50; i++) add(&q, printed("size %d 9", i));
  add(&q, "key + down");
  add(&q, "key + down"); /* another half stop */
  static const struct {
    abbe_view_event_kind kind;
    double x;
  } kept[] = {
      {ABBE_VIEW_EVENT_MOVE, 999}, {ABBE_VIEW_EVENT_BUTTON, 0}, {ABBE_VIEW_EVENT_MOVE, 6},
      {ABBE_VIEW_EVENT_BUTTON, 0}, {ABBE_VIEW_EVENT_MOVE, 6},   {ABBE_VIEW_EVENT_WHEEL, 100},
      {ABBE_VIEW_EVENT_MOVE, 9},   {ABBE_VIEW_EVENT_WHEEL, -1}, {ABBE_VIEW_EVENT_SIZE, 49},
      {ABBE_VIEW_EVENT_KEY, 0},    {ABBE_VIEW_EVENT_KEY, 0}};
  assert_int_equal(q.count, sizeof kept / sizeof *kept);
  for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
    assert_true(abbe_view_events_take(&q, &e));
    assert_int_equal(e.kind, kept[i].kind);
    assert_true(e.x == kept[i].x);
  }
  assert_false(abbe_view_events_take(&q, &e));
}

/* As many as there may be wait in order, and no more. */
TEST(the_queue_has_an_end) {
  static abbe_view_events q;
  const abbe_view_event down = event("down 0"), up = event("up 1");
  abbe_view_event e;
  for (int i = 0; i < ABBE_VIEW_MOST_EVENTS; i++) assert_true(abbe_view_events_add(&q, &down));
  assert_false(abbe_view_events_add(&q, &up));
  for (int i = 0; i < 10; i++) assert_true(abbe_view_events_take(&q, &e));
  for (int i = 0; i < 10; i++) assert_true(abbe_view_events_add(&q, &up));
  assert_false(abbe_view_events_add(&q, &up));
  for (int i = 0; i < ABBE_VIEW_MOST_EVENTS; i++) {
    assert_true(abbe_view_events_take(&q, &e));
    assert_int_equal(e.down, i < ABBE_VIEW_MOST_EVENTS - 10);
  }
  assert_int_equal(q.count, 0);
}
